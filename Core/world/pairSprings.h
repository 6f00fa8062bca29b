#pragma once

/// @file
/// Springs and dashpots of contacts between rocks.

#include "solve/island/PairSprings.h"
#include "world/WorldState.h"

namespace rockfall
{

PairStiffness pairStiffness(const SimulationParameters& parameters);

/// Stiffens springs on the slope into which others press the rock. A spring of a light rock is made
/// for what the rock itself brings. Under a boulder it would take the boulder's energy, at an
/// overlap as large as the stone, and give it to the stone: hundreds of m/s. In nature the stone is
/// crushed.
void stiffenPressed(SingleRock& sim);

/// Of one contact; its dashpot is not asked for.
void setSprings(const WorldState& world, const RockPair& pair, Contact& contact);

} // namespace rockfall
