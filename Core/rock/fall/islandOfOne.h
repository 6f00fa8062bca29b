#pragma once

/// @file
/// A rock as an island solves for it (solve/island/SoftSolver.h), and a step of one by itself: an
/// overlap with the slope that is deep, or that others have pressed it into, goes as place.

#include "solve/island/island.h"
#include "solve/step/StepSolver.h"

namespace rockfall
{

struct Fall;

/// A contact of a rock, the island's body of that number, with the slope.
IslandContact touchOnSlope(const Fall& fall, int body, Contact& contact);

/// Whether the next step is one of an island: from a step that lasts, or out of an island of others,
/// until no overlap is deep.
bool isPressedIn(Fall& fall, StepKind kind);
/// A step of `h` (s) from contacts with springs; halved where it does not settle.
void stepAsIsland(Fall& fall, double h);

} // namespace rockfall
