#pragma once

/// @file
/// Rocks of an island on their way through Δt, in steps that all of them take together.

#include "fall/IslandWork.h"

namespace rockfall
{

/// Longest step that resolves all impacts within an island, s.
double impactStepOf(const FallState& fall, const Island& island);

/// Whether nothing in an island moves along a normal, and no spring holds an impact's energy.
bool isCalm(const FallState& fall, const Island& island);

class IslandStepper
{
public:
  IslandStepper(FallState& fall, const Island& island);

  /// To a time (s), or only as long as its steps last. Returns the time reached, s.
  double advance(double until, bool lastingOnly);

private:
  double timeReached(double until) const; ///< s; `until` if all are gone.
  double beginContacts();                 ///< Returns the longest step that contacts serve, s.
  bool touches() const;                   ///< Whether any contact is closed.

  // Contacts where a step of `h` (s) begins, islandContacts.cxx
  void gatherContacts(double h);
  void gatherOnSlope(std::size_t member, double h);
  void gatherOfPair(std::size_t pair, double h);
  double reachOf(double speed, double radius, double h) const; ///< m

  // How long a step may be, islandTimes.cxx
  bool mayLast(double h) const;
  double freeTime(double most) const; ///< For how long, at most `most`, nothing touches, s.
  /// The same for those of a calm island that nothing carries yet. A lasting step must end before:
  /// its contacts are those of where it begins, and what falls or spins within it would come past
  /// them.
  double freeOfFlying(double most) const;
  double freeOfSlope(RockSimulator& sim, double most) const;
  double freeOfEachOther(const RockPair& pair, double gravity) const;

  // A step
  void fly(double duration);
  void solve(double h, StepKind kind, bool bounces);
  void addRock(std::size_t member, double h, StepKind kind, bool bounces);
  void addPair(std::size_t touching, double h, StepKind kind, bool bounces);
  /// Deep overlaps of the two, before a lasting step.
  void pressOutDeep(RockPair& pair, double h) const;
  /// Halves the step as long as its solution is not accepted.
  void cutUntilAccepted(StepRequest& request, bool bounces);

  FallState& fall_;
  const Island& island_;
  IslandWork& work_; ///< Of this thread.
};

} // namespace rockfall
