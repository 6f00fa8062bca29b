#pragma once

/// @file
/// Distance of a rock from the slope by separating axes.

#include "contact/PlacedBlock.h"
#include "terrain/Surface.h"

namespace rockfall
{

/// How far a rock is from touching.
struct Clearance
{
  double distance = 0.0; ///< Lower bound of the distance to the patch, m; ≤ 0: may touch.
  double time = 0.0;     ///< Lower bound of the time to the first touch in free flight, s.
};

/// Conservative: per CFE the best of the separating axes (its normal, the world axes, the faces of
/// the rock, the cross products of edges: complete for convex bodies). A fixed axis n is approached
/// no faster than |ω| r − n·v plus gravity. Times beyond `horizon` (s) are not told apart, which
/// spares most of the axes. `ofScar`: of what sinks with Λ alone, not of what is firm.
Clearance clearance(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  double gravity, double horizon, bool ofScar = false);

} // namespace rockfall
