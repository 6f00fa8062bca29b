#pragma once

/// @file
/// Rocks from the rows of a source layer, what a row leaves open being taken from defaults.

#include "gis/layers/sources.h"
#include "mesh/Mesh.h"
#include "run/releasePlaces.h"
#include "shared/rockFieldData.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace rockfall::filters
{

/// Fields of a row, as the source's properties say it.
struct RockDefaults
{
  ShapeMix shapes = Shape::Cube;
  VolumeDistribution volume;
  Vec3 lengths = Vec3::Ones();     ///< Of a box, m.
  Vec3 orientation = Vec3::Zero(); ///< Degrees.
  Vec3 velocity = Vec3::Zero();
  Vec3 angularVelocity = Vec3::Zero();
  double density = 2500.0;
  double youngModulus = 1e10;
  double poissonRatio = 0.1;
  std::string material; ///< Name of the material, for contacts of rocks; empty: none.
  std::string shapeFile;
  std::optional<Mesh> shapeMesh; ///< Instead of a file.
  bool shapeAsItIs = false;      ///< Else its convex hull.
  bool scaleToVolume = true;
  bool randomOrientation = false; ///< The attitude is drawn once, instead of `orientation`.
  bool redrawVolume = false;      ///< The volume is drawn in each iteration.
  ReleaseUncertainty uncertainty; ///< Of all but the volume.
  /// The attitude is drawn in each iteration where neither a row nor what is above gives one.
  bool randomUnlessGiven = false;
  std::int64_t firstSourceId = 1;
  std::string sourceName; ///< Of sources without a name; empty: "source n".
  std::uint64_t seed = 1;
};

/// Makes rocks in world coordinates, reading the shape file at most once.
class RockMaker
{
public:
  /// `terrain` is for rocks that stand over the ground; null if there is none. It is kept.
  RockMaker(RockDefaults defaults, const Terrain* terrain)
    : defaults_(std::move(defaults))
    , terrain_(terrain)
  {
  }

  /// `index` counts sources, from 0. Throws on a bad value, naming it.
  ReleasedRock make(
    const SourceRow& row, std::size_t index, const ReleasePlace& place, std::int64_t blockId);
  /// How the rocks of a row are distributed.
  VolumeDistribution volume(const SourceRow& row) const;
  /// How many rocks of a source, whose draws begin at `firstDraw`, have this volume in all (m³,
  /// > 0), as nearly as whole rocks can; at least 1, and at most `most`.
  std::int64_t amountOf(
    const SourceRow& row, std::uint64_t firstDraw, double totalVolume, std::int64_t most);
  /// Notes on the shape file, one sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

private:
  rockfall::Shape kindOf(const SourceRow& row, std::uint64_t draw) const;
  Polyhedron givenShape(); ///< The file's or the input's.
  Polyhedron shape(
    Shape kind, const SourceRow& row, const VolumeDistribution& law, std::uint64_t draw);
  /// Throws ParameterError unless the row's shape is a box, or may be.
  void refuseLengths(const SourceRow& row) const;
  void setMaterial(const SourceRow& row, Rock& rock) const;
  void setUncertainty(
    const SourceRow& row, const VolumeDistribution& law, ReleaseUncertainty& unsure) const;

  RockDefaults defaults_;
  const Terrain* terrain_;
  std::map<Shape, Polyhedron> made_; ///< Of volume 1; the file's as it is.
  std::vector<std::string> notes_;
};

/// The values of a kind of rock by its number in the sources' property Material, if that is not 0,
/// and its name where `name` is empty; throws ParameterError naming the number.
void takeMaterial(
  int number, double& density, double& youngModulus, double& poissonRatio, std::string& name);

inline Vec3 vec3(const double v[3])
{
  return { v[0], v[1], v[2] };
}

/// Throws ParameterError: "name is value, it must be rule".
[[noreturn]] void refuseProperty(const char* name, int value, const char* rule);

/// Throws ParameterError naming the field if a component is not finite.
void requireFinite(const Vec3& value, const char* field);

/// Degrees about x, y and z to the rotation Rz · Rx · Ry, as vtkTransform's RotateZ, RotateX,
/// RotateY.
Quat orientationFromDegrees(const Vec3& angles);

} // namespace rockfall::filters
