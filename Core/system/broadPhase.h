#pragma once

/// @file
/// Which rocks are near each other, by the map that finds the slope under a rock (paper 2.3.2):
/// cells in the x–y plane.

#include "base/types.h"

#include <array>
#include <span>
#include <vector>

namespace rockfall
{

/// A sphere that holds a rock during a step.
struct BroadBox
{
  Vec3 center = Vec3::Zero(); ///< m
  double radius = 0.0;        ///< m
  bool present = true;
  bool moves = true; ///< Two that don't move are no pair.
};

/// All pairs whose spheres overlap, smaller index first, in ascending order. Rocks of very
/// different size stand in maps of different cells, each twice as wide as the last, so that the
/// cost does not grow with the ratio of their sizes.
std::vector<std::array<int, 2>> findNear(std::span<const BroadBox> boxes);

} // namespace rockfall
