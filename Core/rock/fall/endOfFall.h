#pragma once

/// @file
/// Whether a fall is over: at rest, beyond the slope, out of time.

namespace rockfall
{

struct Fall;

void checkLeft(Fall& fall); ///< Beyond the slope?
/// Follows for how long the rock has been lying still. `h`: time since the last call, s.
void followRest(Fall& fall, double h, bool touching);
/// Rested, left, or out of time? `h` as above.
void checkEnd(Fall& fall, double h);

} // namespace rockfall
