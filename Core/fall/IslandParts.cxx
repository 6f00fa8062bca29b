#include "fall/IslandParts.h"

#include "contact/motion.h"
#include "fall/IslandStepper.h"
#include "fall/Meetings.h"
#include "fall/sleep.h"
#include "law/settings.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace rockfall
{

namespace
{

/// State of an island whose step is gone over in parts.
class IslandParts
{
public:
  void advance(FallState& fall, const Island& island, double from, double until);

private:
  /// Two rocks as they stood when their axis was found. At any other time their gap is no less than
  /// offset + normal · (x₁ − x₂), less what they have turned and strained since.
  struct Sight
  {
    Vec3 normal = Vec3::Zero();
    double offset = kNoAxis; ///< m
    std::array<Quat, 2> orientations;
    std::array<Vec6, 2> strains;
  };
  struct Part
  {
    Island island;
    std::vector<std::size_t> sights; ///< Of its pairs, in `sights_`.
  };

  void advance(const Part& part, double from, double until);
  /// Parts of rocks that may meet each other within a duration (s), and rocks that meet no other.
  std::vector<Part> fallApart(const Part& whole, double duration);
  void start(const Island& island, double duration); ///< Each rock by itself.
  void join(const RockPair& pair);
  bool mayMeet(RockPair& pair, std::size_t sight, double duration);
  /// The widest gap along a normal over which two may meet, m.
  double reachOf(const RockPair& pair, const Vec3& normal, double duration);
  std::vector<Part> listParts(const Part& whole);
  /// Whether it touches all through: no part of it moves by itself.
  bool isOne(const Island& island);
  double gapAlong(const RockPair& pair, std::size_t sight) const; ///< At least, m.
  /// Finds the axis of two rocks where they stand.
  void findAxisOf(RockPair& pair, double reach, std::size_t sight);
  const IslandBounds& boundsOf(int rock) { return bounds_[std::size_t(headOf(heads_, rock))]; }

  FallState* fall_ = nullptr;
  double bounciest_ = 0.0;    ///< Largest restitution of rocks on each other.
  std::vector<Sight> sights_; ///< By pair of the whole island.
  // By rock, of those of the part at hand:
  std::vector<Pace> paces_;
  std::vector<int> heads_;
  std::vector<IslandBounds> bounds_; ///< By head.
  std::vector<int> places_;          ///< Of a head, among the parts.
  std::vector<char> linked_;         ///< By pair of the part.
};

void IslandParts::advance(FallState& fall, const Island& island, double from, double until)
{
  fall_ = &fall;
  bounciest_ = fall.contacts.largestRestitution();
  const std::size_t rocks = fall.rocks.size();
  paces_.resize(rocks);
  heads_.resize(rocks);
  bounds_.resize(rocks);
  places_.resize(rocks);
  sights_.assign(island.pairs.size(), {});
  Part whole;
  whole.island = island;
  whole.sights.resize(island.pairs.size());
  std::iota(whole.sights.begin(), whole.sights.end(), std::size_t(0));
  this->advance(whole, from, until);
}

double IslandParts::gapAlong(const RockPair& pair, std::size_t sight) const
{
  const Sight& seen = sights_[sight];
  double gap = seen.offset;
  if (gap > kNoAxis)
  {
    double sign = 1.0;
    for (const int side : { 0, 1 })
    {
      const RockSimulator& sim =
        fall_->rocks[std::size_t(side == 0 ? pair.first : pair.second)].sim;
      const BlockState& s = sim.body().state;
      const double r = sim.body().block.radius();
      gap += sign * seen.normal.dot(s.position) -
        rimTravel(seen.orientations[std::size_t(side)], s.orientation, r) -
        r * (s.strain - seen.strains[std::size_t(side)]).norm();
      sign = -1.0;
    }
  }
  return gap;
}

void IslandParts::findAxisOf(RockPair& pair, double reach, std::size_t sight)
{
  FallingRock &a = fall_->rocks[std::size_t(pair.first)],
              &b = fall_->rocks[std::size_t(pair.second)];
  a.stand();
  b.stand();
  if (!pair.known && !pair.seen)
  {
    pair.before = pair.axis;
  }
  pair.axis = findAxis(a.hull, b.hull, pair.axis, reach);
  pair.known = true;
  pair.seen = false;
  Sight& seen = sights_[sight];
  const BlockState &s = a.body().state, &t = b.body().state;
  seen.normal = pair.axis.normal;
  seen.offset = pair.axis.distance - seen.normal.dot(s.position - t.position);
  seen.orientations = { s.orientation, t.orientation };
  seen.strains = { s.strain, t.strain };
}

void IslandParts::start(const Island& island, double duration)
{
  for (const int i : island.members)
  {
    const std::size_t k = std::size_t(i);
    const RockSimulator& sim = fall_->rocks[k].sim;
    Pace& pace = paces_[k];
    pace.mass = sim.body().block.mass();
    foresee(*fall_, sim, duration, pace);
    bounds_[k] = { pace.middle.array() - pace.spread, pace.middle.array() + pace.spread, pace.mass,
      pace.own, 1 };
    heads_[k] = i;
  }
}

void IslandParts::join(const RockPair& pair)
{
  const int a = headOf(heads_, pair.first), b = headOf(heads_, pair.second);
  if (a != b)
  {
    bounds_[std::size_t(std::min(a, b))].add(bounds_[std::size_t(std::max(a, b))]);
    heads_[std::size_t(std::max(a, b))] = std::min(a, b);
  }
}

double IslandParts::reachOf(const RockPair& pair, const Vec3& normal, double duration)
{
  const Pace& first = paces_[std::size_t(pair.first)];
  const Pace& second = paces_[std::size_t(pair.second)];
  const IslandBounds &a = this->boundsOf(pair.first), &b = this->boundsOf(pair.second);
  const double faster =
    std::max(a.thrown(first.mass, bounciest_), b.thrown(second.mass, bounciest_));
  return faster * closingSpeed(a, first, b, second, normal) * duration +
    fall_->parameters.gravity * duration * duration;
}

bool IslandParts::mayMeet(RockPair& pair, std::size_t sight, double duration)
{
  if (fall_->rocks[std::size_t(pair.first)].sim.done() ||
    fall_->rocks[std::size_t(pair.second)].sim.done())
  {
    return false;
  }
  const double apart = this->gapAlong(pair, sight);
  if (apart > 0.0 && apart > this->reachOf(pair, sights_[sight].normal, duration))
  {
    return false;
  }
  // Along the axis that they have now there may be more room.
  for (double reach = 0.0, wider = this->reachOf(pair, pair.axis.normal, duration); wider > reach;
       wider = this->reachOf(pair, pair.axis.normal, duration))
  {
    reach = wider;
    this->findAxisOf(pair, reach, sight);
  }
  return pair.axis.distance <= this->reachOf(pair, pair.axis.normal, duration);
}

std::vector<IslandParts::Part> IslandParts::fallApart(const Part& whole, double duration)
{
  const Island& island = whole.island;
  this->start(island, duration);
  linked_.assign(island.pairs.size(), 0);
  for (std::size_t p = 0; p < island.pairs.size(); ++p)
  {
    const RockPair& pair = *island.pairs[p];
    if (pair.touched || pair.strikes)
    {
      linked_[p] = 1;
      this->join(pair);
    }
  }
  for (bool any = true; any;)
  {
    any = false;
    for (std::size_t p = 0; p < island.pairs.size(); ++p)
    {
      if (!linked_[p] && this->mayMeet(*island.pairs[p], whole.sights[p], duration))
      {
        linked_[p] = 1;
        this->join(*island.pairs[p]);
        any = true;
      }
    }
  }
  return this->listParts(whole);
}

std::vector<IslandParts::Part> IslandParts::listParts(const Part& whole)
{
  const Island& island = whole.island;
  std::vector<Part> parts;
  for (const int i : island.members)
  {
    places_[std::size_t(i)] = -1;
  }
  for (const int i : island.members)
  {
    int& place = places_[std::size_t(headOf(heads_, i))];
    if (place < 0)
    {
      place = int(parts.size());
      parts.emplace_back();
    }
    parts[std::size_t(place)].island.members.push_back(i);
  }
  for (std::size_t p = 0; p < island.pairs.size(); ++p)
  {
    RockPair& pair = *island.pairs[p];
    if (!linked_[p])
    {
      // Both move away from where their axis was found.
      pair.seen = pair.known = pair.touched = false;
      pair.contacts.clear();
      continue;
    }
    Part& part = parts[std::size_t(places_[std::size_t(headOf(heads_, pair.first))])];
    part.island.pairs.push_back(&pair);
    part.sights.push_back(whole.sights[p]);
  }
  return parts;
}

bool IslandParts::isOne(const Island& island)
{
  for (const int i : island.members)
  {
    heads_[std::size_t(i)] = i;
  }
  std::size_t parts = island.members.size();
  for (const RockPair* pair : island.pairs)
  {
    if (pair->touched || pair->strikes)
    {
      const int a = headOf(heads_, pair->first), b = headOf(heads_, pair->second);
      parts -= a != b;
      heads_[std::size_t(std::max(a, b))] = std::min(a, b);
    }
  }
  return parts == 1;
}

void IslandParts::advance(const Part& part, double from, double until)
{
  const Island& island = part.island;
  if (island.members.size() == 1)
  {
    FallingRock& rock = fall_->rocks[std::size_t(island.members.front())];
    rock.body().quietTime = 0.0; // the island comes to rest as a whole
    advanceAlone(rock, until);
    return;
  }
  const double half = 0.5 * (until - from);
  const double shortest = kShortestPart * fall_->parameters.timeStep;
  if (this->isOne(island) || half < (1.0 - 1e-9) * shortest)
  {
    IslandStepper(*fall_, island).advance(until);
    return;
  }
  for (const double end : { from + half, until })
  {
    for (const Part& one : this->fallApart(part, half))
    {
      this->advance(one, end - half, end);
    }
  }
}

} // namespace

void advanceAlone(FallingRock& rock, double until)
{
  rock.sim.advance(until);
  rock.asleep = rock.sim.done() && rock.sim.trajectory().summary.fate == Fate::Rested;
}

void advanceIsland(FallState& fall, const Island& island, double until)
{
  if (island.crowd)
  {
    IslandStepper(fall, island).advance(until);
    return;
  }
  thread_local IslandParts parts; // as much memory as for all rocks
  parts.advance(fall, island, fall.time, until);
}

} // namespace rockfall
