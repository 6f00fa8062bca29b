#pragma once

/// @file
/// Rocks of one iteration that fall together and hit each other [paper 3.4].
///
/// Time goes on in steps of Δt. In each, rocks that can touch within the step are islands; every
/// island is a system of its own (system/IslandSolver.h), and whatever is alone goes on as if it
/// were the only rock (RockSimulator): flight costs nothing, and without a meeting a stiff rock's
/// displacement is the one that it has without collisions. One that is soft enough to ring in an
/// impact does so only when it falls without collisions.
///
/// In an island an impact is an event of a substep: what closes leaves with e times its speed of
/// approach (Newton's law of restitution). Islands that have come to rest sleep until something
/// touches them.

#include "fall/FallState.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace rockfall
{

class Meetings;

class MassFall
{
public:
  MassFall(const Surface& surface, std::span<const Rock> rocks, std::span<const Block> blocks,
    const SimulationParameters& parameters);
  ~MassFall();

  /// All rocks to rest, to the edge of the slope or to the end time: a trajectory for each, in
  /// their order. `goOn` is asked after every step with the time reached (s); false stops, and the
  /// trajectories are then a part.
  std::vector<Trajectory> run(const std::function<bool(double)>& goOn = {});

  // The same in parts.
  void release();
  bool advance(); ///< By Δt; false when nothing moves any more.
  double time() const { return fall_.time; }
  int rocks() const { return int(fall_.rocks.size()); }
  const BlockState& state(int rock) const { return this->rock(rock).state(); }
  // Of a rock, so far.
  const std::vector<ImpactEvent>& impacts(int rock) const
  {
    return this->rock(rock).trajectory().impacts;
  }
  const TrajectorySummary& summary(int rock) const { return this->rock(rock).trajectory().summary; }
  /// Pairs near each other whose axis was ever looked for, by (first, second).
  std::vector<const RockPair*> pairs() const;
  std::span<const Contact> slopeContacts(int rock) const
  {
    return this->rock(rock).body().contacts;
  }

  /// Rocks never sleep: for tests of how still a pile stands.
  bool awake = false;

private:
  const RockSimulator& rock(int rock) const { return fall_.rocks[std::size_t(rock)].sim; }
  bool advanceAll();
  void tellBroken(); ///< Structures that a rock has broken are gone for all.

  FallState fall_;
  std::unique_ptr<Meetings> meetings_;
  std::vector<int> order_; ///< Islands in the order in which they are gone over.
};

} // namespace rockfall
