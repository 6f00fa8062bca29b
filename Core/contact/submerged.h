#pragma once

/// @file
/// The part of a rock under a plane.

#include "contact/PlacedBlock.h"

#include <algorithm>
#include <limits>

namespace rockfall
{

/// A plane: normal · x = offset.
struct Plane
{
  Vec3 normal = Vec3::UnitZ(); ///< Unit.
  double offset = 0.0;         ///< m
};

/// The mark that a rock leaves on a surface, along a direction: from the first to the last place of
/// it that was under the surface.
struct SurfaceMark
{
  Vec3 along = Vec3::Zero(); ///< Unit; zero: not known yet.
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();

  double length() const { return std::max(0.0, most - least); } ///< m
  void add(const Vec3& place)
  {
    const double at = along.dot(place);
    least = std::min(least, at);
    most = std::max(most, at);
  }
};

/// Area (m²) of what of the rock is under the plane, seen along `direction` (unit):
/// A = ½ Σ A_f |n_f · direction| over the faces of the clipped, closed body. Corners of what is
/// under it are added to the mark.
double submergedArea(
  const PlacedBlock& rock, const Plane& plane, const Vec3& direction, SurfaceMark* mark = nullptr);

} // namespace rockfall
