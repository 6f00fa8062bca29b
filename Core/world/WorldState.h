#pragma once

/// @file
/// The rocks of one mass fall, and what they fall on: the data that its parts pass on.

#include "contact/PlacedBlock.h"
#include "contact/pairs.h"
#include "rock/fall/SingleRock.h"
#include "rock/rockContacts.h"
#include "solve/island/SoftSolver.h"

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace rockfall
{

/// A rock of a mass fall: what it does by itself (`sim`), and where the others meet it.
struct FallingRock
{
  FallingRock(const Surface& surface, const Rock& rock, const Block& block,
    const SimulationParameters& parameters, std::uint32_t number)
    : sim(surface, rock, block, parameters, number)
  {
  }
  Fall& fall() { return sim.fall(); }
  const Fall& fall() const { return sim.fall(); }
  RockBody& body() { return sim.body(); }
  const RockBody& body() const { return sim.body(); }
  /// `placed` and `hull` for where the rock is, unless they are.
  void updatePose();
  /// Takes `end` and `endHull` on as where it stands, and returns whether it does.
  bool adoptEnd();
  /// Moves on by itself, meeting no other, to a time (s).
  void advanceAlone(double until);

  /// A place from which the rock has not gone far since a time, s.
  struct Place
  {
    double time = 0.0;
    Vec3 position = Vec3::Zero();        ///< m
    Quat orientation = Quat::Identity(); ///< Body to world.

    Place() = default;
    Place(const BlockState& s)
      : time(s.time)
      , position(s.position)
      , orientation(s.orientation)
    {
    }
  };

  // Members that the step of an island needs lie together, before and behind where `sim` begins.
  Place restAnchor;
  Place slowRestAnchor;  ///< The same, further and for longer,
  double furthest = 0.0; ///< how far the rock has been from that, m,
  double halfway = 0.0;  ///< and how far within the first half of the time, m.
  PlacedBlock end;       ///< Of the step at hand, as long as it is being solved.
  PairBody hull;
  PairBody endHull;
  int place = -1;        ///< Among the bodies of its island in the step at hand.
  bool touching = false; ///< Touched others where its island's last step ended.
  bool asleep = false;
  SingleRock sim;
};

/// All of them in one piece of memory: a step goes over them again and again, in their order.
class FallingRocks
{
public:
  void reserve(std::size_t count) { all_.reserve(count); }
  template <class... Of>
  FallingRock& add(Of&&... of)
  {
    FallingRock& added = all_.emplace_back(std::forward<Of>(of)...);
    first_ = all_.data();
    return added;
  }
  FallingRock& operator[](std::size_t i) { return first_[i]; }
  const FallingRock& operator[](std::size_t i) const { return first_[i]; }
  std::size_t size() const { return all_.size(); }
  FallingRock* begin() { return first_; }
  FallingRock* end() { return first_ + all_.size(); }
  const FallingRock* begin() const { return first_; }
  const FallingRock* end() const { return first_ + all_.size(); }

private:
  std::vector<FallingRock> all_;
  FallingRock* first_ = nullptr;
};

struct WorldState
{
  WorldState(const Surface& s, std::span<const Rock> all, const SimulationParameters& p)
    : surface(s)
    , parameters(p)
    , contacts(all, p)
  {
  }

  const Surface& surface;
  const SimulationParameters& parameters;
  RockContacts contacts; ///< Laws of the rocks on each other.
  FallingRocks rocks;
  std::vector<BarrierLoad> barrierLoads; ///< What each barrier has held so far.
  /// Trees that have held what others drove into them, and how much so far, J.
  std::map<int, double> driven;
  double time = 0.0; ///< s

  /// When each of these rocks meets a barrier that does not only record, if it goes on as it moves, at
  /// most `duration`; ∞ if it cannot within that time, however they strike each other. s.
  std::vector<double> timesToBarriers(std::span<const int> members, double duration) const;
  double drivenInto(int tree) const;                  ///< Of `driven`, J.
  double fastest(std::span<const int> members) const; ///< Speed of any of their points, m/s.
  /// Barriers that a rock has loaded or broken are so for all others, at once.
  void shareBarriers(FallingRock& rock);
};

/// Rocks that may touch each other within a step, in the order of their numbers.
struct Island
{
  std::vector<int> members;
  std::vector<RockPair*> pairs;
};

} // namespace rockfall
