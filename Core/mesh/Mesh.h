#pragma once

/// @file
/// Points and faces as a file has them, before anybody looks at what body they make.

#include "base/types.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rockfall
{

struct Mesh
{
  std::vector<Vec3> points; ///< m, in double precision whatever the format.
  /// Loops of point numbers, each of at least three and all of points that are there.
  std::vector<std::vector<int>> faces;
  /// Largest error of a coordinate by how the file stores it, m: that of single precision, or of
  /// the digits that a text has. 0 where every number is exact as far as anybody can tell.
  double rounding = 0.0;
  std::string stored;             ///< Why they are rounded: "in single precision".
  std::vector<std::string> notes; ///< Assumptions, one sentence each.
};

/// More points or faces than these are no shape of a rock.
constexpr std::int64_t kMostMeshPoints = 100'000'000;

} // namespace rockfall
