#pragma once

/// @file
/// Rocks that are in each other when they are released.

#include "simulation/ensemble.h"

#include <span>
#include <vector>

namespace rockfall
{

/// Two rocks that overlap.
struct RockOverlap
{
  int first = -1;              ///< Index of a rock.
  int second = -1;             ///< Larger.
  double depth = 0.0;          ///< m, > 0.
  Vec3 normal = Vec3::UnitZ(); ///< The shortest way out for the first rock, unit.
};

/// All pairs that are in each other by more than rounding (1e-6 of the smaller radius), in
/// ascending order.
std::vector<RockOverlap> findOverlaps(std::span<const Rock> rocks);

} // namespace rockfall
