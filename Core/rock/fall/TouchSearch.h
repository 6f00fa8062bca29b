#pragma once

/// @file
/// The search for the first touch of the ground in flight.
///
/// First from bound to bound: for as long as nothing can be touched the rock goes on at once. Where
/// a bound is shorter than what resolves a touch it goes on by that, until it is in the ground. Then
/// by regula falsi between the last time over the ground and the first one in it.

#include "block/FreeRotation.h"

namespace rockfall
{

struct Fall;

/// The search in one flight. Moves the rock's `placed` and nothing else.
class TouchSearch
{
public:
  /// A flight of `duration` (s) from the rock's state on.
  TouchSearch(Fall& fall, double duration);

  enum class Outcome
  {
    Free,  ///< No touch within the duration.
    Here,  ///< At the start it overlaps the ground, or may: there is nothing to come to.
    Ahead, ///< At `sure`.
  };
  Outcome find();
  /// Time without a touch, up to a hair before the first one, s; 0: that is at the start.
  double sure() const { return sure_; }

private:
  BlockState flown(double t) const;
  double heightAt(double t); ///< Over the ground, m.
  Outcome bracket();         ///< Brings `sure_` and `after_` to both sides of a touch.
  void refine();             ///< Brings them near each other.

  Fall& fall_;
  double duration_;
  FreeRotation rotation_;
  // Times from the start, s: nothing is touched until `sure_`, and at `after_` the rock is in the ground.
  double sure_ = 0.0, after_ = 0.0;
  double high_ = 0.0, low_ = 0.0; ///< Heights over the ground at these times, m.
};

} // namespace rockfall
