#pragma once

/// @file
/// Free flight: the motion between contacts, without steps (DESIGN: flight is not stepped where
/// nothing can be touched).

#include "block/Block.h"

namespace rockfall
{

/// Moves a block without strain through free flight by `duration` (s) under `gravity` (m/s², along
/// −z). The centroid follows the parabola exactly. Angular momentum is constant in world axes by
/// construction; the attitude is exact for equal principal moments, else integrated by a
/// fourth-order Runge–Kutta rule at 0.02 rad per step (local energy error below 1e-10, relative).
BlockState fly(const Block& block, const BlockState& state, double gravity, double duration);

} // namespace rockfall
