#pragma once

/// @file
/// What a rock does at structures (StructuresOnWay): trees that it breaks or passes, barriers that
/// stop it or break.

#include "rock/parts/StructuresOnWay.h"

#include <span>

namespace rockfall
{

struct Fall;

/// For how long, at most this (s), no structure is touched in flight, s.
double freeOfObstacles(Fall& fall, double duration);

// Trees

/// Trees that the rock is about to touch within `h`, presses against or has `hit`, and that cannot
/// hold it; whether there were any.
bool breakTrees(Fall& fall, double h, std::span<const int> hit = {});
/// Takes a step of `h` back in which it came against trees that cannot hold it, and breaks them.
bool undoAtTrees(Fall& fall, double h);
/// Contacts with those that are gone, and all that hangs on them; `touched`: one of them carried.
void forgetTrees(Fall& fall, bool touched = true);
/// Structures that others of its fall have broken are gone for this rock, too. Whether it touched
/// any.
bool applyBroken(Fall& fall, const StructuresOnWay::Broken& broken);

// Barriers

/// The rock goes on along a way on which barriers have taken so much so far (J); whether it hits one.
bool passBarriers(Fall& fall, const Way& way, double taken);
bool holdsAtBarrier(const Fall& fall); ///< The one that it hits can hold it.
void meetBarrier(Fall& fall);          ///< The one that it hits, where the rock is.
/// Barriers on the way of a step of contact that the rock has gone, or in soil. Whether the step goes on
/// to its end: behind a barrier that breaks there may be others.
bool passBarriersInStep(Fall& fall, bool touching);

} // namespace rockfall
