#pragma once

/// @file
/// Rocks of a mass fall that are lifted out of the ground at their release, and those that they
/// would come into.

#include "block/Block.h"

#include <span>

namespace rockfall
{

/// A rock that is to be lifted straight up.
struct RaisedRock
{
  const Block* block = nullptr;
  BlockState state;  ///< Before the lift, unstrained.
  double lift = 0.0; ///< m, ≥ 0.
};

/// Lifts others where a rock's lift would put it into them, straight up and no farther than it
/// takes. Rocks of which faces lie on each other (within 1e-6 of the smaller radius) are lifted as
/// one, by the largest lift among them: the joints of a cut mass stay closed. So no two that were
/// apart overlap, and no lift exceeds the largest one given. Without lifts nothing is looked at.
void raiseOthers(std::span<RaisedRock> rocks);

} // namespace rockfall
