#pragma once

/// @file
/// Pairs of rocks that are near each other, in compact arrays, as there are several times more of
/// them than touch.
///
/// Neighbours are looked for in balls about the rocks, wide enough for a few steps, and again when a
/// rock may come out of its own: for this one alone, or, if there are many such, for all.

#include "contact/pair/broadPhase.h"
#include "world/VelocityBounds.h"
#include "world/WorldState.h"

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

namespace rockfall
{

/// Gap of two rocks along no axis yet.
constexpr double kNoAxis = -std::numeric_limits<double>::infinity();

/// A rock as the others meet it in the step at hand: what every look at a pair asks for, in one
/// line of the cache.
struct alignas(64) BodyBounds
{
  Vec3 position; ///< m
  double radius; ///< m
  double rimTravel =
    0.0; ///< Longest displacement about the centroid since the release, by turns and strain, m.
  double displacement; ///< The longest displacement of a point of it in the step, m, if it is
                       ///< struck by others.
  double known; ///< Rocks nearer than such a displacement, less their own, are its neighbours.
  bool present = false; ///< Neither gone nor stopped by the end time.
  bool asleep = false;
};

/// Two rocks that are near each other, or may come near each other soon; in one line of the cache.
struct alignas(64) NearPair
{
  int first = -1;
  int second = -1;
  std::unique_ptr<RockPair> pair; ///< None as long as their bounding spheres tell them apart.
  /// At any later time the gap is no less than offset + normal · (x₁ − x₂) − turned₁ − turned₂.
  Vec3 normal = Vec3::Zero();
  double offset = kNoAxis;
  double looked = -1.0;   ///< Reach within which the axis was looked for in this step, m.
  bool linked = false;    ///< The rocks may touch in this step,
  bool wasLinked = false; ///< or could in the last one.
  bool holds = false;     ///< The pair may have contacts.
};

inline bool operator<(const NearPair& a, const NearPair& b)
{
  return a.first != b.first ? a.first < b.first : a.second < b.second;
}

/// The rocks in the step at hand, by number.
struct RockBounds
{
  std::vector<BodyBounds> bodies;
  std::vector<VelocityBounds> velocities;
  double duration = 0.0; ///< Of the step, s.

  bool areAsleep(int first, int second) const ///< Both.
  {
    return bodies[std::size_t(first)].asleep && bodies[std::size_t(second)].asleep;
  }
};

/// Ordered by (first, second), but for those found later.
class NearPairs
{
public:
  explicit NearPairs(WorldState& world);

  /// Finds who is near whom, now that the rocks stand elsewhere.
  void find(RockBounds& rocks);
  /// Whether all that a rock is near, wherever it may go in the step, are among its neighbours.
  bool isCovered(const RockBounds& rocks, std::size_t rock) const;
  /// Looks for those about a rock that comes out of its ball.
  void cover(RockBounds& rocks, int rock);
  /// visit(index of a pair) of all pairs of a rock.
  template <class Visit>
  void forNeighbours(int rock, Visit&& visit) const;
  /// What lasts of two is made for them,
  void keep(NearPair& near);
  /// and left.
  void drop(NearPair& near);

  std::size_t size() const { return near_.size(); }
  NearPair* data() { return near_.data(); }
  NearPair& operator[](std::size_t k) { return near_[k]; }
  const NearPair& operator[](std::size_t k) const { return near_[k]; }
  const NearPair* begin() const { return near_.data(); }
  const NearPair* end() const { return near_.data() + near_.size(); }

private:
  void followDrift(const RockBounds& rocks);
  void search(RockBounds& rocks); ///< For all, from where they stand.
  /// How much wider a rock's ball is than it need be in the step, m.
  double spare(const RockBounds& rocks, int rock) const;
  void indexNeighbours(std::size_t rocks);

  WorldState& world_;
  std::vector<NearPair> near_, nextNear_;
  std::size_t sorted_ = 0;    ///< Of `near_`; behind it those found later.
  double widened_ = 0.0;      ///< Most that a rock's ball reaches beyond that of the search, m.
  Vec3 drift_ = Vec3::Zero(); ///< How far all have gone on together since, m.
  Vec3 mean_ = Vec3::Zero();  ///< Velocity of all together, m/s.
  bool searched_ = false;
  std::size_t out_ = 0; ///< Rocks that have come out of their balls since.
  BroadPhase broad_;
  std::vector<BroadBox> boxes_; ///< Of the last search.
  /// Of each rock, where it is in `near_`: those of the search, and those found later.
  std::vector<std::size_t> firsts_, places_;
  std::vector<std::vector<std::size_t>> later_;
  std::vector<int> widenedRocks_;
  std::vector<int> found_;
  std::vector<char> marks_, answers_;
  std::vector<std::size_t> chosen_;
};

template <class Visit>
void NearPairs::forNeighbours(int rock, Visit&& visit) const
{
  for (std::size_t k = firsts_[std::size_t(rock)]; k < firsts_[std::size_t(rock) + 1]; ++k)
  {
    visit(places_[k]);
  }
  for (const std::size_t k : later_[std::size_t(rock)])
  {
    visit(k);
  }
}

} // namespace rockfall
