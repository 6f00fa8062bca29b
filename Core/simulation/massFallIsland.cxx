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
  return { members_[pair.first]->sim.state_, members_[pair.second]->sim.state_ };
}

bool MassFall::isCrowd(const Island& island) const
{
  double stiffest = 0.0;
  for (int i : island.members)
  {
    stiffest = std::max(stiffest, members_[i]->sim.block_.largestMobility());
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
    h = sim.done_ ? h : std::min(h, sim.impactStep());
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
    const Block& a = members_[pair->first]->sim.block_;
    const Block& b = members_[pair->second]->sim.block_;
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
    if (sim.done_)
    {
      return;
    }
    m.stand();
    const double r = sim.block_.radius();
    const double pushed = work.sides[std::size_t(island.members[k])].pushed;
    const double reach =
      reachOf(sim.state_.velocity.norm() + sim.state_.spin.norm() * r + pushed, r);
    sim.crowded_ = crowd;
    // Twice: beyond a concave edge planes serve a little further than their triangles.
    if (crowd && sim.isHigh(2.0 * reach))
    {
      sim.closeScar();
      sim.armContacts(h);
      return;
    }
    sim.placed_.placeVertices();
    const auto findThem = [&]() -> const CandidatePairs&
    {
      if (!crowd)
      {
        sim.ensureCandidates(reach);
      }
      const double spread = sim.state_.spin.norm() * r + pushed;
      const CandidatePairs& near = crowd
        ? sim.candidatesNow(m.body,
            { sim.state_.velocity, spread, kFasterApproach * h,
              parameters_.gravity * h * h + kSurelyOnSlope * r, reach })
        : sim.candidates_;
      sim.findContacts(near, reach, crowd ? 0.0 : h);
      return near;
    };
    const CandidatePairs* near = &findThem();
    while (sim.solid_ && sim.breakTrees(h))
    {
      near = &findThem();
    }
    while (sim.yields_ && sim.followScar(h))
    {
      near = &findThem();
    }
    if (sim.solid_)
    {
      stand(k); // what broke has taken speed
    }
    double pressed = 0.0;
    for (const Contact& c : sim.contacts_)
    {
      pressed = std::max(pressed, -c.gap());
    }
    holdOverlap(sim.placed_, sim.patch_, *near, kLooseOverlap * r + 2.0 * pressed, sim.contacts_);
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
    if (!sim.done_ && !sim.isCalm())
    {
      return false;
    }
  }
  for (const RockPair* pair : island.pairs)
  {
    const RockSimulator &a = members_[pair->first]->sim, &b = members_[pair->second]->sim;
    const double resting = std::min(a.restingSpeed_, b.restingSpeed_);
    const double mass = 1.0 / (1.0 / a.block_.mass() + 1.0 / b.block_.mass());
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
        double(island.members.size()) * parameters_.gravity * (a.block_.mass() + b.block_.mass());
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
    const Vec3 spin = sim.state_.angularVelocity();
    for (const Contact& c : sim.contacts_)
    {
      if (impact(
            c, sim.state_.velocity + spin.cross(c.point - sim.state_.position), sim.restingSpeed_))
      {
        return false;
      }
    }
  }
  for (const RockPair* pair : island.pairs)
  {
    const double resting =
      std::min(members_[pair->first]->sim.restingSpeed_, members_[pair->second]->sim.restingSpeed_);
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
  sim.placed_.placeVertices();
  if (sim.crowded_)
  {
    sim.ensureCandidates(0.0, true); // what is high over the ground had no need yet
  }
  const double room = sim.candidates_.room(sim.state_, sim.block_.radius(), 0.0);
  const double speed = sim.state_.velocity.norm() + sim.block_.largestRimSpeed(sim.state_.spin);
  const double free = std::min(most, timeToCover(room, speed, parameters_.gravity));
  return timeToClose(
    sim.placed_, sim.state_, sim.patch_, sim.candidates_, parameters_.gravity, free);
}

double MassFall::freeOfEachOther(const RockPair& pair, double gravity) const
{
  // Along the axis that tells them apart they come no nearer than this.
  const RockSimulator &a = members_[pair.first]->sim, &b = members_[pair.second]->sim;
  const double closing = -pair.axis.normal.dot(a.state_.velocity - b.state_.velocity) +
    a.block_.largestRimSpeed(a.state_.spin) + b.block_.largestRimSpeed(b.state_.spin);
  return timeToCover(pair.axis.distance, closing, gravity);
}

double MassFall::freeTime(const Island& island, double most)
{
  double free = most;
  for (int i : island.members)
  {
    RockSimulator& sim = members_[i]->sim;
    free = sim.done_ ? free : this->freeOfSlope(sim, free);
  }
  for (const RockPair* pair : island.pairs)
  {
    if (!members_[pair->first]->sim.done_ && !members_[pair->second]->sim.done_)
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
    const double rim = sim.block_.largestRimSpeed(sim.state_.spin);
    work.flying[std::size_t(i)] = !sim.done_ &&
      sim.state_.velocity.norm() + rim > sim.restingSpeed_ &&
      std::none_of(sim.contacts_.begin(), sim.contacts_.end(), isClosed);
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
    if (!sim.done_)
    {
      sim.contacts_.clear();
      sim.finishImpact();
      const double end = sim.state_.time + duration;
      sim.advanceInFlight(duration);
      while (sim.barriers_ && !sim.done_ && sim.state_.time < end)
      {
        sim.advanceInFlight(end - sim.state_.time); // through a barrier that broke
      }
      if (!sim.done_)
      {
        sim.checkLeft();
      }
      sim.quietTime_ = 0.0;
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
    if (!members_[i]->sim.done_)
    {
      return members_[i]->sim.state_.time;
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
      if (!sim.inContact_)
      {
        sim.beginContact();
      }
      const double limit = (inTime ? 1.0 : kCrowdTravel) * sim.travelLimit();
      travel = sim.done_ ? travel : std::min(travel, limit);
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
      const std::vector<Contact>& c = members_[i]->sim.contacts_;
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
