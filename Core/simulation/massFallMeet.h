#pragma once

/// @file
/// Rocks that may meet within a step: pairs near each other, in compact arrays, as there are
/// several times more of them than touch.

#include "simulation/MassFall.h"
#include "simulation/RockQueue.h"
#include "system/broadPhase.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <limits>

namespace rockfall
{

/// Gap of two rocks along no axis yet.
constexpr double kNoAxis = -std::numeric_limits<double>::infinity();

/// A rock as the others meet it in the step at hand: what every look at a pair asks for, in one
/// line of the cache.
struct alignas(64) Mover
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
  /// Goes as far as any rock of its island may: it was in a crowd in the last step. There nearly
  /// every rock's displacement is the one of some faster rock, and to pass it on from rock to rock
  /// tells no more.
  bool shares = false;
  int crowd = -1; ///< Of the last step, −1: none.

  bool isOneCrowdWith(const Mover& o) const { return shares && o.shares && crowd == o.crowd; }
};

/// Velocities that a rock may have in the step.
struct Pace
{
  double own = 0.0;  ///< The longest displacement if nothing strikes it, m.
  double mass = 0.0; ///< kg
  /// All velocities that points of it may have until it meets another rock are in a ball, m/s:
  /// about its velocity if it flies clear of the slope; else the slope may stop it or throw it
  /// back.
  Vec3 middle = Vec3::Zero();
  double spread = 0.0;
  Vec3 velocity = Vec3::Zero();        ///< m/s
  Quat orientation = Quat::Identity(); ///< For which `turned` stands.
  Vec6 strain = Vec6::Zero();
  /// Centre of the ball in which neighbours have been looked for, less the drift of all rocks
  /// since, m.
  Vec3 covered = Vec3::Zero();
  double cover = 0.0; ///< Radius of the ball, m.
  bool slept = true;  ///< Then: others that did were no neighbours.
};

/// Rocks that may touch within the step, or one alone.
struct IslandBounds
{
  Vec3 lower, upper; ///< Velocities of its points, m/s.
  double heaviest;   ///< kg
  double longest;    ///< Displacement of one of them if nothing else strikes it, m.
  int size;

  /// A light rock that a heavy one strikes goes on faster than it, by this factor. `bounciest`:
  /// the largest restitution of rocks on each other.
  double thrown(double mass, double bounciest) const
  {
    return bounciest * heaviest > mass ? (1.0 + bounciest) * heaviest / (heaviest + mass) : 1.0;
  }
  /// Largest component along the normal of a velocity of one of its rocks, m/s.
  double most(const Vec3& normal, const Pace& pace) const
  {
    return size > 1 ? normal.cwiseProduct(lower).cwiseMax(normal.cwiseProduct(upper)).sum()
                    : pace.spread + normal.dot(pace.middle);
  }
  void add(const IslandBounds& other)
  {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
    heaviest = std::max(heaviest, other.heaviest);
    longest = std::max(longest, other.longest);
    size += other.size;
  }
};

/// Speed at which the gap of two rocks of these islands may close along a normal, m/s.
inline double closingSpeed(const IslandBounds& first, const Pace& firstPace,
  const IslandBounds& second, const Pace& secondPace, const Vec3& normal)
{
  return &first == &second
    ? normal.cwiseAbs().dot(first.upper - first.lower)
    : std::max(0.0, first.most(-normal, firstPace) + second.most(normal, secondPace));
}

/// Two rocks that are near each other, or may come near each other soon; in one line of the cache.
struct alignas(64) Near
{
  int first = -1;
  int second = -1;
  RockPair* pair = nullptr; ///< None as long as their bounding spheres tell them apart.
  /// At any later time the gap is no less than offset + normal · (x₁ − x₂) − turned₁ − turned₂.
  Vec3 normal = Vec3::Zero();
  double offset = kNoAxis;
  double looked = -1.0;   ///< Reach within which the axis was looked for in this step, m.
  bool linked = false;    ///< May touch in this step,
  bool wasLinked = false; ///< or could in the last one.
  bool holds = false;     ///< May have contacts.
  bool seen = false;      ///< The axis had been found where the step begins.
};

inline bool operator<(const Near& a, const Near& b)
{
  return a.first != b.first ? a.first < b.first : a.second < b.second;
}

/// The first one of those that are joined to one, by the one that each is joined to.
inline int headOf(std::vector<int>& joined, int i)
{
  int* const heads = joined.data();
  while (heads[i] != i)
  {
    i = heads[i] = heads[heads[i]];
  }
  return i;
}

/// State of two rocks near each other.
enum class Sight : std::uint8_t
{
  Open,     ///< May meet if they go as far as is known;
  Shut,     ///< may not, or both sleep;
  Apart,    ///< may not, and nothing lasts of them;
  Overlaps, ///< overlap;
  Linked,   ///< or may meet for sure.
};

struct MassFall::Meetings
{
  std::vector<Mover> movers;
  std::vector<Near> near; ///< Ordered by (first, second), but for those found later.

  void follow(MassFall& fall, double duration); ///< The rocks, to where they stand now.
  void findNear(MassFall& fall);
  void link(MassFall& fall);
  int head(int rock) const { return heads_[std::size_t(rock)]; } ///< The first of its island.
  bool isAlone(int rock) const { return !inIsland_[std::size_t(rock)]; }
  template <class Visit>
  void forLinked(Visit&& visit) const; ///< In the order of `near`.

private:
  /// A pair that is not linked and no farther apart than known displacements go.
  struct Open
  {
    double apart; ///< No nearer than that, m.
    int first, second;
    int near; ///< Index into `near`.
  };
  /// A rock that another is linked with, in a list.
  struct Link
  {
    double gap; ///< At least, m.
    int other;
    int next; ///< −1 ends.
  };

  /// Two that may touch in the step.
  struct Linked
  {
    int first, second;
    RockPair* pair;
  };
  /// Numbers of entries that a part of `near` has left, each from its own beginning on.
  struct Left
  {
    std::size_t open, others;
  };

  // Neighbours: massFallMeet.cxx
  void share(std::size_t rock);
  void search(MassFall& fall);
  void cover(int rock);
  double spare(int rock) const;
  bool isCovered(std::size_t rock) const;
  RockPair* newPair(const MassFall& fall, int first, int second);
  void drop(MassFall& fall, Near& near);
  void indexNeighbours();
  template <class Visit>
  void forNeighbours(int rock, Visit&& visit);

  // Pairs that may meet: massFallLink.cxx
  double gap(const Near& near) const; ///< At least, along the axis, m.
  double apart(const Near& near) const;
  double closing(const Near& near) const;
  double reach(const Near& near) const;
  bool isAsleep(int first, int second) const; ///< Both.
  void lookAlong(Near& near) const;
  bool mayMeet(const Open& open) const;
  bool meet(const MassFall& fall, std::size_t near);
  void look(MassFall& fall);
  Open openOf(std::size_t near) const;
  void widen();
  bool sweep(MassFall& fall);
  bool stays(const Near& near) const;

  // Islands: massFallIslands.cxx
  void settle(MassFall& fall);
  void unite();

  // Velocities and displacements passed on: massFallReach.cxx
  int root(int rock); ///< The first one of its island.
  double thrown(std::size_t rock) const;
  bool join(MassFall& fall, std::size_t near, bool known);
  void wakeAbout(MassFall& fall, int rock);
  void passOn(int rock);
  void tell(MassFall& fall);

  double duration_ = 0.0;
  double fall_ = 0.0;         ///< Displacement that gravity may add, m.
  double bounciest_ = 0.0;    ///< Largest restitution of rocks on each other.
  double widened_ = 0.0;      ///< Most that a rock's ball reaches beyond that of the search, m.
  Vec3 drift_ = Vec3::Zero(); ///< How far all have gone on together since, m.
  Vec3 mean_ = Vec3::Zero();  ///< Velocity of all together, m/s.
  bool searched_ = false;
  std::size_t out_ = 0; ///< Rocks that have come out of their balls since.
  BroadPhase broad_;
  std::vector<BroadBox> boxes_; ///< Of the last search.
  std::vector<Pace> paces_;
  std::vector<Near> nextNear_;
  std::deque<RockPair> pairs_;
  std::vector<RockPair*> spare_;
  std::vector<IslandBounds> bounds_; ///< By root.
  std::vector<int> parents_, roots_;
  std::vector<int> crowds_; ///< First rock of each crowd of the last step.
  std::vector<double>
    surely_; ///< Of each of them, its velocities may close such a gap anywhere, m.
  /// Of each rock, where it is in `near`: those of the search, and those found later.
  std::vector<std::size_t> firsts_, places_;
  std::vector<std::vector<std::size_t>> later_;
  std::vector<int> widenedRocks_;
  std::size_t sorted_ = 0;     ///< Of `near`; behind it those found later.
  std::vector<double> aparts_; ///< Of `near`.
  std::vector<Sight> states_;  ///< Of `near`.
  std::vector<Open> open_;
  std::vector<Open> sighted_; ///< The same as found by each part of `near`, from its beginning.
  std::vector<std::size_t> others_; ///< Of `near`, what else a look has to see to.
  std::vector<Left> left_;          ///< By part of `near`.
  std::vector<Linked> linked_;
  std::vector<std::size_t> linkedCounts_; ///< By part of `near`.
  std::vector<int> heads_;
  std::vector<char> inIsland_;
  std::vector<char> parted_;   ///< By rock: what touched it lately is linked with it no longer.
  std::vector<double> thrown_; ///< By rock: what strikes it may make it faster by this factor.
  std::vector<double> fars_;   ///< By rock, how far it may come towards others, m.
  std::vector<int> firstLink_; ///< By rock, in `links_`.
  std::vector<Link> links_;
  int sleepers_ = 0;
  std::vector<int> wider_; ///< Rocks whose displacements have outgrown what was known.
  double longest_ = 0.0;   ///< Displacement of all, m.
  RockQueue queue_;        ///< Of those that others have to be told of.
  std::vector<int> found_;
  std::vector<char> marks_;
  std::vector<char> answers_;
  std::vector<std::size_t> chosen_, asked_;
  std::vector<int> placed_;
};

/// Pairs of a part of `near`.
constexpr std::size_t kNearPart = 256;

template <class Visit>
void MassFall::Meetings::forLinked(Visit&& visit) const
{
  for (std::size_t part = 0; part < linkedCounts_.size(); ++part)
  {
    const Linked* const first = linked_.data() + part * kNearPart;
    for (const Linked *l = first, *end = first + linkedCounts_[part]; l != end; ++l)
    {
      visit(*l);
    }
  }
}

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
