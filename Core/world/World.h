#pragma once

/// @file
/// What falls in one iteration: its rocks and the slope under them, on their way through time.
///
/// Rocks that hit no other are each on their own: flight in closed form, contact in steps
/// (SingleRock). Where they hit each other [paper 3.4] time goes on in steps of Δt:
///
///     find      rocks near each other, pairs that may meet within the step, islands (IslandFinder)
///     advance   a rock that meets no other: as if it were the only one;
///               an island: contacts, rows, a look where it ends, books (IslandStepper)
///     tell      structures that one has broken are gone for all
///     settle    islands that have come to rest sleep until something touches them
///
/// Without a meeting a stiff rock's motion is the one that it has without collisions. One that is
/// soft enough to ring in an impact does so only when it falls without collisions.

#include "world/WorldState.h"

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace rockfall
{

class IslandFinder;

class World
{
public:
  /// `number`: that of the first rock in the iteration; `sleeps`: whether islands at rest do.
  World(const Surface& surface, std::span<const Rock> rocks, std::span<const Block> blocks,
    const SimulationParameters& parameters, int number = 0, bool sleeps = true);
  ~World();

  /// All rocks to rest, to the edge of the slope or to the end time: a trajectory for each, in
  /// their order. Stops earlier if there are samples at `enough` (s): what is there by then is as
  /// in the whole run, bit for bit, but the summary is not complete. Where rocks hit each other,
  /// `goOn` is asked after every step with the time reached (s); false stops, too.
  std::vector<Trajectory> run(const std::function<bool(double)>& goOn = {},
    double enough = std::numeric_limits<double>::infinity());

  // The same in parts, where rocks hit each other.
  void release();
  bool advance(); ///< By Δt; false when nothing moves any more.
  double time() const { return world_.time; }
  int rocks() const { return int(world_.rocks.size()); }
  const BlockState& state(int rock) const { return this->rock(rock).state(); }
  /// The rock as it is so far.
  const SingleRock& rock(int rock) const { return world_.rocks[std::size_t(rock)].sim; }
  /// Pairs near each other whose axis was ever looked for, by (first, second).
  std::vector<const RockPair*> pairs() const;

private:
  void step(double until);
  void advanceAll(double until); ///< Islands, and rocks that meet no other, on all threads.
  /// Units go on by themselves: islands as in `order_`, and behind them rocks that meet no other.
  std::span<const int> unit(std::size_t k) const;
  void advanceOne(std::size_t k, double until);
  void findAtBarriers(double duration);
  void shareBroken();         ///< Trees and barriers.
  void settle(double before); ///< Islands of a step that began at this time, s.

  WorldState world_;
  bool sleeps_;
  std::unique_ptr<IslandFinder> islandFinder_; ///< None if rocks hit no other.
  std::vector<int> order_;  ///< Islands in the order in which they are gone over.
  std::vector<char> waits_; ///< Of each unit, whether it may meet a barrier in the step.
  std::vector<std::pair<double, std::size_t>> atBarriers_; ///< Units that may meet one, by when.
};

} // namespace rockfall
