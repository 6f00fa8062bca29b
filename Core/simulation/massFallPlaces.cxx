// Facts of all rocks and pairs of an island that come before the loops over each of them: their
// places in the system of a step, whether they may bounce, and what rocks may add to each
// other's speed.

#include "simulation/massFallWork.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>

namespace rockfall
{

namespace
{

/// Rocks, pairs or contacts of one part.
constexpr std::size_t kPartSize = 128;

std::size_t partsOf(std::size_t count)
{
  return (count + kPartSize - 1) / kPartSize;
}

} // namespace

std::size_t MassFall::layOut(const Island& island, Workspace& work)
{
  const std::size_t rocks = island.members.size(), pairs = island.pairs.size();
  const std::size_t rockParts = partsOf(rocks), pairParts = partsOf(pairs);
  work.parts.resize(std::max(rockParts, pairParts));
  work.placeOf.resize(members_.size());
  work.slopeFirsts.resize(rocks);
  // Each part counts from its own beginning, then from where the parts before it end.
  const auto countRocks = [&](std::size_t part)
  {
    Workspace::Part counted;
    for (std::size_t k = part * kPartSize; k < std::min(rocks, (part + 1) * kPartSize); ++k)
    {
      this->comeToRock(island, k);
      const RockSimulator& sim = members_[island.members[k]]->sim;
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
      Workspace::Part& p = work.parts[part];
      const Workspace::Part counted = p;
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
    const Workspace::Part& before = work.parts[part];
    for (std::size_t k = part * kPartSize; k < std::min(rocks, (part + 1) * kPartSize); ++k)
    {
      int& place = work.placeOf[std::size_t(island.members[k])];
      place += place < 0 ? 0 : before.places;
      work.slopeFirsts[k] += before.contacts;
      members_[island.members[k]]->place = place;
    }
  };
  forEach(rockParts, 1, placeRocks);
  work.firsts.resize(pairs + 1);
  work.places.resize(pairs);
  work.meeting.resize(std::max(pairs, work.meeting.size()));
  work.touching.clear();
  const auto countPairs = [&](std::size_t part)
  {
    Workspace::Part counted;
    const std::size_t begin = part * kPartSize, end = std::min(pairs, begin + kPartSize);
    std::size_t* const meeting = work.meeting.data() + begin;
    std::size_t* const firsts = work.firsts.data();
    std::array<int, 2>* const places = work.places.data();
    const int* const placeOf = work.placeOf.data();
    for (std::size_t p = begin; p < end; ++p)
    {
      comeToPair(island.pairs, p);
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

void MassFall::settleBounces(bool lasting, Workspace& work) const
{
  // Few contacts have a say: each part looks for its own.
  const std::size_t contacts = work.contacts.size(), parts = partsOf(contacts);
  work.parts.resize(std::max(parts, work.parts.size()));
  work.meeting.resize(std::max(contacts, work.meeting.size()));
  const auto choose = [&](std::size_t part)
  {
    std::size_t* to = work.meeting.data() + part * kPartSize;
    for (std::size_t k = part * kPartSize, end = std::min(contacts, k + kPartSize); k < end; ++k)
    {
      const IslandContact& c = work.contacts[k];
      *to = k;
      to += c.bounce >= 0.0 || c.closed;
    }
    work.parts[part].contacts = std::size_t(to - work.meeting.data()) - part * kPartSize;
  };
  forEach(parts, 1, choose);
  const auto forChosen = [&](auto&& visit)
  {
    for (std::size_t part = 0; part < parts; ++part)
    {
      const std::size_t* const first = work.meeting.data() + part * kPartSize;
      for (const std::size_t *k = first, *end = first + work.parts[part].contacts; k != end; ++k)
      {
        visit(work.contacts[*k]);
      }
    }
  };
  work.partners.assign(work.bodies.size(), kMeetsNone);
  forChosen([&](const IslandContact& k) { meet(work.partners, k); });
  const auto settle = [&](IslandContact& k)
  {
    if (k.bounce < 0.0)
    {
      return;
    }
    k.bounce = mayBounce(work.partners, k) ? k.bounce : -1.0;
    if (!lasting || k.bounce < 0.0)
    {
      return;
    }
    // Rocks that bounce have no acceleration to go on with.
    for (const int b : { k.first, k.second })
    {
      if (b >= 0)
      {
        work.bodies[std::size_t(b)].acceleration.setZero();
        work.bodies[std::size_t(b)].spinAcceleration.setZero();
      }
    }
  };
  forChosen(settle);
}

void MassFall::findPushes(const Island& island, Workspace& work)
{
  for (const RockPair* pair : island.pairs)
  {
    Workspace::Side& a = work.sides[std::size_t(pair->first)];
    Workspace::Side& b = work.sides[std::size_t(pair->second)];
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
