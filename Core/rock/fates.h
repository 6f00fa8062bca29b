#pragma once

/// @file
/// The fate of a rock in nodata, beside those of results.h.

#include "rock/results.h"

namespace rockfall
{

/// Fell where the slope has no data, but ground on two sides (terrain/holes.h). Fate::LeftDomain is
/// that of rocks which went over the slope's edge.
inline constexpr Fate kLostInNodata = Fate(4);

} // namespace rockfall
