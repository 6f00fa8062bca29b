#pragma once

/// @file
/// Springs and dashpots of contacts between rocks.

#include "fall/FallState.h"
#include "system/PairSprings.h"

namespace rockfall
{

PairStiffness pairStiffness(const SimulationParameters& parameters);

/// Springs on the slope into which others press the rock.
void stiffenPressed(RockSimulator& sim);

/// Of one contact; its dashpot is not asked for.
void setSprings(const FallState& fall, const RockPair& pair, Contact& contact);

} // namespace rockfall
