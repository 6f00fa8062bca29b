#pragma once

/// @file
/// The end of a rock's way.

#include <string>

namespace rockfall
{

enum class Fate
{
  Rested = 0,     ///< Lies still on the slope.
  LeftDomain = 1, ///< Went over the slope's edge: there is no ground beyond.
  Moving = 2,     ///< Still moving at the end time.
  Caught = 3,     ///< Stopped by a barrier.
  LostInHole = 4, ///< Fell where the slope has no data, between ground on both sides.
};
std::string fateName(Fate fate);

} // namespace rockfall
