#pragma once

/// @file
/// Springs and dashpots of contacts between rocks.

#include "solve/island/PairSprings.h"
#include "world/WorldState.h"

namespace rockfall
{

PairStiffness pairStiffness(const SimulationParameters& parameters);

/// Springs on the slope into which others press the rock.
void stiffenPressed(SingleRock& sim);

/// Of one contact; its dashpot is not asked for.
void setSprings(const WorldState& world, const RockPair& pair, Contact& contact);

} // namespace rockfall
