#pragma once

/// @file
/// A rock in flight: no steps, but a parabola and free rotation as far as bounds of the time to the
/// first touch allow.

namespace rockfall
{

struct Fall;

/// Flies until a touch is possible within a few steps, or to the end.
void flyUntilNear(Fall& fall);
/// Flies for so long (s), through soil and to the first barrier that stops the rock or breaks.
void advanceInFlight(Fall& fall, double duration);
/// Without contacts, through barriers that break, to the end of the time (s).
void flyFree(Fall& fall, double duration);

} // namespace rockfall
