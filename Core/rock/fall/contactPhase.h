#pragma once

/// @file
/// A rock in contact with the slope, from touch-down to take-off or rest: steps that resolve an
/// impact (small, conserving) and steps that last (up to Δt, damped), each for what it is right for.
/// The parts of a step in their order, for islands, which solve for several rocks at once.

#include "contact/ground/candidates.h"
#include "rock/parts/RockBody.h"

namespace rockfall
{

struct Fall;

void beginContact(Fall& fall); ///< Unless it has begun.
/// Steps until take-off, the horizon or the end.
void stayInContact(Fall& fall);

/// Contacts with the slope within `reach` (m). A step of `h` (s) may turn a rock that is held at a
/// corner onto a face; with 0 no contact is looked for there.
void findContacts(Fall& fall, const CandidatePairs& candidates, double reach, double h);
/// Contacts of what has slipped through between others, of those that `findContacts` had.
void guardPenetrations(Fall& fall, const CandidatePairs& candidates);
/// Gives new contacts their springs and dashpots, for a step of `h` (s).
void setNewSprings(Fall& fall, double h);
void setSprings(Fall& fall, Contact& contact);
/// Books a step that has been taken from `before` to `state`. `given`: work done on other rocks, J.
/// `recovers`: loose overlaps go slowly (OverlapRecovery.h).
void commitStep(Fall& fall, StepKind kind, const StepOutcome& outcome, double energyBefore,
  double given, bool recovers);

} // namespace rockfall
