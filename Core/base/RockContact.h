#pragma once

/// @file
/// Laws between two rocks where they touch, by their materials.

#include "base/types.h"

#include <string>

namespace rockfall
{

struct RockContact
{
  double restitution = 0.5;             ///< Of the normal velocity, dimensionless, 0 … 1.
  double frictionAngle = radians(30.0); ///< φ, rad, 0° … 89°.
  double cohesion = 0.0;                ///< c, N per contact point, ≥ 0.
};

/// Two materials, in any order, or one that meets itself.
struct RockContactPair
{
  std::string first, second; ///< Names of materials.
  RockContact contact;
};

} // namespace rockfall
