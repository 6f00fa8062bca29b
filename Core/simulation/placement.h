#pragma once

/// @file
/// Where a rock stands on the slope.

#include "geometry/Polyhedron.h"
#include "terrain/Surface.h"

namespace rockfall
{

/// The height of the centroid (m) at which a polyhedron, centroid at the origin, turned by
/// `orientation` (unit), just touches the surface when it comes down along z at this place (local
/// frame, m). Exact for triangulated surfaces: vertices over faces, faces over nodes, edges over
/// edges. NaN where there is no CFE under the centroid; what hangs over the edge of the slope
/// touches nothing.
double touchingHeight(
  const Surface& surface, const Polyhedron& shape, const Quat& orientation, double x, double y);

} // namespace rockfall
