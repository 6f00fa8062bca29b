#pragma once

/// @file
/// Impacts of rocks on each other as events, and what their other contacts take.

#include "world/WorldState.h"

namespace rockfall
{

/// An impact of the two, unless one is under way; as they were before it, and where (m).
void beginPairImpact(
  RockPair& pair, const BlockState& first, const BlockState& second, const Vec3& point);

/// An impact that began within a step of `h`: others drove rocks together that were apart.
void findLateImpact(const WorldState& world, RockPair& pair, const IslandContact& touch, double h);

/// An event of both rocks, if it is one. `over`: else time ends in the middle of it, and what the
/// springs hold is not lost.
void finishPairImpact(WorldState& world, RockPair& pair, bool over = true);

void closePairBooks(WorldState& world, RockPair& pair); ///< Books its losses on the two rocks.

} // namespace rockfall
