#pragma once

/// @file
/// Where a rock stands on the slope.

#include "contact/PlacedBlock.h"
#include "geometry/Polyhedron.h"
#include "terrain/Surface.h"

namespace rockfall
{

/// The height of the centroid (m) at which a polyhedron, centroid at the origin, turned by
/// `orientation` (unit), just touches the surface when it comes down along z at this place (local
/// frame, m). Exact for triangulated surfaces: vertices over faces, faces over nodes, edges over
/// edges, those at the rims of holes among them. NaN where there is no CFE under the centroid; what
/// hangs over the edge of the slope touches nothing.
double touchingHeight(
  const Surface& surface, const Polyhedron& shape, const Quat& orientation, double x, double y);

/// How far (m) a rock that is in the slope or in an obstacle of the patch has to go straight up
/// until it is on all of it; 0 if it is in none or only touches. Exact in the same sense: upright
/// walls have tops, and what is over the rock is in its way. The patch must hold all that is under
/// the rock's outline. An unstrained rock is taken.
double liftOut(const PlacedBlock& rock, const SurfacePatch& patch);

/// How deep (m) a rock may start in the slope by rounding alone: heights that were kept in single
/// precision, at the height `z` (m, world coordinates). A thousandth of the rock's radius at most.
double startRounding(double z, double radius);

} // namespace rockfall
