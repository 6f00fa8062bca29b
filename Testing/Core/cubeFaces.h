#pragma once

/// @file
/// The unit cube as points and faces, for the tests of polyhedra.

#include "base/types.h"

#include <vector>

namespace rockfall::testing
{

using Faces = std::vector<std::vector<int>>;

inline const Faces cubeFaces = { { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 },
  { 0, 2, 3, 1 }, { 4, 5, 7, 6 } };

/// Corners at 0 and 1; the bits of the index are x, y, z.
inline std::vector<Vec3> cubePoints()
{
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i)
  {
    points.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
  }
  return points;
}

} // namespace rockfall::testing
