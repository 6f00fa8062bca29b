#pragma once

/// @file
/// Conditions for the release of a rock on a slope.

#include "rock/Rock.h"
#include "rock/parameters.h"
#include "terrain/Terrain.h"

namespace rockfall
{

/// Throws PlacementError or ParameterError naming block and place: a rock that is not over the
/// slope, more than 500 m above it, inside it by more than rounding, or spread wider than it is.
void requireOnSlope(const Terrain& terrain, const Rock& rock, const Block& block);

/// Throws ParameterError if pₙ is so soft that the rock would lie deeper in the ground under its
/// own weight than 2 % of its radius.
void requireStiff(const Rock& rock, const Block& block, const SimulationParameters& parameters);

/// Sets a rock onto the slope that starts in it by no more than the rounding of a grid of single
/// precision (1e-5 m at 50 m, 1 mm at 4000 m), or by no more than `most` (m): one that a simulation
/// left in contact presses the springs. Any other is left as it is.
void setOntoSlope(const Terrain& terrain, Rock& rock, double most = 0.0);

} // namespace rockfall
