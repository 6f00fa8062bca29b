#pragma once

/// @file
/// Rocks of no rock, and more of them than fall.

#include "rock/Rock.h"

#include <span>
#include <string>
#include <vector>

namespace rockfall
{

/// Adds one sentence for each kind of number out of its range (terrain/plausible.h). `frequencies`:
/// of each rock, 1/a; empty where they are not known.
void askAfterRocks(std::span<const Rock> rocks, std::span<const double> frequencies,
  std::vector<std::string>& notes);

} // namespace rockfall
