#pragma once

/// @file
/// Contacts of two rocks as the step of their island asks for them.

#include "world/IslandWork.h"

namespace rockfall
{

/// A contact of two rocks.
IslandContact touchOfPair(const WorldState& world, RockPair& pair, const PairMotion& motion,
  Contact& contact, const IslandWork& work);

} // namespace rockfall
