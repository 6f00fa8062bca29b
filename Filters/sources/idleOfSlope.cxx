// Properties of a slope that were set and have no effect.

#include "vtkDEMToCFESource.h"

#include "shared/errorReport.h"
#include "terrain/presets.h"

#include "vtkNew.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace
{

using Source = vtkDEMToCFESource;
using Text = std::string;

/// Numbers of a preset that a panel shows may have been rounded.
bool isPresets(
  const std::vector<std::pair<std::string, double>>& preset, const Text& name, double value)
{
  const auto of = std::ranges::find(preset, name, &std::pair<std::string, double>::first);
  return of != preset.end() && std::abs(of->second - value) <= 1e-9 * std::abs(value);
}

} // namespace

//------------------------------------------------------------------------------
std::vector<std::string> vtkDEMToCFESource::IdleNotes(bool contours) const
{
  rockfall::filters::IdleProperties idle;
  const vtkNew<Source> usual;
  if (this->Preset > 0)
  {
    static constexpr std::pair<const char*, double Source::*> replaced[] = {
      { "RestitutionCoefficient", &Source::RestitutionCoefficient },
      { "RestitutionDeviation", &Source::RestitutionDeviation },
      { "TangentialRestitution", &Source::TangentialRestitution },
      { "RestitutionSpeed", &Source::RestitutionSpeed },
      { "FrictionAngle", &Source::FrictionAngle },
      { "FrictionAngleDeviation", &Source::FrictionAngleDeviation },
      { "GroundModulus", &Source::GroundModulus },
      { "ScarDepthFactor", &Source::ScarDepthFactor },
      { "ScarRadius", &Source::ScarRadius },
      { "GroundDensity", &Source::GroundDensity },
      { "ScarCompaction", &Source::ScarCompaction },
      { "ScarSpinDrag", &Source::ScarSpinDrag },
      { "SlipFrictionMin", &Source::SlipFrictionMin },
      { "SlipFrictionMax", &Source::SlipFrictionMax },
      { "SlipFrictionGrowth", &Source::SlipFrictionGrowth },
      { "SlipFrictionDecay", &Source::SlipFrictionDecay },
      { "RollingResistance", &Source::RollingResistance },
      { "GroundDeviation", &Source::GroundDeviation },
      { "GroundDeviationLength", &Source::GroundDeviationLength },
      { "RoughnessMean", &Source::RoughnessMean },
      { "RoughnessDeviation", &Source::RoughnessDeviation },
      { "RoughnessLength", &Source::RoughnessLength },
      { "ObstacleHeight70", &Source::ObstacleHeight70 },
      { "ObstacleHeight20", &Source::ObstacleHeight20 },
      { "ObstacleHeight10", &Source::ObstacleHeight10 },
    };
    const auto preset = rockfall::presetValues(this->Preset);
    const auto tell = [&](const char* name, double value, double otherwise)
    {
      // The window fills the panel's fields with the preset's own numbers.
      idle.addTo("The Preset replaces what these properties say", name, value,
        isPresets(preset, name, value) ? value : otherwise);
    };
    tell("RestitutionModel", this->RestitutionModel, usual->RestitutionModel);
    for (const auto& [name, value] : replaced)
    {
      tell(name, this->*value, usual->*value);
    }
    tell("DeviationPer", this->DeviationPer, usual->DeviationPer);
  }
  else
  {
    this->FindIdleGround(idle);
  }

  const auto chosen = [&](const char* name, const Text& value, const char* of, const Text& file)
  {
    if (file.empty())
    {
      idle.add(name, value, Text(), Text("there is no ") + of);
    }
  };
  chosen("LayerName", this->LayerName, "FileName", this->FileName);
  chosen("ElevationField", this->ElevationField, "FileName", this->FileName);
  const Text noFile = "there is no FileName";
  if (this->FileName.empty() || contours)
  {
    idle.add("Band", this->Band, usual->Band,
      this->FileName.empty() ? noFile : "FileName has contour lines, not bands");
  }
  if (this->FileName.empty() || !contours)
  {
    idle.add("RelaxFlats", this->RelaxFlats != 0, true,
      this->FileName.empty() ? noFile : "FileName is a raster, not contour lines");
  }
  if (!this->FileName.empty() && !contours)
  {
    idle.add(
      "ElevationField", this->ElevationField, Text(), "FileName is a raster, not contour lines");
  }
  chosen("EmbankmentLayerName", this->EmbankmentLayerName, "EmbankmentFile", this->EmbankmentFile);
  chosen("TreeLayerName", this->TreeLayerName, "TreeFile", this->TreeFile);
  chosen("BarrierLayerName", this->BarrierLayerName, "BarrierFile", this->BarrierFile);
  chosen(
    "RestitutionLayerName", this->RestitutionLayerName, "RestitutionLayer", this->RestitutionLayer);
  chosen("RestitutionField", this->RestitutionField, "RestitutionLayer", this->RestitutionLayer);
  chosen("JointLayerName", this->JointLayerName, "JointLayer", this->JointLayer);
  chosen("JointField", this->JointField, "JointLayer", this->JointLayer);
  chosen("RestitutionTableSheet", this->RestitutionTableSheet, "RestitutionTable",
    this->RestitutionTable);
  chosen("JointTableSheet", this->JointTableSheet, "JointTable", this->JointTable);
  if (this->TreeFile.empty())
  {
    idle.add("TreesBreak", this->TreesBreak != 0, true, "there is no TreeFile");
  }
  const Text* const files[] = { &this->FileName, &this->EmbankmentFile, &this->TreeFile,
    &this->BarrierFile, &this->RestitutionLayer, &this->RestitutionTable, &this->JointLayer,
    &this->JointTable };
  if (std::ranges::all_of(files, [](const Text* file) { return file->empty(); }))
  {
    idle.add("AllowReferences", this->AllowReferences != 0, false, "there is no file");
  }
  return idle.notes();
}

//------------------------------------------------------------------------------
void vtkDEMToCFESource::FindIdleGround(rockfall::filters::IdleProperties& idle) const
{
  // What a class or a structure does not say is as these properties have it.
  if (!this->RestitutionTable.empty() || !this->JointTable.empty() ||
    !this->EmbankmentFile.empty() || !this->TreeFile.empty())
  {
    return;
  }
  const vtkNew<Source> usual;
  const auto tell =
    [&](const char* cause, std::initializer_list<std::pair<const char*, double Source::*>> of)
  {
    for (const auto& [name, value] : of)
    {
      idle.addTo(cause, name, this->*value, usual->*value);
    }
  };
  if (this->RestitutionModel == WHOLE_VELOCITY)
  {
    tell("RestitutionModel Whole velocity does not take",
      { { "TangentialRestitution", &Source::TangentialRestitution } });
  }
  if (this->RestitutionModel != SPEED_DEPENDENT)
  {
    tell("Only RestitutionModel Speed-dependent takes",
      { { "RestitutionSpeed", &Source::RestitutionSpeed } });
  }
  const bool scars = this->GroundModulus > 0.0, slips = this->SlipFrictionMax > 0.0;
  if (!scars)
  {
    tell("GroundModulus is 0, without which these have no effect",
      { { "ScarDepthFactor", &Source::ScarDepthFactor }, { "ScarRadius", &Source::ScarRadius },
        { "GroundDensity", &Source::GroundDensity }, { "ScarCompaction", &Source::ScarCompaction },
        { "ScarSpinDrag", &Source::ScarSpinDrag } });
  }
  if (slips)
  {
    tell("On the ground SlipFrictionMax takes the place of",
      { { "FrictionAngle", &Source::FrictionAngle },
        { "FrictionAngleDeviation", &Source::FrictionAngleDeviation } });
  }
  else
  {
    tell("SlipFrictionMax is 0, without which these have no effect",
      { { "SlipFrictionGrowth", &Source::SlipFrictionGrowth },
        { "SlipFrictionDecay", &Source::SlipFrictionDecay } });
  }
  if (!scars && !slips)
  {
    tell("GroundModulus and SlipFrictionMax are 0, without which these have no effect",
      { { "GroundDeviation", &Source::GroundDeviation },
        { "GroundDeviationLength", &Source::GroundDeviationLength } });
  }
  else if (this->GroundDeviation == 0.0)
  {
    tell("GroundDeviation is 0, without which these have no effect",
      { { "GroundDeviationLength", &Source::GroundDeviationLength } });
  }
  if (this->RestitutionDeviation == 0.0 && (slips || this->FrictionAngleDeviation == 0.0))
  {
    idle.addTo("RestitutionDeviation and FrictionAngleDeviation are 0, without which these have no "
               "effect",
      "DeviationPer", this->DeviationPer, usual->DeviationPer);
  }
  if (this->RoughnessDeviation == 0.0 && this->ObstacleHeight70 == 0.0 &&
    this->ObstacleHeight20 == 0.0 && this->ObstacleHeight10 == 0.0)
  {
    tell("RoughnessDeviation and the obstacle heights are 0, without which these have no effect",
      { { "RoughnessLength", &Source::RoughnessLength } });
  }
}
