#pragma once

/// @file
/// One rock on one realisation of the slope, from release to rest: flight in closed form, contact
/// in steps, restitution as events.

#include "rock/Rock.h"
#include "rock/fall/Fall.h"

#include <limits>

namespace rockfall
{

/// The fall of a rock alone (`run`), and the same in parts, for rocks that may meet others (World):
/// those bring each other through a step together, and go on with the parts of each fall.
class SingleRock
{
public:
  SingleRock(const Surface& surface, const Rock& rock, const Block& block,
    const SimulationParameters& p,
    std::uint32_t number = 0); ///< `number` of the rock in its iteration.

  /// Runs to rest, to the edge of the slope or to the end time. Stops earlier if there is a sample
  /// at `enough` (s) or later: what it has by then is as in the whole run, bit for bit, but the
  /// summary is not complete.
  Trajectory run(double enough = std::numeric_limits<double>::infinity());

  // The same in parts.

  /// Straight up, at the start, as far as roughness and embankments make it needed.
  void liftOntoGround();
  void begin(); ///< From where it stands.
  /// Likewise a piece of a rock whose centre was at `whole`: it meets the barriers between. One that
  /// holds it has it at its line.
  void beginAsPiece(const Vec3& whole);
  /// Up to this time (s) or to the end; `enough` as in `run`.
  void advance(double until, double enough = std::numeric_limits<double>::infinity());
  void wake(double time); ///< The rock goes on after an end, from this time on, s.
  Trajectory finish();

  Fall& fall() { return fall_; }
  const Fall& fall() const { return fall_; }
  RockBody& body() { return fall_.body; }
  const RockBody& body() const { return fall_.body; }
  const BlockState& state() const { return fall_.body.state; }
  bool done() const { return fall_.body.done; }
  Trajectory& trajectory() { return fall_.recorder.trajectory(); } ///< So far.
  const Trajectory& trajectory() const { return fall_.recorder.trajectory(); }

private:
  /// Whether there is a sample at `enough` (s) or later.
  bool hasSampleAt(double enough) const;

  const Rock& rock_;
  Fall fall_;
};

} // namespace rockfall
