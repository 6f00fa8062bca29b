#pragma once

/// @file
/// Impacts of a stiff rock by itself on hard ground as events in impulse space (solve/step/impulse.h).

namespace rockfall
{

struct Fall;

/// Flies by at most `duration` (s) over the window of heights, through an impact on the way's end if
/// it comes to one. False: what comes is none that an impulse resolves.
bool hop(Fall& fall, double duration);
/// A contact that closes within `small` (s) at more than the resting speed: flies to it, and
/// resolves the impact. Else `first` is when the first one does. Whether anything was done.
bool strikeSoon(Fall& fall, double small, double& first);

} // namespace rockfall
