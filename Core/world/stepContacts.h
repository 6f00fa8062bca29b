#pragma once

/// @file
/// Contacts of two rocks as the step of their island asks for them.

#include "solve/island/PairSprings.h"
#include "world/IslandWork.h"

namespace rockfall
{

PairStiffness pairStiffness(const SimulationParameters& parameters);

/// Springs and dashpot of a contact of two rocks; its dashpot is not asked for.
void setSprings(const WorldState& world, const RockPair& pair, Contact& contact);

/// A contact of two rocks.
IslandContact touchOfPair(const WorldState& world, RockPair& pair, const PairMotion& motion,
  Contact& contact, const IslandWork& work);

} // namespace rockfall
