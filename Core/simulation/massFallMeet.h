#pragma once

/// @file
/// What decides which rocks may meet within a step, kept in compact arrays: there are several times
/// more rocks near each other than touch.

#include "simulation/MassFall.h"
#include "system/broadPhase.h"

#include <array>
#include <cstdint>
#include <deque>
#include <limits>

namespace rockfall
{

/// Gap of two rocks along no axis yet.
constexpr double kNoAxis = -std::numeric_limits<double>::infinity();

/// A rock as the others meet it in the step at hand.
struct alignas(64) Mover
{
  // What every look at a pair asks for lies in one line of the cache.
  Vec3 position; ///< m
  double radius; ///< m
  double turned =
    0.0;      ///< Longest way about the centroid since the release, by turns and strain, m.
  double way; ///< The longest way of a point of it in the step, m, if it is struck by others.
  double thrown = 1.0;  ///< What it is struck by may make it go on faster by this factor.
  bool present = false; ///< Neither gone nor stopped by the end time.
  bool asleep = false;
  bool queued = false; ///< Those about it have to be told.

  double own;   ///< The longest way if nothing strikes it, m.
  double known; ///< Rocks nearer than such a way, less their own, are its neighbours.
  double mass;  ///< kg
  /// All velocities that points of it may have until it meets another rock are in a ball, m/s:
  /// about its velocity if it flies clear of the slope; else the slope may stop it or throw it
  /// back.
  Vec3 middle;
  double spread;
  Quat orientation = Quat::Identity(); ///< For which `turned` stands.
  Vec6 strain = Vec6::Zero();
};

/// Rocks that may touch within the step, or one alone.
struct Company
{
  Vec3 lower, upper; ///< Velocities of its points, m/s.
  double heaviest;   ///< kg
  int size;
};

/// Two rocks that are near each other.
struct Near
{
  int first = -1;
  int second = -1;
  RockPair* pair = nullptr; ///< None as long as their bounding spheres tell them apart.
  /// At any later time the gap is no less than offset + normal · (x₁ − x₂) − turned₁ − turned₂.
  Vec3 normal = Vec3::Zero();
  double offset = 0.0;
  double looked = -1.0;   ///< Reach within which the axis was looked for in this step, m.
  bool linked = false;    ///< May touch in this step,
  bool known = false;     ///< and the axis has been found for where they stand;
  bool wasLinked = false; ///< or could in the last one.
  bool holds = false;     ///< May have contacts.
};

inline bool operator<(const Near& a, const Near& b)
{
  return a.first != b.first ? a.first < b.first : a.second < b.second;
}

struct MassFall::Meetings
{
  std::vector<Mover> movers;
  std::vector<Near> near; ///< Ordered by (first, second).

  void follow(MassFall& fall, double duration); ///< The rocks, to where they stand now.
  void findNear(MassFall& fall);
  void link(MassFall& fall);
  int root(int rock); ///< The first one of its company.
  bool isAlone(std::size_t root) const { return companies_[root].size == 1; }

private:
  double gap(const Near& near) const; ///< At least, m.
  double closing(const Near& near) const;
  double thrown(std::size_t rock) const;
  double reach(const Near& near) const;
  double ways(const Near& near) const;
  bool isWithin(const Near& near, double reach) const;
  bool mayMeet(const Near& near) const;
  bool isAsleep(const Near& near) const; ///< Both.
  void lookAlong(Near& near) const;
  RockPair* newPair(const MassFall& fall, int first, int second);
  void drop(MassFall& fall, Near& near);
  void indexNeighbours();
  void addNeighbours(int rock);
  bool meet(const MassFall& fall, Near& near);
  bool sweep(MassFall& fall);
  void join(MassFall& fall, std::size_t near, bool known);
  void wakeAbout(MassFall& fall, int rock);
  void passOn(int rock);
  void tell(MassFall& fall);
  template <class Visit>
  void forNeighbours(int rock, Visit&& visit);

  double duration_ = 0.0;
  double fall_ = 0.0;      ///< What gravity may add to a way, m.
  double bounciest_ = 0.0; ///< Largest restitution of rocks on each other.
  double widened_ = 0.0;   ///< Most that `known` has grown by since the broad phase, m.
  BroadPhase broad_;
  std::vector<BroadBox> boxes_;
  std::vector<Near> nextNear_;
  std::deque<RockPair> pairs_;
  std::vector<RockPair*> spare_;
  std::vector<Company> companies_; ///< By root.
  std::vector<int> parents_, roots_;
  /// Of each rock, where it is in `near`: those of the broad phase, and those found later.
  std::vector<std::size_t> firsts_, places_;
  std::vector<std::vector<std::size_t>> later_;
  std::vector<int> widenedRocks_;
  /// Linked pairs of each rock, as lists: the first one, and by pair the next of either rock; −1
  /// ends.
  std::vector<int> firstLink_;
  std::vector<std::array<int, 2>> nextLink_;
  int sleepers_ = 0;
  std::size_t sorted_ = 0; ///< Of `near`; behind it those found later.
  std::vector<int> queue_;
  std::vector<std::uint64_t> turns_;
  std::vector<int> found_;
  std::vector<char> marks_;
  std::vector<char> asks_;
  std::vector<std::size_t> asked_;
  std::vector<int> placed_;
};

template <class Visit>
void MassFall::Meetings::forNeighbours(int rock, Visit&& visit)
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
