#pragma once

/// @file
/// Contacts of an island as its step asks for them.

#include "world/IslandWork.h"

namespace rockfall
{

/// A contact of a rock with the slope.
IslandContact touchOnSlope(const WorldState& world, const FallingRock& rock, Contact& contact);

/// A contact of two rocks.
IslandContact touchOfPair(const WorldState& world, RockPair& pair, const PairMotion& motion,
  Contact& contact, const IslandWork& work);

} // namespace rockfall
