#pragma once

/// @file
/// Free flight: the motion between contacts, without steps (DESIGN: flight is not stepped where
/// nothing can be touched).

#include "block/Block.h"

namespace rockfall
{

/// Moves a block without strain through free flight by `duration` (s) under `gravity` (m/s², along
/// −z), exactly: the centroid on its parabola, the attitude by FreeRotation. For many times of one
/// flight make the FreeRotation once and ask it.
BlockState fly(const Block& block, const BlockState& state, double gravity, double duration);
/// Where the centroid is then, to the bit.
Vec3 placeInFlight(const BlockState& state, double gravity, double duration);

} // namespace rockfall
