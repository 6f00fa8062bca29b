#pragma once

/// @file
/// Rocks that hang in the air when they are released, as those of another slope do.

#include "rock/Rock.h"
#include "terrain/Terrain.h"

#include <span>
#include <string>
#include <vector>

namespace rockfall
{

/// Adds one sentence if rocks start by more than `plausible::kReleaseHeight` over the slope as
/// surveyed and over what lies under them of the other rocks, with how many and the first one.
/// Rocks in flight, faster than 5 m/s, are none of them.
void askAfterHeights(
  const Terrain& terrain, std::span<const Rock> rocks, std::vector<std::string>& notes);

} // namespace rockfall
