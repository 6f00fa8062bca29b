#include "vtkRockBlockSource.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "geometry/shell.h"
#include "gis/base/externalReferences.h"
#include "run/overlaps.h"
#include "run/releasePlaces.h"
#include "shared/errorReport.h"
#include "shared/slopeReference.h"
#include "shared/terrainFieldData.h"
#include "sources/rockBlockSources.h"
#include "sources/rockMaker.h"
#include "sources/shapeInput.h"

#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <numeric>

vtkStandardNewMacro(vtkRockBlockSource);

namespace
{

using rockfall::filters::refuseProperty;
using rockfall::filters::vec3;

/// Places drawn for a rock until it is in no other one.
constexpr std::uint32_t MOST_PLACES = 1000;

} // namespace

//------------------------------------------------------------------------------
vtkRockBlockSource::vtkRockBlockSource() = default;

//------------------------------------------------------------------------------
vtkRockBlockSource::~vtkRockBlockSource() = default;

//------------------------------------------------------------------------------
void vtkRockBlockSource::MakeRocks(Sources& sources)
{
  sources.rocks.reserve(sources.places.size());
  for (const rockfall::ReleasePlace& place : sources.places)
  {
    const rockfall::SourceRow& row = sources.rows[place.source];
    const vtkIdType blockId = this->FirstBlockId + vtkIdType(sources.rocks.size());
    try
    {
      sources.rocks.push_back(sources.maker->make(row, place.source, place, blockId));
    }
    catch (const rockfall::ParameterError& error)
    {
      // The row is what the user can find again; the block's number is not.
      throw rockfall::ParameterError(
        (this->FileName.empty() ? std::string()
                                : this->FileName + ", row " + std::to_string(row.row) + ": ") +
        error.what());
    }
  }
}

//------------------------------------------------------------------------------
void vtkRockBlockSource::PlaceApart(Sources& sources)
{
  // The largest first: the small ones find room between them.
  std::vector<std::size_t> order(sources.rocks.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto radius = [&](std::size_t k) { return sources.rocks[k].rock.shape.radius(); };
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return radius(a) > radius(b); });
  rockfall::ApartPlacer placer(radius(order.front()));
  const rockfall::PlaceRedrawer redrawer(
    sources.rows, sources.ground(), sources.defaults, this->FileName);
  for (std::size_t done = 0; done < order.size(); ++done)
  {
    rockfall::filters::ReleasedRock& released = sources.rocks[order[done]];
    rockfall::ReleasePlace place = sources.places[order[done]];
    const rockfall::SourceRow& row = sources.rows[place.source];
    bool placed = placer.fits(released.rock);
    std::uint32_t attempt = 0;
    for (; !placed && redrawer.hasOthers(place) && attempt < MOST_PLACES; ++attempt)
    {
      if (redrawer.redraw(place, attempt))
      {
        released = sources.maker->make(row, place.source, place, released.rock.blockId);
        placed = placer.fits(released.rock);
      }
    }
    if (!placed)
    {
      throw rockfall::PlacementError(
        (this->FileName.empty() ? std::string()
                                : this->FileName + ", row " + std::to_string(row.row) + ": ") +
        "KeepApart finds no room for block " + std::to_string(released.rock.blockId) + " of " +
        rockfall::numberText(released.rock.shape.integrals().volume) + " m³, " +
        std::to_string(done) + " of " + std::to_string(order.size()) + " blocks being placed: " +
        (attempt == 0
            ? "all blocks of its source have one place, as ClusterRadius is 0 m"
            : "it is in another one at each of " + std::to_string(attempt) + " places. Take a " +
              (row.geometry == rockfall::SourceGeometry::Point
                  ? "ClusterRadius above " + rockfall::numberText(this->ClusterRadius) + " m"
                  : "larger source") +
              " or fewer blocks"));
    }
    placer.add(released.rock);
  }
}

//------------------------------------------------------------------------------
void vtkRockBlockSource::MakeBlocks(vtkPolyData* terrain, vtkPolyData* surface, vtkPolyData* blocks)
{
  rockfall::filters::RockDefaults defaults;
  rockfall::shapeName(rockfall::Shape(this->Shape)); // throws if there is no such shape
  defaults.shapes = this->ShapeMix.empty() ? rockfall::ShapeMix(rockfall::Shape(this->Shape))
                                           : rockfall::ShapeMix::fromText(this->ShapeMix);
  defaults.volume.deviation = this->VolumeDeviation;
  defaults.volume.minimum = this->VolumeMinimum;
  defaults.volume.maximum = this->VolumeMaximum;
  defaults.volume.exponent = this->VolumeExponent;
  defaults.volume.validate(); // signs, also of what the law has no use for
  defaults.volume.mean = this->Volume;
  defaults.volume.law = rockfall::VolumeLaw(this->VolumeLaw);
  rockfall::volumeLawName(defaults.volume.law); // throws if there is no such law
  defaults.redrawVolume = this->RedrawVolume;
  defaults.lengths = vec3(this->Lengths);
  defaults.orientation = vec3(this->Orientation);
  defaults.velocity = vec3(this->Velocity);
  defaults.angularVelocity = vec3(this->AngularVelocity);
  defaults.density = this->Density;
  defaults.youngModulus = this->YoungModulus;
  defaults.poissonRatio = this->PoissonRatio;
  defaults.material = this->MaterialName;
  rockfall::filters::takeMaterial(this->Material, defaults.density, defaults.youngModulus,
    defaults.poissonRatio, defaults.material);
  rockfall::filters::requireOneShape("ShapeFileName", this->ShapeFileName, surface != nullptr);
  defaults.shapeFile = this->ShapeFileName;
  if (surface)
  {
    defaults.shapeMesh = rockfall::filters::meshOf(surface);
  }
  if (this->ShapeFileMode != CONVEX_HULL && this->ShapeFileMode != AS_IT_IS)
  {
    refuseProperty("ShapeFileMode", this->ShapeFileMode, "0 (convex hull) or 1 (as it is)");
  }
  defaults.shapeAsItIs = this->ShapeFileMode == AS_IT_IS;
  defaults.scaleToVolume = this->ScaleToVolume;
  defaults.uncertainty.horizontalDeviation = this->HorizontalDeviation;
  defaults.uncertainty.verticalDeviation = this->VerticalDeviation;
  if (this->AttitudeLaw < AS_GIVEN || this->AttitudeLaw > RANDOM_UNLESS_GIVEN)
  {
    refuseProperty("AttitudeLaw", this->AttitudeLaw, "0 to 3");
  }
  defaults.randomUnlessGiven = this->AttitudeLaw == RANDOM_UNLESS_GIVEN;
  defaults.uncertainty.attitude = defaults.randomUnlessGiven
    ? rockfall::AttitudeLaw::AsGiven
    : rockfall::AttitudeLaw(this->AttitudeLaw);
  defaults.uncertainty.attitudeDeviation = rockfall::radians(this->AttitudeDeviation);
  defaults.uncertainty.validate();
  this->CheckSeed();
  defaults.seed = std::uint64_t(this->Seed);
  defaults.sourceName = this->SourceName;
  defaults.firstSourceId = this->FirstSourceId;

  defaults.randomOrientation = this->RandomOrientation;

  const rockfall::AllowReferences references(this->AllowReferences != 0);
  this->CheckFrequencies();
  Sources sources;
  this->FindSources(terrain, sources);
  sources.maker.emplace(defaults, sources.ground());
  this->FindPlaces(sources);
  this->MakeRocks(sources);
  if (this->KeepApart)
  {
    this->PlaceApart(sources);
  }
  this->SetFrequencies(sources);
  rockfall::filters::writeRocks(sources.rocks, blocks);
  rockfall::filters::writeCrs(sources.crs, blocks->GetFieldData());
  if (terrain)
  {
    rockfall::filters::referToSlope(terrain->GetFieldData(), blocks->GetFieldData());
  }
  const std::vector<std::string>& made = sources.maker->notes();
  sources.notes.insert(sources.notes.end(), made.begin(), made.end());
  this->FindNotes(sources, surface != nullptr);
  rockfall::filters::showNotes(sources.notes, blocks->GetFieldData());
}

//------------------------------------------------------------------------------
void vtkRockBlockSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto printVector = [&](const char* name, const double v[3])
  { os << indent << name << ": " << v[0] << " " << v[1] << " " << v[2] << "\n"; };
  os << indent << "Shape: " << this->Shape << "\n";
  os << indent << "Volume: " << this->Volume << "\n";
  os << indent
     << "ShapeFileName: " << (this->ShapeFileName.empty() ? "(none)" : this->ShapeFileName) << "\n";
  os << indent << "ShapeFileMode: " << this->ShapeFileMode << "\n";
  os << indent << "ScaleToVolume: " << this->ScaleToVolume << "\n";
  printVector("AngularVelocity", this->AngularVelocity);
  os << indent << "FileName: " << (this->FileName.empty() ? "(none)" : this->FileName) << "\n";
  os << indent << "AllowReferences: " << this->AllowReferences << "\n";
  os << indent << "LayerName: " << (this->LayerName.empty() ? "(none)" : this->LayerName) << "\n";
  os << indent << "Draw: " << this->Draw << "\n";
  os << indent << "Points: " << this->Points.size() / 3 << "\n";
  os << indent << "PlacedLine:";
  for (const double number : this->PlacedLine)
  {
    os << " " << number;
  }
  os << "\n";
  os << indent << "TargetCRS: " << (this->TargetCRS.empty() ? "(none)" : this->TargetCRS) << "\n";
  os << indent << "ShapeMix: " << (this->ShapeMix.empty() ? "(none)" : this->ShapeMix) << "\n";
  os << indent << "VolumeLaw: " << this->VolumeLaw << "\n";
  os << indent << "VolumeDeviation: " << this->VolumeDeviation << "\n";
  os << indent << "VolumeMinimum: " << this->VolumeMinimum << "\n";
  os << indent << "VolumeMaximum: " << this->VolumeMaximum << "\n";
  os << indent << "VolumeExponent: " << this->VolumeExponent << "\n";
  os << indent << "Amount: " << this->Amount << "\n";
  os << indent << "Intensity: " << this->Intensity << "\n";
  os << indent << "TotalVolume: " << this->TotalVolume << "\n";
  os << indent << "AnnualFrequency: " << this->AnnualFrequency << "\n";
  os << indent << "FrequencyPerHectare: " << this->FrequencyPerHectare << "\n";
  os << indent << "PowerLawFrequency: " << this->PowerLawFrequency << "\n";
  os << indent << "ClusterRadius: " << this->ClusterRadius << "\n";
  os << indent << "KeepApart: " << this->KeepApart << "\n";
  os << indent << "RandomOrientation: " << this->RandomOrientation << "\n";
  os << indent << "SlopeThreshold: " << this->SlopeThreshold << "\n";
  os << indent << "HorizontalDeviation: " << this->HorizontalDeviation << "\n";
  os << indent << "VerticalDeviation: " << this->VerticalDeviation << "\n";
  os << indent << "AttitudeLaw: " << this->AttitudeLaw << "\n";
  os << indent << "AttitudeDeviation: " << this->AttitudeDeviation << "\n";
  os << indent << "RedrawVolume: " << this->RedrawVolume << "\n";
  os << indent << "FirstSourceId: " << this->FirstSourceId << "\n";
}
