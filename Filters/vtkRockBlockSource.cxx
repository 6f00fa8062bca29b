#include "vtkRockBlockSource.h"

#include "base/errors.h"
#include "failure.h"
#include "geometry/shell.h"
#include "pieces.h"
#include "rockMaker.h"
#include "simulation/releasePlaces.h"
#include "terrainFieldData.h"

#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <new>
#include <optional>

vtkStandardNewMacro(vtkRockBlockSource);

/// What is released from where.
struct vtkRockBlockSource::Sources
{
  std::optional<rockfall::Terrain> terrain;
  std::vector<rockfall::SourceRow> rows;
  std::vector<rockfall::ReleasePlace> places;
  std::string crs; ///< WKT of the places, empty if it is not known.
};

namespace
{

constexpr int TERRAIN = 1;

rockfall::Vec3 vec3(const double v[3])
{
  return { v[0], v[1], v[2] };
}

[[noreturn]] void refuse(const char* name, int value, const char* rule)
{
  throw rockfall::ParameterError(
    std::string(name) + " is " + std::to_string(value) + ", it must be " + rule);
}

} // namespace

//------------------------------------------------------------------------------
vtkRockBlockSource::vtkRockBlockSource()
{
  this->SetNumberOfInputPorts(2);
}

//------------------------------------------------------------------------------
vtkRockBlockSource::~vtkRockBlockSource() = default;

//------------------------------------------------------------------------------
int vtkRockBlockSource::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

//------------------------------------------------------------------------------
vtkRockBlockSource::Sources vtkRockBlockSource::FindSources(vtkPolyData* terrainInput)
{
  Sources sources;
  if (terrainInput)
  {
    sources.terrain = rockfall::filters::readTerrain(terrainInput);
  }
  const rockfall::Terrain* terrain = sources.terrain ? &*sources.terrain : nullptr;
  sources.crs = rockfall::wktOfCrs(this->TargetCRS);
  if (terrain && !terrain->geometry().crs.empty())
  {
    if (!rockfall::sameCrs(terrain->geometry().crs, this->TargetCRS))
    {
      throw rockfall::ParameterError("TargetCRS is \"" + this->TargetCRS +
        "\", but the terrain is in " + rockfall::labelOfCrs(terrain->geometry().crs) +
        "; leave TargetCRS empty where there is a terrain");
    }
    sources.crs = terrain->geometry().crs;
  }

  rockfall::ReleaseDefaults defaults;
  defaults.amount = this->Amount;
  defaults.intensity = this->Intensity;
  defaults.height = this->ReleaseHeight;
  defaults.onGround = this->PlaceOnGround;
  defaults.seed = std::uint64_t(this->Seed);
  defaults.mostRocks = this->MaximumRocks;
  defaults.validate();
  if (this->PlaceOnGround && !terrain)
  {
    throw rockfall::ParameterError("PlaceOnGround is on, which needs the Terrain input");
  }
  if (!(this->SlopeThreshold >= 0.0 && this->SlopeThreshold <= 89.0))
  {
    throw rockfall::ParameterError("SlopeThreshold is " +
      rockfall::numberText(this->SlopeThreshold) + " degrees, it must be 0 to 89");
  }
  if (this->SlopeThreshold > 0.0)
  {
    if (!terrain || !this->FileName.empty())
    {
      throw rockfall::ParameterError("SlopeThreshold is " +
        rockfall::numberText(this->SlopeThreshold) +
        (terrain ? " degrees and FileName is \"" + this->FileName +
              "\": sources are the one or the other"
                 : " degrees, which needs the Terrain input"));
    }
    rockfall::SourceRow& steep = sources.rows.emplace_back();
    steep.sourceName = this->SourceName.empty() ? "steep cells" : this->SourceName;
    sources.places =
      rockfall::steepPlaces(*terrain, rockfall::radians(this->SlopeThreshold), defaults);
    return sources;
  }
  if (this->FileName.empty())
  {
    sources.rows.emplace_back().position = vec3(this->Center);
  }
  else
  {
    rockfall::SourceOptions options;
    options.targetCrs = sources.crs;
    options.haveTerrain = terrain != nullptr;
    options.mostRocks = this->MaximumRocks;
    rockfall::SourceLayer layer = rockfall::readSourceLayer(this->FileName, options);
    if (terrain)
    {
      rockfall::requireOverlap(layer.rows, *terrain, this->FileName, layer.ownCrs);
    }
    sources.rows = std::move(layer.rows);
    sources.crs = std::move(layer.crs);
  }
  sources.places = rockfall::releasePlaces(sources.rows, terrain, defaults, this->FileName);
  return sources;
}

//------------------------------------------------------------------------------
int vtkRockBlockSource::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (rockfall::filters::isFurtherPiece(outputVector))
  {
    return 1;
  }
  vtkPolyData* terrain = vtkPolyData::GetData(inputVector[TERRAIN]);
  if (terrain && rockfall::filters::inheritFailure(terrain, this))
  {
    return 1;
  }
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  try
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
    rockfall::filters::takeMaterial(
      this->Material, defaults.density, defaults.youngModulus, defaults.poissonRatio);
    defaults.shapeFile = this->ShapeFileName;
    if (this->ShapeFileMode != CONVEX_HULL && this->ShapeFileMode != AS_IT_IS)
    {
      refuse("ShapeFileMode", this->ShapeFileMode, "0 (convex hull) or 1 (as it is)");
    }
    defaults.shapeFileAsItIs = this->ShapeFileMode == AS_IT_IS;
    defaults.scaleToVolume = this->ScaleToVolume;
    defaults.uncertainty.horizontalDeviation = this->HorizontalDeviation;
    defaults.uncertainty.verticalDeviation = this->VerticalDeviation;
    defaults.uncertainty.attitude = rockfall::AttitudeLaw(this->AttitudeLaw);
    defaults.uncertainty.attitudeDeviation = rockfall::radians(this->AttitudeDeviation);
    defaults.uncertainty.validate();
    if (this->Seed < 0)
    {
      refuse("Seed", this->Seed, "at least 0");
    }
    defaults.seed = std::uint64_t(this->Seed);
    defaults.sourceName = this->SourceName;
    defaults.firstSourceId = this->FirstSourceId;

    const Sources sources = this->FindSources(terrain);
    rockfall::filters::RockMaker maker(defaults, sources.terrain ? &*sources.terrain : nullptr);
    std::vector<rockfall::filters::ReleasedRock> rocks;
    rocks.reserve(sources.places.size());
    for (const rockfall::ReleasePlace& place : sources.places)
    {
      const rockfall::SourceRow& row = sources.rows[place.source];
      const vtkIdType blockId = this->FirstBlockId + vtkIdType(rocks.size());
      try
      {
        rocks.push_back(maker.make(row, place.source, place, blockId));
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
    vtkNew<vtkPolyData> blocks;
    rockfall::filters::writeRocks(rocks, blocks);
    rockfall::filters::writeCrs(sources.crs, blocks->GetFieldData());
    for (const std::string& note : maker.notes())
    {
      rockfall::filters::showNote(note);
    }
    output->ShallowCopy(blocks);
    return 1;
  }
  catch (const rockfall::Error& error)
  {
    return rockfall::filters::fail(this, error.what());
  }
  catch (const std::bad_alloc&)
  {
    return rockfall::filters::fail(this, "The rock blocks do not fit in memory");
  }
}

//------------------------------------------------------------------------------
void vtkRockBlockSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto printVector = [&](const char* name, const double v[3])
  { os << indent << name << ": " << v[0] << " " << v[1] << " " << v[2] << "\n"; };
  os << indent << "Shape: " << this->Shape << "\n";
  os << indent << "Volume: " << this->Volume << "\n";
  printVector("Lengths", this->Lengths);
  os << indent
     << "ShapeFileName: " << (this->ShapeFileName.empty() ? "(none)" : this->ShapeFileName) << "\n";
  os << indent << "ShapeFileMode: " << this->ShapeFileMode << "\n";
  os << indent << "ScaleToVolume: " << this->ScaleToVolume << "\n";
  printVector("Center", this->Center);
  printVector("Orientation", this->Orientation);
  printVector("Velocity", this->Velocity);
  printVector("AngularVelocity", this->AngularVelocity);
  os << indent << "Density: " << this->Density << "\n";
  os << indent << "YoungModulus: " << this->YoungModulus << "\n";
  os << indent << "PoissonRatio: " << this->PoissonRatio << "\n";
  os << indent << "FileName: " << (this->FileName.empty() ? "(none)" : this->FileName) << "\n";
  os << indent << "TargetCRS: " << (this->TargetCRS.empty() ? "(none)" : this->TargetCRS) << "\n";
  os << indent << "FirstBlockId: " << this->FirstBlockId << "\n";
  os << indent << "ShapeMix: " << (this->ShapeMix.empty() ? "(none)" : this->ShapeMix) << "\n";
  os << indent << "VolumeLaw: " << this->VolumeLaw << "\n";
  os << indent << "VolumeDeviation: " << this->VolumeDeviation << "\n";
  os << indent << "VolumeMinimum: " << this->VolumeMinimum << "\n";
  os << indent << "VolumeMaximum: " << this->VolumeMaximum << "\n";
  os << indent << "VolumeExponent: " << this->VolumeExponent << "\n";
  os << indent << "Material: " << this->Material << "\n";
  os << indent << "Amount: " << this->Amount << "\n";
  os << indent << "Intensity: " << this->Intensity << "\n";
  os << indent << "SlopeThreshold: " << this->SlopeThreshold << "\n";
  os << indent << "PlaceOnGround: " << this->PlaceOnGround << "\n";
  os << indent << "ReleaseHeight: " << this->ReleaseHeight << "\n";
  os << indent << "HorizontalDeviation: " << this->HorizontalDeviation << "\n";
  os << indent << "VerticalDeviation: " << this->VerticalDeviation << "\n";
  os << indent << "AttitudeLaw: " << this->AttitudeLaw << "\n";
  os << indent << "AttitudeDeviation: " << this->AttitudeDeviation << "\n";
  os << indent << "RedrawVolume: " << this->RedrawVolume << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "MaximumRocks: " << this->MaximumRocks << "\n";
  os << indent << "SourceName: " << (this->SourceName.empty() ? "(none)" : this->SourceName)
     << "\n";
  os << indent << "FirstSourceId: " << this->FirstSourceId << "\n";
}
