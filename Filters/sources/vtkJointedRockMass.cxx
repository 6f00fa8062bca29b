#include "vtkJointedRockMass.h"

#include "base/require.h"
#include "base/text/numberText.h"
#include "geometry/jointSets.h"
#include "geometry/shell.h"
#include "mesh/shapeFile.h"
#include "rock/placement.h"
#include "shared/arrays.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/slopeReference.h"
#include "shared/terrainFieldData.h"
#include "sources/drawnSource.h"
#include "sources/rockMaker.h"
#include "sources/shapeInput.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <cmath>
#include <optional>

vtkStandardNewMacro(vtkJointedRockMass);

namespace
{

using rockfall::filters::vec3;

/// A closed surface as it is: a mass that its hull stood for would be another one.
rockfall::Polyhedron readMass(
  const std::string& fileName, vtkPolyData* surface, std::vector<std::string>& notes)
{
  rockfall::filters::requireOneShape("MassFileName", fileName, surface != nullptr);
  if (fileName.empty() && !surface)
  {
    throw rockfall::FileError("MassFileName is empty, and nothing is connected to the Shape input: "
                              "the mass \"from file\" needs a closed surface");
  }
  try
  {
    return surface ? rockfall::shapeOf(rockfall::filters::meshOf(surface),
                       rockfall::filters::kShapeInput, true, notes)
                   : rockfall::readShape(fileName, true, notes);
  }
  catch (const rockfall::GeometryError& error)
  {
    const std::string text = error.what();
    throw rockfall::GeometryError(text.find("not convex") == std::string::npos
        ? text
        : text + ". A rock mass must be convex: divide it into convex parts, one source for each");
  }
}

} // namespace

//------------------------------------------------------------------------------
vtkJointedRockMass::vtkJointedRockMass()
  : JointSets{ { 0.0, 0.0, 1.0, 0.5, 0.0, 0.0 }, { 90.0, 90.0, 1.0, 0.5, 0.0, 0.0 },
    { 90.0, 0.0, 1.0, 0.5, 0.0, 0.0 } }
{
  this->MaximumRocks = 100000;
  for (double& length : this->Lengths)
  {
    length = 3.0;
  }
}

//------------------------------------------------------------------------------
vtkJointedRockMass::~vtkJointedRockMass() = default;

//------------------------------------------------------------------------------
void vtkJointedRockMass::SetNumberOfJointSets(int number)
{
  const std::size_t size = number > 0 ? std::size_t(number) : 0;
  if (size != this->JointSets.size())
  {
    this->JointSets.resize(size);
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkJointedRockMass::GetNumberOfJointSets()
{
  return int(this->JointSets.size());
}

//------------------------------------------------------------------------------
void vtkJointedRockMass::SetJointSet(int index, double dip, double dipDirection, double spacing,
  double offset, double spacingDeviation, double orientationDeviation)
{
  if (index < 0)
  {
    vtkErrorMacro("There is no joint set " << index);
    return;
  }
  if (std::size_t(index) >= this->JointSets.size())
  {
    this->JointSets.resize(std::size_t(index) + 1);
  }
  const std::array<double, 6> set = { dip, dipDirection, spacing, offset, spacingDeviation,
    orientationDeviation };
  if (this->JointSets[std::size_t(index)] != set)
  {
    this->JointSets[std::size_t(index)] = set;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkJointedRockMass::IdleNotes() const
{
  rockfall::filters::IdleProperties idle;
  const vtkNew<vtkJointedRockMass> usual;
  if (!this->PlaceOnGround)
  {
    idle.add("ReleaseHeight", this->ReleaseHeight, usual->ReleaseHeight,
      "PlaceOnGround is off, so the rock mass is where it is given", " m");
  }
  if (this->MassShape == BOX)
  {
    idle.add("MassFileName", this->MassFileName, usual->MassFileName, "MassShape is 0 (box)");
  }
  else
  {
    const char* cause = "MassShape is 1 (from file), where these have no effect";
    idle.addTo(cause, "Center", vec3(this->Center), vec3(usual->Center));
    idle.addTo(cause, "Lengths", vec3(this->Lengths), vec3(usual->Lengths));
    idle.addTo(cause, "Orientation", vec3(this->Orientation), vec3(usual->Orientation));
  }
  this->FindIdleOfMaterial(idle);
  return idle.notes();
}

//------------------------------------------------------------------------------
void vtkJointedRockMass::MakeBlocks(
  vtkPolyData* terrainInput, vtkPolyData* surface, vtkPolyData* blocks)
{
  using namespace rockfall; // all that follows is the Core's
  std::optional<Terrain> terrain;
  if (terrainInput)
  {
    terrain = filters::readTerrain(terrainInput);
  }
  if (this->PlaceOnGround && !terrain)
  {
    throw ParameterError("PlaceOnGround is on, which needs the Terrain input");
  }
  require(this->ReleaseHeight >= 0.0 && std::isfinite(this->ReleaseHeight), "ReleaseHeight",
    this->ReleaseHeight, " m", "finite and at least 0");
  this->CheckSeed();
  std::vector<std::string> notes = this->IdleNotes();

  // About its centroid, where the numbers are small.
  Polyhedron mass;
  Vec3 centre = vec3(this->Center);
  bool onGround = this->PlaceOnGround;
  if (this->MassShape == BOX)
  {
    if (const auto place = terrain
        ? filters::placeByDefault(*terrain, this->Center, "the mass", notes)
        : std::nullopt)
    {
      centre = *place;
      centre.z() = this->Center[2];
      onGround = true;
    }
    filters::requireFinite(centre, "Center");
    filters::requireFinite(vec3(this->Orientation), "Orientation");
    mass =
      makeBox(vec3(this->Lengths))
        .transformed(1.0, filters::orientationFromDegrees(vec3(this->Orientation)), Vec3::Zero());
  }
  else if (this->MassShape == FROM_FILE)
  {
    mass = readMass(this->MassFileName, surface, notes);
    centre = mass.integrals().centroid;
    mass = mass.centred();
  }
  else
  {
    throw ParameterError(
      "MassShape is " + std::to_string(this->MassShape) + ", it must be 0 (box) or 1 (from file)");
  }
  if (onGround)
  {
    const Vec3 local = centre - terrain->geometry().origin();
    const double height =
      touchingHeight(Surface::asSurveyed(*terrain), mass, Quat::Identity(), local.x(), local.y());
    if (std::isnan(height))
    {
      throw PlacementError("The rock mass at (" + numberText(centre.x()) + ", " +
        numberText(centre.y()) + ")" + whyNoGround(*terrain, centre.x(), centre.y()));
    }
    centre.z() = height + this->ReleaseHeight;
  }

  std::vector<JointSet> sets;
  for (const std::array<double, 6>& row : this->JointSets)
  {
    JointSet& set = sets.emplace_back();
    set.dip = radians(row[0]);
    set.dipDirection = radians(row[1]);
    set.spacing = row[2];
    set.offset = row[3];
    set.spacingDeviation = row[4];
    set.orientationDeviation = radians(row[5]);
  }
  MassCut how;
  how.slivers = rockfall::SliverRule(this->Slivers);
  how.leastThickness = this->MinimumThickness;
  how.leastVolume = this->MinimumVolume;
  how.mostBlocks = this->MaximumRocks;
  how.seed = std::uint64_t(this->Seed);
  const CutMass cut = cutMass(mass, sets, how, centre);

  filters::ReleasedRock like;
  like.sourceId = this->SourceId;
  like.sourceName =
    this->SourceName.empty() ? "source " + std::to_string(this->SourceId) : this->SourceName;
  like.rock.density = this->Density;
  like.rock.youngModulus = this->YoungModulus;
  like.rock.poissonRatio = this->PoissonRatio;
  like.rock.velocity = vec3(this->Velocity);
  like.rock.material = this->MaterialName;
  filters::takeMaterial(this->Material, like.rock.density, like.rock.youngModulus,
    like.rock.poissonRatio, like.rock.material);
  std::vector<filters::ReleasedRock> rocks;
  rocks.reserve(cut.blocks.size());
  for (const Polyhedron& block : cut.blocks)
  {
    filters::ReleasedRock& released = rocks.emplace_back(like);
    released.rock.blockId = this->FirstBlockId + std::int64_t(rocks.size()) - 1;
    released.rock.position = centre + block.integrals().centroid;
    released.rock.shape = block.centred();
    released.rock.validate();
  }
  filters::writeRocks(rocks, blocks);
  filters::writeCrs(terrain ? terrain->geometry().crs : std::string(), blocks->GetFieldData());
  if (terrain)
  {
    filters::referToSlope(terrainInput->GetFieldData(), blocks->GetFieldData());
  }
  filters::addArray<vtkIdTypeArray>(blocks->GetFieldData(), "SliverCount")
    ->InsertNextValue(cut.slivers);
  filters::addArray<vtkDoubleArray>(blocks->GetFieldData(), "SliverVolume")
    ->InsertNextValue(cut.sliverVolume);
  if (surface && this->MassShape != FROM_FILE)
  {
    notes.push_back(
      std::string(filters::kShapeInput) + " is connected, but has no effect: MassShape is 0 (box)");
  }
  if (cut.slivers > 0)
  {
    notes.push_back("The rock mass is cut into " + std::to_string(rocks.size()) + " blocks; " +
      std::to_string(cut.slivers) + " slivers of " + numberText(cut.sliverVolume) +
      " m³ in all are " + (how.slivers == rockfall::SliverRule::Drop ? "left out" : "among them"));
  }
  filters::showNotes(notes, blocks->GetFieldData());
}

//------------------------------------------------------------------------------
void vtkJointedRockMass::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MassShape: " << this->MassShape << "\n";
  os << indent << "MassFileName: " << (this->MassFileName.empty() ? "(none)" : this->MassFileName)
     << "\n";
  os << indent << "JointSets:";
  for (const std::array<double, 6>& set : this->JointSets)
  {
    for (const double value : set)
    {
      os << " " << value;
    }
    os << ";";
  }
  os << "\n";
  os << indent << "Slivers: " << this->Slivers << "\n";
  os << indent << "MinimumThickness: " << this->MinimumThickness << "\n";
  os << indent << "MinimumVolume: " << this->MinimumVolume << "\n";
  os << indent << "SourceId: " << this->SourceId << "\n";
}
