// Notes on rock blocks: properties that were set and have no effect, and rows of sources that are odd.

#include "sources/rockBlockSources.h"

#include "base/RockMaterial.h"
#include "base/text/numberText.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "sources/drawnSource.h"

#include "vtkNew.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

using rockfall::filters::IdleProperties;
using rockfall::filters::vec3;

namespace
{

/// Mean of the volumes that a normal or log-normal law with its bounds gives, m³.
double meanOf(const rockfall::VolumeDistribution& law)
{
  constexpr int count = 400;
  double sum = 0.0;
  for (int k = 0; k < count; ++k)
  {
    sum += law.quantile((k + 0.5) / count);
  }
  return sum / count;
}

bool isBell(const rockfall::VolumeDistribution& law)
{
  return law.deviation > 0.0 &&
    (law.law == rockfall::VolumeLaw::Normal || law.law == rockfall::VolumeLaw::LogNormal);
}

/// Whether the row gives what its law has no use for. `power`: its frequency is by a power law,
/// which takes bounds and exponent.
bool hasIdle(const rockfall::SourceRow& row, const rockfall::VolumeDistribution& law, bool power)
{
  using rockfall::VolumeLaw;
  power = power || law.law == VolumeLaw::PowerLaw;
  return (row.volumeDeviation && law.law != VolumeLaw::Normal && law.law != VolumeLaw::LogNormal) ||
    (row.volumeExponent && !power) ||
    ((row.volumeMinimum || row.volumeMaximum) && law.law == VolumeLaw::Fixed && !power);
}

/// Whether a corner has no ground under it.
bool reachesBeyond(const rockfall::SourceRow& row, const rockfall::Terrain& terrain)
{
  for (const std::vector<rockfall::Vec3>& part : row.parts)
  {
    for (const rockfall::Vec3& corner : part)
    {
      const rockfall::Vec3 local = corner - terrain.geometry().origin();
      if (std::isnan(terrain.elevation(local.x(), local.y())))
      {
        return true;
      }
    }
  }
  return false;
}

/// Rows of a kind, and words on the first of them.
struct Rows
{
  std::int64_t count = 0, first = 0;
  std::string words;

  void add(const rockfall::SourceRow& row, const std::string& of)
  {
    if (count++ == 0)
    {
      first = row.row;
      words = of;
    }
  }
};

/// The properties that at least one row takes.
struct Taken
{
  bool shape = false, lengths = false, file = false, scale = false;
  bool volume = false, law = false, deviation = false, minimum = false, maximum = false;
  bool exponent = false, redraw = false;
  bool material = false, name = false, density = false, young = false, poisson = false;
  bool velocity = false, spin = false, orientation = false;
  bool horizontal = false, vertical = false, attitude = false;
  bool amount = false, intensity = false, frequency = false, sourceName = false, sourceId = false;
};

} // namespace

//------------------------------------------------------------------------------
void vtkRockBlockSource::FindIdleOfRows(const Sources& sources, IdleProperties& idle) const
{
  using rockfall::Shape;
  using rockfall::VolumeLaw;
  const vtkNew<vtkRockBlockSource> usual;
  const rockfall::ShapeMix mix = this->ShapeMix.empty()
    ? rockfall::ShapeMix(Shape(this->Shape))
    : rockfall::ShapeMix::fromText(this->ShapeMix);
  const bool steep = this->SlopeThreshold > 0.0;
  Taken taken;
  for (const rockfall::SourceRow& row : sources.rows)
  {
    const rockfall::VolumeDistribution law = sources.maker->volume(row);
    const bool fixed = law.law == VolumeLaw::Fixed;
    const bool bell = law.law == VolumeLaw::Normal || law.law == VolumeLaw::LogNormal;
    const bool ownFrequency = row.frequency || row.frequencyPerHectare || row.frequencyA;
    const bool power = row.frequencyA || (this->PowerLawFrequency > 0.0 && !ownFrequency);
    bool sized = false; // by a volume, if that is fixed
    for (const auto& part : (row.shapes ? *row.shapes : mix).parts)
    {
      const bool box = part.shape == Shape::Box || part.shape == Shape::Ellipsoid;
      const bool file = part.shape == Shape::File;
      taken.lengths |= box && !row.lengths;
      taken.file |= file;
      taken.scale |= file && fixed && !row.volume;
      sized |= !box && (!file || this->ScaleToVolume);
    }
    taken.shape |= !row.shapes;
    taken.volume |= !row.volume && (fixed ? sized : bell);
    taken.law |= !row.volumeLaw && law.law == VolumeLaw(this->VolumeLaw);
    taken.deviation |= !row.volumeDeviation && bell;
    taken.minimum |= !row.volumeMinimum && (!fixed || power);
    taken.maximum |= !row.volumeMaximum && (!fixed || power);
    taken.exponent |= !row.volumeExponent && (law.law == VolumeLaw::PowerLaw || power);
    taken.redraw |= !fixed;
    taken.material |= row.material.empty();
    taken.name |= row.material.empty() && row.materialName.empty();
    taken.density |= row.material.empty() && !row.density;
    taken.young |= row.material.empty() && !row.youngModulus;
    taken.poisson |= row.material.empty() && !row.poissonRatio;
    taken.velocity |= !row.velocity;
    taken.spin |= !row.angularVelocity;
    taken.orientation |= !row.orientation;
    taken.horizontal |= !row.horizontalDeviation;
    taken.vertical |= !row.verticalDeviation;
    taken.attitude |= !row.randomAttitude && !row.attitudeDeviation;
    taken.amount |= !row.amount && !row.intensity;
    taken.intensity |=
      steep || (row.geometry != rockfall::SourceGeometry::Point && !row.amount && !row.intensity);
    taken.frequency |= !ownFrequency;
    taken.sourceName |= steep || row.sourceName.empty();
    taken.sourceId |= !row.sourceId;
  }

  const auto unless = [&](bool of, const char* name, const auto& value, const auto& otherwise,
                        const std::string& why, const char* unit = "")
  {
    if (!of)
    {
      idle.add(name, value, otherwise, why, unit);
    }
  };
  const auto owned = [&](bool of, const char* name, const auto& value, const auto& otherwise)
  {
    if (!of)
    {
      idle.addTo(
        "All rows of FileName have their own of what these properties say", name, value, otherwise);
    }
  };
  const auto nameOf = [](int shape) { return rockfall::shapeName(Shape(shape)); };
  if (taken.shape && !this->ShapeMix.empty())
  {
    idle.add("Shape", nameOf(this->Shape), nameOf(usual->Shape), "ShapeMix names the shapes");
  }
  owned(taken.shape, "Shape", this->Shape, usual->Shape);
  owned(taken.shape, "ShapeMix", this->ShapeMix, usual->ShapeMix);
  unless(taken.lengths, "Lengths", vec3(this->Lengths), vec3(usual->Lengths),
    "only a box or an ellipsoid has lengths", " m");
  const std::string noFile = "no block's shape is \"file\"";
  unless(taken.file, "ShapeFileName", this->ShapeFileName, usual->ShapeFileName, noFile);
  if (!taken.file)
  {
    idle.addTo("No block's shape is \"file\", which alone takes", "ShapeFileMode",
      this->ShapeFileMode, usual->ShapeFileMode);
  }
  unless(taken.scale, "ScaleToVolume", this->ScaleToVolume, usual->ScaleToVolume,
    taken.file ? "the sources have volumes, or a law of volumes" : noFile);
  unless(taken.volume, "Volume", this->Volume, usual->Volume,
    "the volumes of all sources are their own, of a law without a mean, or by Lengths", " m³");
  owned(taken.law, "VolumeLaw", this->VolumeLaw, usual->VolumeLaw);
  unless(taken.deviation, "VolumeDeviation", this->VolumeDeviation, usual->VolumeDeviation,
    "only the normal and the log-normal VolumeLaw have one", " m³");
  const std::string bounds = "only a VolumeLaw that draws, and PowerLawFrequency, have bounds";
  unless(taken.minimum, "VolumeMinimum", this->VolumeMinimum, usual->VolumeMinimum, bounds, " m³");
  unless(taken.maximum, "VolumeMaximum", this->VolumeMaximum, usual->VolumeMaximum, bounds, " m³");
  unless(taken.exponent, "VolumeExponent", this->VolumeExponent, usual->VolumeExponent,
    "only the VolumeLaw Power law, and PowerLawFrequency, have one");
  unless(taken.redraw, "RedrawVolume", this->RedrawVolume, usual->RedrawVolume,
    "VolumeLaw is Fixed: nothing is drawn");

  owned(taken.material, "Material", this->Material, usual->Material);
  owned(taken.name, "MaterialName", this->MaterialName, usual->MaterialName);
  this->FindIdleOfMaterial(idle);
  if (this->Material == 0)
  {
    owned(taken.density, "Density", this->Density, usual->Density);
    owned(taken.young, "YoungModulus", this->YoungModulus, usual->YoungModulus);
    owned(taken.poisson, "PoissonRatio", this->PoissonRatio, usual->PoissonRatio);
  }

  owned(taken.velocity, "Velocity", vec3(this->Velocity), vec3(usual->Velocity));
  owned(taken.spin, "AngularVelocity", vec3(this->AngularVelocity), vec3(usual->AngularVelocity));
  owned(taken.orientation, "RandomOrientation", this->RandomOrientation, usual->RandomOrientation);
  owned(taken.orientation, "Orientation", vec3(this->Orientation), vec3(usual->Orientation));
  if (taken.orientation && this->RandomOrientation)
  {
    idle.add("Orientation", vec3(this->Orientation), vec3(usual->Orientation),
      "RandomOrientation is on", " degrees");
  }
  owned(
    taken.horizontal, "HorizontalDeviation", this->HorizontalDeviation, usual->HorizontalDeviation);
  owned(taken.vertical, "VerticalDeviation", this->VerticalDeviation, usual->VerticalDeviation);
  owned(taken.attitude, "AttitudeLaw", this->AttitudeLaw, usual->AttitudeLaw);
  unless(taken.attitude && this->AttitudeLaw == DEVIATING, "AttitudeDeviation",
    this->AttitudeDeviation, usual->AttitudeDeviation, "only the AttitudeLaw Deviating has one",
    " degrees");

  owned(taken.amount, "TotalVolume", this->TotalVolume, usual->TotalVolume);
  unless(taken.intensity, "Intensity", this->Intensity, usual->Intensity,
    "only lines, areas and steep terrain that do not have their own take one");
  owned(taken.frequency, "AnnualFrequency", this->AnnualFrequency, usual->AnnualFrequency);
  owned(
    taken.frequency, "FrequencyPerHectare", this->FrequencyPerHectare, usual->FrequencyPerHectare);
  owned(taken.frequency, "PowerLawFrequency", this->PowerLawFrequency, usual->PowerLawFrequency);
  owned(taken.sourceName, "SourceName", this->SourceName, usual->SourceName);
  owned(taken.sourceId, "FirstSourceId", this->FirstSourceId, usual->FirstSourceId);
}

//------------------------------------------------------------------------------
void vtkRockBlockSource::FindIdleOfPlace(const Sources& sources, IdleProperties& idle) const
{
  const bool steep = this->SlopeThreshold > 0.0;
  const std::string steepIs =
    "SlopeThreshold is " + rockfall::numberText(this->SlopeThreshold) + " degrees, which ";
  if (this->ReleaseHeight > 0.0 &&
    std::none_of(sources.places.begin(), sources.places.end(),
      [](const rockfall::ReleasePlace& place) { return place.overGround; }))
  {
    idle.add("ReleaseHeight", this->ReleaseHeight, 0.0,
      "PlaceOnGround is off, and every block is where its z says", " m");
  }
  if (steep ||
    std::none_of(sources.rows.begin(), sources.rows.end(),
      [](const rockfall::SourceRow& row)
      { return row.geometry == rockfall::SourceGeometry::Point; }))
  {
    idle.add("ClusterRadius", this->ClusterRadius, 0.0,
      steep ? steepIs + "spreads the blocks over the steep terrain" : "no source is a point", " m");
  }
  const bool file = !this->FileName.empty();
  if (!file)
  {
    idle.add("LayerName", this->LayerName, std::string(), "there is no FileName");
    idle.add("AllowReferences", this->AllowReferences != 0, false, "there is no FileName");
  }

  // The window puts both where nobody has drawn: x, y of two ends, and a block between them.
  std::array<double, 4> placed = { 5.0, 45.0, 5.0, 55.0 };
  double near = 0.01; // m, as the window rounds
  const rockfall::Vec3 usual(rockfall::filters::kDefaultCenter.data());
  const std::vector<double>& p = this->Points;
  const rockfall::Terrain* terrain = sources.ground();
  if (terrain && (p.size() == 6 || vec3(this->Center) != usual))
  {
    const std::array<double, 6> line = rockfall::filters::steepLine(*terrain);
    placed = { line[0], line[1], line[3], line[4] };
  }
  const auto isAt = [&](double x, double y, double atX, double atY)
  { return std::abs(x - atX) <= near && std::abs(y - atY) <= near; };
  const std::string cause = (steep     ? steepIs + "releases from the steep terrain"
                                : file ? "FileName has the sources"
                                : this->Draw == NOTHING ? "Draw is Nothing"
                                                        : "The source is drawn") +
    ", so that these have no effect";
  const bool drawn = !steep && !file && this->Draw != NOTHING;
  const bool untouched = p.size() == 6 && isAt(p[0], p[1], placed[0], placed[1]) &&
    isAt(p[3], p[4], placed[2], placed[3]);
  if (!drawn && !untouched)
  {
    idle.addTo(cause, "Points", p.size(), std::size_t(0));
  }
  if (drawn || steep || file)
  {
    near = terrain ? terrain->geometry().cellSize : 0.0;
    const bool byWindow = isAt(this->Center[0], this->Center[1], 0.5 * (placed[0] + placed[2]),
      0.5 * (placed[1] + placed[3]));
    idle.addTo(cause, "Center", vec3(this->Center), byWindow ? vec3(this->Center) : usual);
  }
}

//------------------------------------------------------------------------------
void vtkRockBlockSource::FindNotes(Sources& sources, bool hasShape) const
{
  if (sources.rows.empty())
  {
    return;
  }
  IdleProperties unused;
  this->FindIdleOfPlace(sources, unused);
  this->FindIdleOfRows(sources, unused);
  std::ranges::move(unused.notes(), std::back_inserter(sources.notes));
  if (hasShape &&
    std::none_of(sources.rocks.begin(), sources.rocks.end(),
      [](const rockfall::filters::ReleasedRock& rock)
      { return rock.shape == rockfall::Shape::File; }))
  {
    sources.notes.push_back(std::string(rockfall::filters::kShapeInput) +
      " is connected, but has no effect: no block's shape is \"file\"");
  }
  std::vector<std::string>& notes = sources.notes;
  Rows idle, moved, beyond;
  rockfall::VolumeDistribution known;
  double mean = known.mean;
  for (const rockfall::SourceRow& row : sources.rows)
  {
    const rockfall::VolumeDistribution law = sources.maker->volume(row);
    if (hasIdle(row, law, row.frequencyA || this->PowerLawFrequency > 0.0))
    {
      idle.add(row, rockfall::volumeLawName(law.law));
    }
    if (isBell(law))
    {
      mean = law == known ? mean : meanOf(law);
      known = law;
      if (std::abs(mean - law.mean) > 0.1 * law.mean)
      {
        moved.add(row,
          rockfall::numberText(mean, 3) + " m³ instead of " + rockfall::numberText(law.mean, 6));
      }
    }
    if (sources.terrain && reachesBeyond(row, *sources.terrain))
    {
      beyond.add(row, "");
    }
  }
  const auto tell = [&](const Rows& rows, const std::string& what)
  {
    if (rows.count > 0)
    {
      notes.push_back((this->FileName.empty() ? "" : this->FileName + ": ") +
        std::to_string(rows.count) + " of " + std::to_string(sources.rows.size()) + " sources " +
        what + (this->FileName.empty() ? "" : ", first row " + std::to_string(rows.first)) +
        (rows.words.empty() ? "" : ": " + rows.words));
    }
  };
  tell(idle, "have a deviation, bounds or an exponent of volumes that their law does not take");
  tell(moved, "have volumes of another mean, as bounds cut their law off");
  tell(beyond, "reach beyond the ground of the slope, on which all their rocks start");
  std::map<std::int64_t, std::string> names;
  std::map<std::string, std::int64_t> numbers; // of rows that have a name of their own
  std::string together, apart;
  for (const rockfall::filters::ReleasedRock& rock : sources.rocks)
  {
    const std::int64_t number = rock.sourceId;
    const std::string& first = names.try_emplace(number, rock.sourceName).first->second;
    if (together.empty() && first != rock.sourceName)
    {
      together = "Sources \"" + first + "\" and \"" + rock.sourceName + "\" have one number, " +
        std::to_string(number) + ": tables by source count them as one";
    }
    const std::int64_t other = numbers.try_emplace(rock.sourceName, number).first->second;
    if (apart.empty() && other != number && rock.sourceName != this->SourceName)
    {
      apart = "Sources " + std::to_string(other) + " and " + std::to_string(number) +
        " have one name, \"" + rock.sourceName + "\": tables by source count them apart";
    }
  }
  for (const std::string& note : { together, apart })
  {
    if (!note.empty())
    {
      notes.push_back(note);
    }
  }
}
