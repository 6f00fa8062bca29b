#include "world/stepLayout.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>

namespace rockfall
{

std::size_t layOut(WorldState& world, const Island& island, IslandWork& work)
{
  const std::size_t rocks = island.members.size(), pairs = island.pairs.size();
  const std::size_t rockParts = partsOf(rocks), pairParts = partsOf(pairs);
  work.parts.resize(std::max(rockParts, pairParts));
  work.placeOf.resize(world.rocks.size());
  work.slopeFirsts.resize(rocks);
  // Each part counts from its own beginning, then from where the parts before it end.
  const auto countRocks = [&](std::size_t part)
  {
    IslandWork::Part counted;
    for (std::size_t k = part * kPartSize; k < std::min(rocks, (part + 1) * kPartSize); ++k)
    {
      const SingleRock& sim = world.rocks[island.members[k]].sim;
      work.placeOf[std::size_t(island.members[k])] = sim.body().done ? -1 : counted.places++;
      work.slopeFirsts[k] = counted.contacts;
      counted.contacts += sim.body().done ? 0 : sim.body().contacts.size();
    }
    work.parts[part] = counted;
  };
  forEach(rockParts, 1, countRocks);
  std::size_t contacts = 0;
  const auto goOn = [&](std::size_t parts)
  {
    int places = 0;
    for (std::size_t part = 0; part < parts; ++part)
    {
      IslandWork::Part& p = work.parts[part];
      const IslandWork::Part counted = p;
      p.places = places;
      p.contacts = contacts;
      places += counted.places;
      contacts += counted.contacts;
    }
    return places;
  };
  const int all = goOn(rockParts);
  const auto placeRocks = [&](std::size_t part)
  {
    const IslandWork::Part& before = work.parts[part];
    for (std::size_t k = part * kPartSize; k < std::min(rocks, (part + 1) * kPartSize); ++k)
    {
      int& place = work.placeOf[std::size_t(island.members[k])];
      place += place < 0 ? 0 : before.places;
      work.slopeFirsts[k] += before.contacts;
      world.rocks[island.members[k]].place = place;
    }
  };
  forEach(rockParts, 1, placeRocks);
  work.firsts.resize(pairs + 1);
  work.places.resize(pairs);
  work.meeting.resize(std::max(pairs, work.meeting.size()));
  work.touching.clear();
  const auto countPairs = [&](std::size_t part)
  {
    IslandWork::Part counted;
    const std::size_t begin = part * kPartSize, end = std::min(pairs, begin + kPartSize);
    std::size_t* const meeting = work.meeting.data() + begin;
    std::size_t* const firsts = work.firsts.data();
    std::array<int, 2>* const places = work.places.data();
    const int* const placeOf = work.placeOf.data();
    for (std::size_t p = begin; p < end; ++p)
    {
      RockPair& pair = *island.pairs[p];
      places[p] = { placeOf[pair.first], placeOf[pair.second] };
      firsts[p] = counted.contacts;
      counted.contacts += pair.contacts.size();
      pair.touched = false;
      meeting[counted.touching] = p;
      counted.touching += !pair.contacts.empty() || pair.strikes;
    }
    work.parts[part] = counted;
  };
  forEach(pairParts, 1, countPairs);
  goOn(pairParts);
  for (std::size_t part = 0; part < pairParts; ++part)
  {
    const std::size_t* const from = work.meeting.data() + part * kPartSize;
    work.touching.insert(work.touching.end(), from, from + work.parts[part].touching);
    std::size_t* const firsts = work.firsts.data();
    const std::size_t before = work.parts[part].contacts;
    for (std::size_t p = part * kPartSize, end = std::min(pairs, p + kPartSize); p < end; ++p)
    {
      firsts[p] += before;
    }
  }
  work.firsts.back() = contacts;
  work.bodies.resize(std::size_t(all));
  work.motions.resize(std::size_t(all));
  work.arrived.resize(std::size_t(all));
  work.energyBefore.resize(std::size_t(all));
  work.contacts.resize(contacts);
  return std::size_t(all);
}

void findPushes(const Island& island, IslandWork& work)
{
  for (const RockPair* pair : island.pairs)
  {
    IslandWork::Side& a = work.sides[std::size_t(pair->first)];
    IslandWork::Side& b = work.sides[std::size_t(pair->second)];
    if (a.done || b.done)
    {
      continue;
    }
    // Rocks that meet elastically change their velocities by twice their shares of the closing one.
    const double shared = 2.0 * (a.velocity - b.velocity).norm() / (a.mass + b.mass);
    a.pushed = std::max(a.pushed, shared * b.mass);
    b.pushed = std::max(b.pushed, shared * a.mass);
  }
}

} // namespace rockfall
