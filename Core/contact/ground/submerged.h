#pragma once

/// @file
/// The part of a rock under a plane.

#include "contact/PlacedBlock.h"

#include <limits>

namespace rockfall
{

/// A plane: normal · x = offset.
struct Plane
{
  Vec3 normal = Vec3::UnitZ(); ///< Unit.
  double offset = 0.0;         ///< m
};

/// What of a rock is under a plane.
struct Submerged
{
  double area = 0.0; ///< Seen along a direction, m².
  /// Of the lowest corner over the plane, m.
  double lowest = std::numeric_limits<double>::infinity();
};

/// A = ½ Σ A_f |n_f · direction| over the faces of the part under the plane, a closed body;
/// `direction`: unit.
Submerged submerged(const PlacedBlock& rock, const Plane& plane, const Vec3& direction);

} // namespace rockfall
