#pragma once

/// @file
/// One rock per row of a source layer, what a row leaves open being taken from defaults.

#include "gis/sources.h"
#include "rockFieldData.h"

#include <string>
#include <vector>

namespace rockfall::filters
{

/// What a row may say, as the source's properties say it.
struct RockDefaults
{
  Shape shape = Shape::Cube;
  double volume = 1.0;             ///< m³
  Vec3 lengths = Vec3::Ones();     ///< Of a box, m.
  Vec3 orientation = Vec3::Zero(); ///< Degrees.
  Vec3 velocity = Vec3::Zero();
  Vec3 angularVelocity = Vec3::Zero();
  double density = 2500.0;
  double youngModulus = 1e10;
  double poissonRatio = 0.1;
  std::string shapeFile;
  bool shapeFileAsItIs = false;
  bool scaleToVolume = true;
};

/// Makes rocks in world coordinates, reading the shape file at most once.
class RockMaker
{
public:
  explicit RockMaker(RockDefaults defaults)
    : defaults_(std::move(defaults))
  {
  }

  /// Throws on a bad value, naming it.
  ReleasedRock make(const SourceRow& row, std::int64_t blockId);
  /// What was done to the shape file, one sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

private:
  Polyhedron shape(Shape kind, const SourceRow& row);

  RockDefaults defaults_;
  Polyhedron fromFile_;
  bool haveFile_ = false;
  std::vector<std::string> notes_;
};

/// Degrees about x, y and z to the rotation Rz · Rx · Ry, as vtkTransform's RotateZ, RotateX,
/// RotateY.
Quat orientationFromDegrees(const Vec3& angles);

} // namespace rockfall::filters
