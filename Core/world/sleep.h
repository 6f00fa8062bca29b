#pragma once

/// @file
/// Rocks of a mass fall that come to rest, and wake again.

#include "world/WorldState.h"

namespace rockfall
{

/// Whether a rock has been still for long enough; follows the places that it has stayed at.
bool isStill(const WorldState& world, FallingRock& rock);

/// The rock's rest begins anew, as something has gone that it may have lain on or leant on.
void restAnew(FallingRock& rock);

void putToSleep(FallingRock& rock);
void wake(FallingRock& rock, double time); ///< s

/// Whether the two have touched within the time that rest takes.
bool touchedLately(const RockPair& pair, double time);

/// After a step that began at a time (s): puts an island to sleep whose rocks are all still. A rock
/// that has gone leaves those that it carried to fall.
void settleIsland(WorldState& world, const Island& island, double since);

} // namespace rockfall
