#pragma once

/// @file
/// The part of a rock under a plane.

#include "contact/PlacedBlock.h"

namespace rockfall
{

/// A plane: normal · x = offset.
struct Plane
{
  Vec3 normal = Vec3::UnitZ(); ///< Unit.
  double offset = 0.0;         ///< m
};

/// Area (m²) of what of the rock is under the plane, seen along `direction` (unit):
/// A = ½ Σ A_f |n_f · direction| over the faces of the clipped, closed body.
double submergedArea(const PlacedBlock& rock, const Plane& plane, const Vec3& direction);

} // namespace rockfall
