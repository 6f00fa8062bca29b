#pragma once

/// @file
/// Rocks that may meet within a step, and the islands that they are.

#include "world/NearPairs.h"
#include "world/RockQueue.h"

#include <algorithm>
#include <cstdint>

namespace rockfall
{

/// State of two rocks near each other.
enum class PairState : std::uint8_t
{
  Undecided, ///< The rocks may meet if they go as far as is known;
  Separate,  ///< may not, or both sleep;
  Apart,     ///< may not, and nothing lasts of them;
  Overlaps,  ///< overlap;
  Linked,    ///< or may meet for sure.
};

class IslandFinder
{
public:
  explicit IslandFinder(WorldState& world);

  /// Islands of rocks that may meet within a duration (s), and rocks that meet no other, in the
  /// order of their numbers. Wakes what may be met.
  void find(double duration);
  const std::vector<Island>& islands() const { return islands_; }
  const std::vector<int>& alone() const { return alone_; }

  /// Pairs that are near each other and whose axis was ever looked for, by (first, second).
  template <class Visit>
  void forPairs(Visit&& visit);

private:
  /// A pair that is not linked and no farther apart than known displacements go.
  struct UndecidedPair
  {
    double apart; ///< No nearer than that, m.
    int first, second;
    int near; ///< Index into `near_`.
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
  /// Numbers of entries that a part of `near_` has left, each from its own beginning on.
  struct Left
  {
    std::size_t open, others;
  };

  void follow(double duration); ///< The rocks, to where they stand now.

  // Pairs that may meet: islandFinderLink.cxx
  void link();
  double gap(const NearPair& near) const; ///< At least, along the axis, m.
  double apart(const NearPair& near) const;
  double closing(const NearPair& near) const;
  double reach(const NearPair& near) const;
  void lookAlong(NearPair& near) const;
  bool mayMeet(const UndecidedPair& open) const;
  bool meet(std::size_t near);
  void look();
  UndecidedPair undecidedOf(std::size_t near) const;
  void widen();
  bool sweep();
  void widenIslands();
  void choose();

  // Islands: IslandFinder.cxx
  void settle();
  void unite();
  void listIslands();
  template <class Visit>
  void forLinked(Visit&& visit) const; ///< In the order of `near_`.

  // Velocities and displacements passed on: islandFinderReach.cxx
  int root(int rock); ///< The first one of its island.
  double massRatioGain(std::size_t rock) const;
  void join(std::size_t near, bool known);
  void wakeAbout(int rock);
  void propagateFrom(int rock);
  void propagate();

  WorldState& world_;
  RockBounds rocks_;
  NearPairs near_;
  std::vector<Island> islands_;
  std::vector<int> alone_;
  std::vector<int> islandOf_;        ///< By the first rock of an island.
  double sag_ = 0.0;                 ///< Displacement that gravity may add, m.
  double bounciest_ = 0.0;           ///< Largest restitution of rocks on each other.
  std::vector<IslandBounds> bounds_; ///< By root.
  std::vector<int> parents_, roots_;
  std::vector<double> aparts_;    ///< Of `near_`.
  std::vector<PairState> states_; ///< Of `near_`.
  std::vector<UndecidedPair> undecided_;
  std::vector<UndecidedPair>
    undecidedByPart_; ///< The same as found by each part of `near_`, from its beginning.
  std::vector<std::size_t> others_; ///< Of `near_`, what else a look has to see to.
  std::vector<Left> left_;          ///< By part of `near_`.
  std::vector<Linked> linked_;
  std::vector<std::size_t> linkedCounts_; ///< By part of `near_`.
  std::vector<int> heads_;
  std::vector<char> inIsland_;
  std::vector<char> parted_; ///< By rock: what touched it lately is linked with it no longer.
  std::vector<double>
    massRatioGains_;           ///< By rock: what strikes it may make it faster by this factor.
  std::vector<double> fars_;   ///< By rock, how far it may come towards others, m.
  std::vector<int> firstLink_; ///< By rock, in `links_`.
  std::vector<Link> links_;
  int sleepers_ = 0;
  std::vector<int> wider_; ///< Rocks whose displacements have outgrown what was known.
  double longest_ = 0.0;   ///< Displacement of all, m.
  RockQueue queue_;        ///< Of those that others have to be told of.
  std::vector<char> marks_, answers_;
  std::vector<std::size_t> chosen_, asked_;
  std::vector<int> placed_;
};

/// Pairs of a part of `near_`.
constexpr std::size_t kNearPart = 256;

template <class Visit>
void IslandFinder::forLinked(Visit&& visit) const
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
void IslandFinder::forPairs(Visit&& visit)
{
  for (const NearPair& n : near_)
  {
    if (n.pair)
    {
      visit(*n.pair);
    }
  }
}

} // namespace rockfall
