#include "vtkBarrierDesign.h"

#include "base/require.h"
#include "results/designNotes.h"
#include "results/designTables.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/streamingPieces.h"
#include "shared/terrainFieldData.h"
#include "shared/withAbort.h"
#include "statistics/frequency.h"
#include "terrain/plausible.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkBarrierDesign);

namespace
{

enum OutputPorts
{
  DESIGN = 0,
  CLASSES = 1,
  SOURCES = 2,
  PLACES = 3
};

/// Of the survey of the slope, of that of the block, and of trajectories: as RocFall3's page on
/// UNI 11211-4 has them.
constexpr double kGood = 1.02, kPoor = 1.10;

/// Names of the factors that a set has, too, as far as they say something; empty if none does.
std::string namesOfTyped(const rockfall::PartialFactors& factors)
{
  std::string names;
  for (const auto& [name, value] : { std::pair("SlopeSurveyFactor", factors.slopeSurvey),
         std::pair("TrajectoryFactor", factors.trajectories),
         std::pair("BlockSurveyFactor", factors.blockSurvey) })
  {
    if (value != 1.0)
    {
      names += (names.empty() ? "" : ", ") + std::string(name);
    }
  }
  return names;
}

} // namespace

//------------------------------------------------------------------------------
vtkBarrierDesign::vtkBarrierDesign()
{
  this->SetNumberOfInputPorts(1);
  this->SetNumberOfOutputPorts(PLACES + 1);
}

//------------------------------------------------------------------------------
vtkBarrierDesign::~vtkBarrierDesign() = default;

//------------------------------------------------------------------------------
int vtkBarrierDesign::FillInputPortInformation(int, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  return 1;
}

//------------------------------------------------------------------------------
int vtkBarrierDesign::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  namespace filters = rockfall::filters;
  if (filters::isFurtherPiece(outputVector))
  {
    return 1;
  }
  return filters::withAbort(this, "The crossings do not fit in memory",
    [&]
    {
      filters::Input taken(filters::InputKind::Crossings, 1);
      vtkPolyData* const crossings = taken.take(inputVector[0]);
      if (!crossings)
      {
        throw rockfall::DataError("The Input is missing");
      }
      taken.require();
      if (filters::inheritFailure(crossings, this))
      {
        return 1;
      }
      rockfall::require(this->AnnualFrequency >= 0.0 && std::isfinite(this->AnnualFrequency),
        "AnnualFrequency", this->AnnualFrequency, " per year", "finite and not negative");
      if (this->FactorSet < TYPED || this->FactorSet > UNI_POOR)
      {
        throw rockfall::ParameterError(
          "FactorSet is " + std::to_string(this->FactorSet) + ", it must be 0, 1 or 2");
      }
      rockfall::PartialFactors factors{ this->SlopeSurveyFactor, this->TrajectoryFactor,
        this->BlockSurveyFactor, this->UnitWeightFactor, this->RiskFactor, this->BarrierFactor,
        this->Freeboard, this->DesignMass };
      std::vector<std::string> notes;
      if (this->FactorSet != TYPED)
      {
        if (std::string replaced = namesOfTyped(factors); !replaced.empty())
        {
          notes.push_back("FactorSet replaces what these properties say: " + std::move(replaced));
        }
        factors.slopeSurvey = factors.trajectories = factors.blockSurvey =
          this->FactorSet == UNI_GOOD ? kGood : kPoor;
      }
      rockfall::checkFactors(factors);

      if (this->AnnualFrequency > 0.0)
      {
        rockfall::askAfterFrequency(this->AnnualFrequency, notes);
        if (crossings->GetPointData()->GetArray("Frequency"))
        {
          notes.push_back(rockfall::ownNotUsed(this->AnnualFrequency));
        }
      }

      vtkNew<vtkPolyData> points;
      const filters::MergedCrossings merged = filters::mergeCrossings({ &crossings, 1 }, points);
      const std::vector<filters::DesignLine> lines =
        filters::designLines(merged, points, this->AnnualFrequency);
      std::vector<rockfall::LostRocks> lost;
      for (const filters::DesignLine& line : lines)
      {
        lost.push_back(line.lost);
      }
      const bool own = this->AnnualFrequency <= 0.0; // else all rocks are alike
      const rockfall::FrequencyRange released =
        own ? merged.releases.weights() : rockfall::FrequencyRange();
      for (std::vector<std::string> more :
        { merged.notes, filters::lostBeforeNotes(lost), filters::frequencyNotes(lines, released),
          filters::sourceNotes(lines), filters::factorNotes(lines, factors) })
      {
        std::ranges::move(more, std::back_inserter(notes));
      }
      vtkNew<vtkTable> design, classes, sources, places;
      filters::writeDesign(lines, factors, design);
      filters::writeClasses(lines, classes);
      filters::writeSources(lines, sources);
      filters::writePlaces(lines, factors, std::int64_t(merged.released.size()), places);
      int port = DESIGN;
      for (vtkTable* made : { design.Get(), classes.Get(), sources.Get(), places.Get() })
      {
        filters::copyCoordinateSystem(points->GetFieldData(), made->GetFieldData());
        vtkTable::GetData(outputVector, port++)->ShallowCopy(made);
      }
      filters::showNotes(notes, vtkTable::GetData(outputVector, DESIGN)->GetFieldData());
      return 1;
    });
}

//------------------------------------------------------------------------------
void vtkBarrierDesign::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "AnnualFrequency: " << this->AnnualFrequency << "\n";
  os << indent << "FactorSet: " << this->FactorSet << "\n";
  os << indent << "SlopeSurveyFactor: " << this->SlopeSurveyFactor << "\n";
  os << indent << "TrajectoryFactor: " << this->TrajectoryFactor << "\n";
  os << indent << "BlockSurveyFactor: " << this->BlockSurveyFactor << "\n";
  os << indent << "UnitWeightFactor: " << this->UnitWeightFactor << "\n";
  os << indent << "RiskFactor: " << this->RiskFactor << "\n";
  os << indent << "BarrierFactor: " << this->BarrierFactor << "\n";
  os << indent << "Freeboard: " << this->Freeboard << "\n";
  os << indent << "DesignMass: " << this->DesignMass << "\n";
}
