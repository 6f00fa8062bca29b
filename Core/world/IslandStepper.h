#pragma once

/// @file
/// Rocks of an island on their way through Δt, in steps that all of them take together.

#include "world/IslandWork.h"

namespace rockfall
{

class IslandStepper
{
public:
  IslandStepper(WorldState& world, const Island& island);

  /// To a time, s. `atBarrier`: no other is under way, as rocks may meet a barrier.
  void advance(double until, bool atBarrier);

private:
  double timeReached(double until) const; ///< s; `until` if all are gone.
  double beginContacts();                 ///< Returns the longest step that contacts serve, s.

  // Contacts where a step of `h` (s) begins, islandContacts.cxx
  void gatherContacts(double h);
  void gatherOnSlope(std::size_t member, double h);
  void gatherOfPair(std::size_t pair, double h);
  double reachOf(double speed, double radius, double h) const; ///< m

  // A step
  void fly(double duration); ///< Lets all contacts go.
  void solve(double h);
  void addRock(std::size_t member);
  void addPair(std::size_t touching);
  /// Halves the step as long as its solution is not accepted.
  void cutUntilAccepted(StepRequest& request);

  WorldState& world_;
  const Island& island_;
  IslandWork& work_; ///< Of this thread.
};

} // namespace rockfall
