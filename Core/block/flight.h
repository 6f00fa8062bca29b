#pragma once

/// @file
/// Free flight: the motion between contacts, without steps (DESIGN: flight is not stepped where
/// nothing can be touched), and the way of a step between its ends.

#include "block/Block.h"

namespace rockfall
{

class FreeRotation;

/// Moves a block without strain through free flight by `duration` (s) under `gravity` (m/s², along
/// −z), exactly: the centroid on its parabola, the attitude by FreeRotation.
BlockState fly(const Block& block, const BlockState& state, double gravity, double duration);
/// The same by the rotation that the state's spin starts, which serves all times of one flight.
BlockState fly(
  const FreeRotation& rotation, const BlockState& state, double gravity, double duration);
/// Where the centroid is then, to the bit.
Vec3 placeInFlight(const BlockState& state, double gravity, double duration);
/// Way of a flight of this time (s) between two velocities, m: within 0.1 % of the parabola's
/// length.
double flightLength(double duration, const Vec3& from, const Vec3& to);
/// The state at the share s of a step of contact: cubic in place, linear in velocity.
BlockState between(const BlockState& from, const BlockState& to, double s);

} // namespace rockfall
