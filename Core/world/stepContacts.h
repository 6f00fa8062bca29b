#pragma once

/// @file
/// Contacts of an island as its step asks for them: what closes them, and how they bounce.

#include "world/IslandWork.h"

namespace rockfall
{

/// Whether an open contact comes in as an impact within a step of `h`.
inline bool hits(const Contact& c, double approach, double resting, double h)
{
  return !c.closed() && approach > resting && c.gap() < approach * h;
}

/// A contact of a rock with the slope in a step of `h` (s).
IslandContact touchOnSlope(
  const WorldState& world, const FallingRock& rock, Contact& contact, double h);

/// A contact of two rocks; an impact begins with it if it closes fast.
IslandContact touchOfPair(const WorldState& world, RockPair& pair, const PairMotion& motion,
  Contact& contact, double h, const IslandWork& work);

/// In a crowd: no bounce for what meets several.
void settleBounces(IslandWork& work);

/// One that shows only where the step would end.
void appendTouch(IslandContact touch, bool crowd, IslandWork& work);

} // namespace rockfall
