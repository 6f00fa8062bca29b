// An island of rocks that touch each other, over one step of Δt: contacts, and the length of steps.

#include "simulation/massFallWork.h"

#include "base/abort.h"
#include "base/parallel.h"
#include "contact/detection.h"
#include "contact/motion.h"
#include "contact/timeToTouch.h"
#include "law/settings.h"
#include "simulation/pressOut.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

PairMotion MassFall::motionOf(const RockPair& pair) const
{
  return { members_[pair.first]->sim.body().state, members_[pair.second]->sim.body().state };
}

bool MassFall::isCrowd(const Island& island) const
{
  double stiffest = 0.0;
  for (int i : island.members)
  {
    stiffest = std::max(stiffest, members_[i]->sim.body().block.largestMobility());
  }
  const double frequency = std::sqrt(parameters_.normalPenalty * stiffest);
  const double steps = parameters_.timeStep * kStepsPerImpact * frequency / std::numbers::pi;
  const int size = int(island.members.size());
  return size > resolved || (size > kAlwaysResolved && size * steps > kMostSteps * resolved);
}

double MassFall::islandStep(const Island& island) const
{
  double h = parameters_.timeStep;
  for (int i : island.members)
  {
    const RockSimulator& sim = members_[i]->sim;
    h = sim.body().done ? h : std::min(h, sim.impactStep());
  }
  for (const RockPair* pair : island.pairs)
  {
    if (pair->contacts.empty())
    {
      continue;
    }
    double sum = 0.0;
    for (const Contact& c : pair->contacts)
    {
      sum += c.frequency2;
    }
    const Block& a = members_[pair->first]->sim.body().block;
    const Block& b = members_[pair->second]->sim.body().block;
    const double all = parameters_.normalPenalty * (a.largestMobility() + b.largestMobility());
    h = std::min(h, std::numbers::pi / (kStepsPerPairImpact * std::sqrt(std::max(sum, all))));
  }
  return h;
}

void MassFall::gatherContacts(const Island& island, double h, Workspace& work)
{
  const auto reachOf = [&](double speed, double radius)
  { return kFasterApproach * speed * h + parameters_.gravity * h * h + 1e-6 * radius; };
  const bool crowd = island.crowd;
  work.sides.resize(members_.size());
  const auto stand = [&](std::size_t k)
  {
    const int i = island.members[k];
    work.sides[std::size_t(i)].set(members_[std::size_t(i)]->sim);
  };
  forEach(island.members.size(), kRockGrain, stand);
  if (crowd)
  {
    findPushes(island, work);
  }
  const auto onSlope = [&](std::size_t k)
  {
    this->comeToRock(island, k);
    Member& m = *members_[island.members[k]];
    RockSimulator& sim = m.sim;
    if (sim.body().done)
    {
      return;
    }
    m.stand();
    const double r = sim.body().block.radius();
    const double pushed = work.sides[std::size_t(island.members[k])].pushed;
    const double reach =
      reachOf(sim.body().state.velocity.norm() + sim.body().state.spin.norm() * r + pushed, r);
    sim.body().crowded = crowd;
    // Twice: beyond a concave edge planes serve a little further than their triangles.
    if (crowd && sim.isHigh(2.0 * reach))
    {
      sim.closeScar();
      sim.armContacts(h);
      return;
    }
    sim.body().placed.placeVertices();
    const auto findThem = [&]() -> const CandidatePairs&
    {
      if (!crowd)
      {
        sim.ensureCandidates(reach);
      }
      const double spread = sim.body().state.spin.norm() * r + pushed;
      const CandidatePairs& near = crowd
        ? sim.candidatesNow(m.body,
            { sim.body().state.velocity, spread, kFasterApproach * h,
              parameters_.gravity * h * h + kSurelyOnSlope * r, reach })
        : sim.candidates();
      sim.findContacts(near, reach, crowd ? 0.0 : h);
      return near;
    };
    const CandidatePairs* near = &findThem();
    while (sim.meetsSolids() && sim.breakTrees(h))
    {
      near = &findThem();
    }
    while (sim.meetsYielding() && sim.followScar(h))
    {
      near = &findThem();
    }
    if (sim.meetsSolids())
    {
      stand(k); // what broke has taken speed
    }
    double pressed = 0.0;
    for (const Contact& c : sim.body().contacts)
    {
      pressed = std::max(pressed, -c.gap());
    }
    holdOverlap(sim.body().placed, sim.patch(), *near, kLooseOverlap * r + 2.0 * pressed,
      sim.body().contacts);
    stiffenPressed(sim);
    sim.armContacts(h);
  };
  forEach(island.members.size(), kRockGrain, onSlope);
  const auto eachOther = [&](std::size_t k)
  {
    comeToPair(island.pairs, k);
    RockPair* pair = island.pairs[k];
    const Workspace::Side& a = work.sides[std::size_t(pair->first)];
    const Workspace::Side& b = work.sides[std::size_t(pair->second)];
    if (a.done || b.done)
    {
      pair->contacts.clear();
      pair->axis.distance = std::max(0.0, pair->axis.distance);
      return;
    }
    const PairMotion motion = work.motionOf(*pair);
    const double rims = a.rim + b.rim;
    const double smaller = std::min(a.radius, b.radius);
    const double reach = reachOf(motion.velocity.norm() + rims, smaller);
    const PairBody& first = members_[pair->first]->body;
    const PairBody& second = members_[pair->second]->body;
    if (crowd)
    {
      // The second look finds the others, should they be needed.
      const ClosingGaps closing = { motion, kFasterApproach * h,
        parameters_.gravity * h * h + kSurely * smaller, rims };
      updatePair(first, second, reach, *pair, &closing);
    }
    else
    {
      updatePair(first, second, reach, *pair);
    }
    if (!crowd)
    {
      this->setPairSprings(*pair, h); // in a crowd what may close is given springs when it is taken
    }
  };
  forEach(island.pairs.size(), kPairGrain, eachOther);
}

bool MassFall::isCalm(const Island& island) const
{
  for (int i : island.members)
  {
    const RockSimulator& sim = members_[i]->sim;
    if (!sim.body().done && !sim.isCalm())
    {
      return false;
    }
  }
  for (const RockPair* pair : island.pairs)
  {
    const RockBody &a = members_[pair->first]->sim.body(), &b = members_[pair->second]->sim.body();
    const double resting = std::min(a.restingSpeed, b.restingSpeed);
    const double mass = 1.0 / (1.0 / a.block.mass() + 1.0 / b.block.mass());
    const PairMotion motion = this->motionOf(*pair);
    double held = 0.0;
    for (const Contact& c : pair->contacts)
    {
      if (!c.closed())
      {
        continue;
      }
      if (std::abs(c.normal.dot(motion.at(c.point))) > resting)
      {
        return false;
      }
      // Beyond what the weights of a pile can hold, it is the turning point of an impact.
      const double weight =
        double(island.members.size()) * parameters_.gravity * (a.block.mass() + b.block.mass());
      const double settled = 4.0 * weight / c.stiffness;
      held += c.gap() < -settled ? 0.5 * c.stiffness * c.gap() * c.gap() : 0.0;
    }
    if (held > 0.5 * mass * resting * resting)
    {
      return false;
    }
  }
  return true;
}

bool MassFall::mayLast(const Island& island, double h) const
{
  // A contact that is about to close must not come in as an impact.
  const auto impact = [&](const Contact& c, const Vec3& velocity, double resting)
  { return hits(c, -c.normal.dot(velocity), resting, h); };
  for (int i : island.members)
  {
    const RockSimulator& sim = members_[i]->sim;
    const Vec3 spin = sim.body().state.angularVelocity();
    for (const Contact& c : sim.body().contacts)
    {
      if (impact(c, sim.body().state.velocity + spin.cross(c.point - sim.body().state.position),
            sim.body().restingSpeed))
      {
        return false;
      }
    }
  }
  for (const RockPair* pair : island.pairs)
  {
    const double resting = std::min(members_[pair->first]->sim.body().restingSpeed,
      members_[pair->second]->sim.body().restingSpeed);
    const PairMotion motion = this->motionOf(*pair);
    for (const Contact& c : pair->contacts)
    {
      if (impact(c, motion.at(c.point), resting))
      {
        return false;
      }
    }
  }
  return true;
}

double MassFall::freeOfSlope(RockSimulator& sim, double most)
{
  sim.body().placed.placeVertices();
  if (sim.body().crowded)
  {
    sim.ensureCandidates(0.0, true); // what is high over the ground had no need yet
  }
  const double room = sim.candidates().room(sim.body().state, sim.body().block.radius(), 0.0);
  const double speed =
    sim.body().state.velocity.norm() + sim.body().block.largestRimSpeed(sim.body().state.spin);
  const double free = std::min(most, timeToCover(room, speed, parameters_.gravity));
  return timeToClose(
    sim.body().placed, sim.body().state, sim.patch(), sim.candidates(), parameters_.gravity, free);
}

double MassFall::freeOfEachOther(const RockPair& pair, double gravity) const
{
  // Along the axis that tells them apart they come no nearer than this.
  const RockBody &a = members_[pair.first]->sim.body(), &b = members_[pair.second]->sim.body();
  const double closing = -pair.axis.normal.dot(a.state.velocity - b.state.velocity) +
    a.block.largestRimSpeed(a.state.spin) + b.block.largestRimSpeed(b.state.spin);
  return timeToCover(pair.axis.distance, closing, gravity);
}

double MassFall::freeTime(const Island& island, double most)
{
  double free = most;
  for (int i : island.members)
  {
    RockSimulator& sim = members_[i]->sim;
    free = sim.body().done ? free : this->freeOfSlope(sim, free);
  }
  for (const RockPair* pair : island.pairs)
  {
    if (!members_[pair->first]->sim.body().done && !members_[pair->second]->sim.body().done)
    {
      free = std::min(free, this->freeOfEachOther(*pair, 0.0)); // both fall alike
    }
  }
  return free;
}

double MassFall::freeOfFlying(const Island& island, double most, Workspace& work)
{
  const auto isClosed = [](const Contact& c) { return c.closed(); };
  work.flying.assign(members_.size(), 0);
  for (int i : island.members)
  {
    const RockSimulator& sim = members_[i]->sim;
    const double rim = sim.body().block.largestRimSpeed(sim.body().state.spin);
    work.flying[std::size_t(i)] = !sim.body().done &&
      sim.body().state.velocity.norm() + rim > sim.body().restingSpeed &&
      std::none_of(sim.body().contacts.begin(), sim.body().contacts.end(), isClosed);
  }
  for (const RockPair* pair : island.pairs)
  {
    if (std::any_of(pair->contacts.begin(), pair->contacts.end(), isClosed))
    {
      work.flying[std::size_t(pair->first)] = work.flying[std::size_t(pair->second)] = 0;
    }
  }
  double free = most;
  for (int i : island.members)
  {
    free = work.flying[std::size_t(i)] ? this->freeOfSlope(members_[i]->sim, free) : free;
  }
  for (const RockPair* pair : island.pairs)
  {
    if (work.flying[std::size_t(pair->first)] || work.flying[std::size_t(pair->second)])
    {
      free = std::min(free, this->freeOfEachOther(*pair, parameters_.gravity));
    }
  }
  return free;
}

void MassFall::fly(const Island& island, double duration)
{
  for (int i : island.members)
  {
    RockSimulator& sim = members_[i]->sim;
    if (!sim.body().done)
    {
      sim.flyFree(duration);
    }
  }
  for (RockPair* pair : island.pairs)
  {
    pair->contacts.clear();
    pair->touched = pair->seen = false;
    this->finishPairImpact(*pair);
  }
}

double MassFall::timeOf(const Island& island, double until) const
{
  for (int i : island.members)
  {
    if (!members_[i]->sim.body().done)
    {
      return members_[i]->sim.body().state.time;
    }
  }
  return until;
}

double MassFall::advanceTogether(const Island& island, double until, bool lastingOnly)
{
  thread_local Workspace work;
  work.solver.method = method;
  const bool inTime = !island.crowd;
  const auto now = [&] { return this->timeOf(island, until); };
  while (now() < until - kTooShort)
  {
    stayWanted();
    double travel = parameters_.timeStep;
    for (int i : island.members)
    {
      RockSimulator& sim = members_[i]->sim;
      sim.beginContact();
      const double limit = (inTime ? 1.0 : kCrowdTravel) * sim.travelLimit();
      travel = sim.body().done ? travel : std::min(travel, limit);
    }
    const double remaining = until - now();
    const double large = std::min(remaining, travel);
    double small = inTime ? std::min(remaining, this->islandStep(island)) : large;
    const bool calm = inTime && this->isCalm(island);
    this->gatherContacts(island, calm || !inTime ? large : small, work);
    // Stiffnesses are known now: the faster rocks meet, the stiffer.
    small = inTime ? std::min(small, this->islandStep(island)) : small;
    bool any = false;
    for (int i : island.members)
    {
      const std::vector<Contact>& c = members_[i]->sim.body().contacts;
      any = any || std::any_of(c.begin(), c.end(), [](const Contact& k) { return k.closed(); });
    }
    for (const RockPair* pair : island.pairs)
    {
      const std::vector<Contact>& c = pair->contacts;
      any = any || std::any_of(c.begin(), c.end(), [](const Contact& k) { return k.closed(); });
    }
    if (!any)
    {
      const double free = this->freeTime(island, remaining);
      if (free > small)
      {
        this->fly(island, free);
        continue;
      }
    }
    if (!inTime)
    {
      this->solve(island, large, StepKind::Lasting, true, work);
    }
    else
    {
      const double lasting = calm && any ? this->freeOfFlying(island, large, work) : 0.0;
      if ((lasting == large || lasting > small) && this->mayLast(island, lasting))
      {
        this->solve(island, lasting, StepKind::Lasting, false, work);
      }
      else if (lastingOnly)
      {
        return now();
      }
      else
      {
        this->solve(island, small, StepKind::Impact, false, work);
      }
    }
  }
  return until;
}

} // namespace rockfall
