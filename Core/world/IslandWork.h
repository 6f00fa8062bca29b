#pragma once

/// @file
/// Working memory of a step of an island (IslandStepper).

#include "base/parallel.h"
#include "solve/island/SoftSolver.h"
#include "world/WorldState.h"

#include <algorithm>
#include <array>
#include <deque>

namespace rockfall
{

/// Rocks and pairs that one thread looks after at a time.
constexpr std::size_t kRockGrain = 16, kPairGrain = 32;

/// Working memory of a step of an island, kept by thread.
struct IslandWork
{
  SoftSolver solver;
  std::vector<IslandBody> bodies;
  std::vector<IslandContact> contacts;
  std::vector<double> energyBefore;
  /// First contact of each rock's with the slope among `contacts`, and of each pair.
  std::vector<std::size_t> slopeFirsts, firsts;
  /// Contacts that are found in a second look, behind the others in `contacts`, and whose they are.
  std::deque<Contact> added;
  struct Added
  {
    bool onSlope;
    std::size_t of; ///< Number in the island, of a pair or of a rock.
    Contact before; ///< The contact as it was before the step.
  };
  std::vector<Added> addedTo;
  /// Of a part of the rocks or pairs that are laid out: how many there are in it, then before it.
  struct Part
  {
    int places = 0;
    std::size_t contacts = 0, touching = 0;
  };
  std::vector<Part> parts;
  std::vector<std::size_t> meeting; ///< Pairs of each part that touch, from its beginning.
  std::vector<char> flags; ///< For forThose; in the end by pair, whether an impact is under way.
  std::vector<std::size_t> missed;         ///< Pairs or rocks whose contacts were missed.
  std::vector<std::vector<Contact>> found; ///< Of each of them, where it touches.
  /// A tree that others drive a rock into within the step, and that may not hold.
  struct Stem
  {
    std::size_t member; ///< Number in the island.
    int tree;
    enum class Stands : std::uint8_t
    {
      Asked, ///< Let go; the next look tells.
      Yes,
      No,
    } stands;
    Vec3 push = Vec3::Zero(); ///< On the rock while it stands, N s,
    Vec3 at = Vec3::Zero();   ///< and where that acts, m.
    double away = 0.0;        ///< Speed at which the rock leaves it then, m/s.
    double taken = 0.0;       ///< Of what drives the rock into it in the step, J.
    double driven = 0.0;      ///< The same with what it took of all before, J.
  };
  std::vector<Stem> stems;
  int looks = 0; ///< Number that the step has had.
  /// Of an island at a barrier, which is the only one under way: numbers of its rocks in it, in the
  /// order in which they may come to it. Else empty.
  std::vector<std::size_t> turns;
  /// Calls this with the number of each rock in the island, on all threads, or in turn.
  template <typename Use>
  void forMembers(WorldState& world, const Island& island, Use&& use);
  /// By pair, the places of the two; −1: gone.
  std::vector<std::array<int, 2>> places;
  std::vector<int> placeOf; ///< By rock, of those in the island.
  /// Pairs that have contacts, or an impact under way. Most are only near each other.
  std::vector<std::size_t> touching;
  std::vector<char> touchesOthers; ///< By place, in the end.
  std::vector<char> alone;         ///< By place, whether it takes the step by itself.
  std::vector<char> arrived; ///< By place, whether the step has been looked at where it ended.
  /// A rock as loops over pairs see it, in two lines of the cache.
  struct alignas(64) Side
  {
    Vec3 velocity;  ///< m/s
    Vec3 spin;      ///< World axes, rad/s.
    Vec3 position;  ///< m
    double radius;  ///< m
    double rim;     ///< Speed at most by turning, m/s.
    double mass;    ///< kg
    double resting; ///< Below it a touch is no impact, m/s.
    double pushed;  ///< Speed that others may add within a step, m/s.
    bool done;

    void set(const RockBody& body);
  };
  std::vector<Side> sides; ///< By rock, where its island's step begins.
  PairMotion motionOf(const RockPair& pair) const
  {
    const Side &a = sides[std::size_t(pair.first)], &b = sides[std::size_t(pair.second)];
    return { a.velocity - b.velocity, { a.spin, b.spin }, { a.position, b.position } };
  }
  double smallerRadius(const RockPair& pair) const ///< m
  {
    return std::min(sides[std::size_t(pair.first)].radius, sides[std::size_t(pair.second)].radius);
  }
  /// Counts of the step at hand for the summary of each rock.
  std::int64_t iterations = 0, cuts = 0, unsettled = 0, tries = 0;
  void count(SingleRock& sim) const;
  /// Motion of a rock in the step; by place.
  struct Motion
  {
    Vec3 displacement; ///< Of the centroid, m.
    double rimTravel;  ///< Longest displacement about it, m.
    bool moved;        ///< Since the last look.
    bool low;          ///< The rock may be at the slope in the end.
  };
  std::vector<Motion> motions;
};

inline void IslandWork::Side::set(const RockBody& body)
{
  const BlockState& state = body.state;
  velocity = state.velocity;
  spin = state.angularVelocity();
  position = state.position;
  radius = body.block.radius();
  rim = state.spin.norm() * radius;
  mass = body.block.mass();
  resting = body.restingSpeed;
  pushed = 0.0;
  done = body.done;
}

template <typename Use>
void IslandWork::forMembers(WorldState& world, const Island& island, Use&& use)
{
  if (turns.empty())
  {
    forEach(island.members.size(), kRockGrain, use);
  }
  for (const std::size_t m : turns)
  {
    use(m);
    world.shareBarriers(world.rocks[std::size_t(island.members[m])]);
  }
}

inline void IslandWork::count(SingleRock& sim) const
{
  if (!sim.body().done)
  {
    TrajectorySummary& summary = sim.trajectory().summary;
    summary.openCloseIterations += iterations;
    summary.contactSteps += tries;
    summary.cutSteps += cuts;
    summary.unsettledSteps += unsettled;
  }
}

} // namespace rockfall
