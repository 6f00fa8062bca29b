#pragma once

/// @file
/// An island over its step. An island is all that may meet within Δt; few of its rocks touch at a
/// time, and most only come near. The step is halved, and again, as long as rocks fall apart by it:
/// a rock that meets no other within such a part of the step goes on by itself meanwhile.

#include "fall/FallState.h"

namespace rockfall
{

/// A rock that meets no other, to a time (s).
void advanceAlone(FallingRock& rock, double until);

/// The same, of an island.
void advanceIsland(FallState& fall, const Island& island, double until);

} // namespace rockfall
