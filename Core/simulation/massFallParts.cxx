// An island over its step. An island is all that may meet within Δt; few of its rocks touch at a
// time, and most only come near. The step is halved, and again, as long as rocks fall apart by it:
// a rock that meets no other within such a part of the step goes on by itself meanwhile.

#include "contact/motion.h"
#include "law/settings.h"
#include "simulation/massFallMeet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace rockfall
{

/// State of an island whose step is gone over in parts.
struct MassFall::Parting
{
  /// Two rocks as they stood when their axis was found. At any other time their gap is no less than
  /// offset + normal · (x₁ − x₂), less what they have turned and strained since.
  struct Sight
  {
    Vec3 normal = Vec3::Zero();
    double offset = kNoAxis; ///< m
    std::array<Quat, 2> orientations;
    std::array<Vec6, 2> strains;
  };

  std::vector<Sight> sights; ///< By pair of the whole island.
  // By rock, of those of the part at hand:
  std::vector<Pace> paces;
  std::vector<int> heads;
  std::vector<IslandBounds> bounds; ///< By head.
  std::vector<int> places;          ///< Of a head, among the parts.
  std::vector<char> linked;         ///< By pair of the part.
};

double MassFall::gapAlong(const RockPair& pair, const Parting& parting, std::size_t sight) const
{
  const Parting::Sight& seen = parting.sights[sight];
  double gap = seen.offset;
  if (gap > kNoAxis)
  {
    double sign = 1.0;
    for (const int side : { 0, 1 })
    {
      const RockSimulator& sim = members_[std::size_t(side == 0 ? pair.first : pair.second)]->sim;
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

void MassFall::sight(RockPair& pair, double reach, Parting& parting, std::size_t sight)
{
  Member &a = *members_[std::size_t(pair.first)], &b = *members_[std::size_t(pair.second)];
  a.stand();
  b.stand();
  if (!pair.known && !pair.seen)
  {
    pair.before = pair.axis;
  }
  pair.axis = findAxis(a.body, b.body, pair.axis, reach);
  pair.known = true;
  pair.seen = false;
  Parting::Sight& seen = parting.sights[sight];
  const BlockState &s = a.sim.body().state, &t = b.sim.body().state;
  seen.normal = pair.axis.normal;
  seen.offset = pair.axis.distance - seen.normal.dot(s.position - t.position);
  seen.orientations = { s.orientation, t.orientation };
  seen.strains = { s.strain, t.strain };
}

std::vector<MassFall::PartOfIsland> MassFall::fallApart(
  const PartOfIsland& whole, double duration, Parting& parting)
{
  const Island& island = whole.island;
  const double fall = parameters_.gravity * duration * duration;
  const double bounciest = contacts_.largestRestitution();
  for (const int i : island.members)
  {
    const std::size_t k = std::size_t(i);
    Pace& pace = parting.paces[k];
    pace.mass = members_[k]->sim.body().block.mass();
    this->foresee(members_[k]->sim, duration, pace);
    parting.bounds[k] = { pace.middle.array() - pace.spread, pace.middle.array() + pace.spread,
      pace.mass, pace.own, 1 };
    parting.heads[k] = i;
    parting.places[k] = -1;
  }
  const auto join = [&](const RockPair& pair)
  {
    const int a = headOf(parting.heads, pair.first), b = headOf(parting.heads, pair.second);
    if (a != b)
    {
      IslandBounds& first = parting.bounds[std::size_t(std::min(a, b))];
      first.add(parting.bounds[std::size_t(std::max(a, b))]);
      parting.heads[std::size_t(std::max(a, b))] = std::min(a, b);
    }
  };
  const std::size_t pairs = island.pairs.size();
  parting.linked.assign(pairs, 0);
  for (std::size_t p = 0; p < pairs; ++p)
  {
    const RockPair& pair = *island.pairs[p];
    if (pair.touched || pair.strikes)
    {
      parting.linked[p] = 1;
      join(pair);
    }
  }
  const auto reachOf = [&](const RockPair& pair, const Vec3& normal)
  {
    const std::size_t i = std::size_t(pair.first), j = std::size_t(pair.second);
    const IslandBounds& a = parting.bounds[std::size_t(headOf(parting.heads, pair.first))];
    const IslandBounds& b = parting.bounds[std::size_t(headOf(parting.heads, pair.second))];
    const double faster = std::max(
      a.thrown(parting.paces[i].mass, bounciest), b.thrown(parting.paces[j].mass, bounciest));
    return faster * closingSpeed(a, parting.paces[i], b, parting.paces[j], normal) * duration +
      fall;
  };
  const auto mayMeet = [&](RockPair& pair, std::size_t sight)
  {
    if (members_[std::size_t(pair.first)]->sim.body().done ||
      members_[std::size_t(pair.second)]->sim.body().done)
    {
      return false;
    }
    const double apart = this->gapAlong(pair, parting, sight);
    if (apart > 0.0 && apart > reachOf(pair, parting.sights[sight].normal))
    {
      return false;
    }
    // Along the axis that they have now there may be more room.
    for (double reach = 0.0, wider = reachOf(pair, pair.axis.normal); wider > reach;
         wider = reachOf(pair, pair.axis.normal))
    {
      reach = wider;
      this->sight(pair, reach, parting, sight);
    }
    return pair.axis.distance <= reachOf(pair, pair.axis.normal);
  };
  for (bool any = true; any;)
  {
    any = false;
    for (std::size_t p = 0; p < pairs; ++p)
    {
      if (!parting.linked[p] && mayMeet(*island.pairs[p], whole.sights[p]))
      {
        parting.linked[p] = 1;
        join(*island.pairs[p]);
        any = true;
      }
    }
  }
  std::vector<PartOfIsland> parts;
  for (const int i : island.members)
  {
    int& place = parting.places[std::size_t(headOf(parting.heads, i))];
    if (place < 0)
    {
      place = int(parts.size());
      parts.emplace_back();
    }
    parts[std::size_t(place)].island.members.push_back(i);
  }
  for (std::size_t p = 0; p < pairs; ++p)
  {
    RockPair& pair = *island.pairs[p];
    if (!parting.linked[p])
    {
      // Both move away from where their axis was found.
      pair.seen = pair.known = pair.touched = false;
      pair.contacts.clear();
      continue;
    }
    const int place = parting.places[std::size_t(headOf(parting.heads, pair.first))];
    parts[std::size_t(place)].island.pairs.push_back(&pair);
    parts[std::size_t(place)].sights.push_back(whole.sights[p]);
  }
  return parts;
}

bool MassFall::isOne(const Island& island, Parting& parting) const
{
  for (const int i : island.members)
  {
    parting.heads[std::size_t(i)] = i;
  }
  std::size_t parts = island.members.size();
  for (const RockPair* pair : island.pairs)
  {
    if (pair->touched || pair->strikes)
    {
      const int a = headOf(parting.heads, pair->first), b = headOf(parting.heads, pair->second);
      parts -= a != b;
      parting.heads[std::size_t(std::max(a, b))] = std::min(a, b);
    }
  }
  return parts == 1;
}

bool MassFall::isCarried(const Island& island) const
{
  const auto carries = [&](int i)
  {
    const RockSimulator& sim = members_[std::size_t(i)]->sim;
    const auto touches = [&](const RockPair* pair)
    { return pair->touched && (pair->first == i || pair->second == i); };
    return sim.body().done ||
      std::any_of(sim.body().contacts.begin(), sim.body().contacts.end(),
        [](const Contact& c) { return c.closed(); }) ||
      std::any_of(island.pairs.begin(), island.pairs.end(), touches);
  };
  return std::all_of(island.members.begin(), island.members.end(), carries);
}

void MassFall::advanceParts(const PartOfIsland& part, double from, double until, Parting& parting)
{
  const Island& island = part.island;
  if (island.members.size() == 1)
  {
    Member& member = *members_[std::size_t(island.members.front())];
    member.sim.body().quietTime = 0.0; // the island comes to rest as a whole
    this->advanceAlone(member, until);
    return;
  }
  const double half = 0.5 * (until - from);
  if (this->isOne(island, parting) || half < kLeastStepsOfPart * this->islandStep(island))
  {
    this->advanceTogether(island, until, false);
    return;
  }
  for (const double end : { from + half, until })
  {
    for (const PartOfIsland& one : this->fallApart(part, half, parting))
    {
      this->advanceParts(one, end - half, end, parting);
    }
  }
}

void MassFall::advanceIsland(const Island& island, double until)
{
  if (island.crowd)
  {
    this->advanceTogether(island, until, false);
    return;
  }
  double from = time_;
  if (this->isCarried(island) && this->isCalm(island))
  {
    // A single step for all, if it may last.
    from = this->advanceTogether(island, until, true);
  }
  thread_local Parting parting;
  const std::size_t rocks = members_.size();
  for (auto* of : { &parting.heads, &parting.places })
  {
    of->resize(rocks);
  }
  parting.paces.resize(rocks);
  parting.bounds.resize(rocks);
  parting.sights.assign(island.pairs.size(), {});
  PartOfIsland whole;
  whole.island = island;
  whole.sights.resize(island.pairs.size());
  std::iota(whole.sights.begin(), whole.sights.end(), std::size_t(0));
  this->advanceParts(whole, from, until, parting);
}

} // namespace rockfall
