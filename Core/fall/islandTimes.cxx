// How long a step of an island may be.

#include "fall/IslandStepper.h"

#include "contact/motion.h"
#include "contact/timeToTouch.h"
#include "fall/stepContacts.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

double impactStepOf(const FallState& fall, const Island& island)
{
  double h = fall.parameters.timeStep;
  for (int i : island.members)
  {
    const RockSimulator& sim = fall.rocks[i].sim;
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
    const Block& a = fall.rocks[pair->first].sim.body().block;
    const Block& b = fall.rocks[pair->second].sim.body().block;
    const double all = fall.parameters.normalPenalty * (a.largestMobility() + b.largestMobility());
    h = std::min(h, std::numbers::pi / (kStepsPerPairImpact * std::sqrt(std::max(sum, all))));
  }
  return h;
}

bool isCalm(const FallState& fall, const Island& island)
{
  for (int i : island.members)
  {
    const RockSimulator& sim = fall.rocks[i].sim;
    if (!sim.body().done && !sim.isCalm())
    {
      return false;
    }
  }
  for (const RockPair* pair : island.pairs)
  {
    const RockBody &a = fall.rocks[pair->first].sim.body(),
                   &b = fall.rocks[pair->second].sim.body();
    const double resting = std::min(a.restingSpeed, b.restingSpeed);
    const double mass = 1.0 / (1.0 / a.block.mass() + 1.0 / b.block.mass());
    const PairMotion motion = motionOf(fall, *pair);
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
        double(island.members.size()) * fall.parameters.gravity * (a.block.mass() + b.block.mass());
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

bool IslandStepper::mayLast(double h) const
{
  // A contact that is about to close must not come in as an impact.
  const auto impact = [&](const Contact& c, const Vec3& velocity, double resting)
  { return hits(c, -c.normal.dot(velocity), resting, h); };
  for (int i : island_.members)
  {
    const RockSimulator& sim = fall_.rocks[i].sim;
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
  for (const RockPair* pair : island_.pairs)
  {
    const double resting = std::min(
      fall_.rocks[pair->first].body().restingSpeed, fall_.rocks[pair->second].body().restingSpeed);
    const PairMotion motion = motionOf(fall_, *pair);
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

double IslandStepper::freeOfSlope(RockSimulator& sim, double most) const
{
  sim.body().placed.placeVertices();
  if (sim.body().crowded)
  {
    sim.ensureCandidates(0.0, true); // what is high over the ground had no need yet
  }
  const double room = sim.candidates().room(sim.body().state, sim.body().block.radius(), 0.0);
  const double speed =
    sim.body().state.velocity.norm() + sim.body().block.largestRimSpeed(sim.body().state.spin);
  const double free = std::min(most, timeToCover(room, speed, fall_.parameters.gravity));
  return timeToClose(sim.body().placed, sim.body().state, sim.patch(), sim.candidates(),
    fall_.parameters.gravity, free);
}

double IslandStepper::freeOfEachOther(const RockPair& pair, double gravity) const
{
  // Along the axis that tells them apart they come no nearer than this.
  const RockBody &a = fall_.rocks[pair.first].body(), &b = fall_.rocks[pair.second].body();
  const double closing = -pair.axis.normal.dot(a.state.velocity - b.state.velocity) +
    a.block.largestRimSpeed(a.state.spin) + b.block.largestRimSpeed(b.state.spin);
  return timeToCover(pair.axis.distance, closing, gravity);
}

double IslandStepper::freeTime(double most) const
{
  double free = most;
  for (int i : island_.members)
  {
    RockSimulator& sim = fall_.rocks[i].sim;
    free = sim.body().done ? free : this->freeOfSlope(sim, free);
  }
  for (const RockPair* pair : island_.pairs)
  {
    if (!fall_.rocks[pair->first].body().done && !fall_.rocks[pair->second].body().done)
    {
      free = std::min(free, this->freeOfEachOther(*pair, 0.0)); // both fall alike
    }
  }
  return free;
}

double IslandStepper::freeOfFlying(double most) const
{
  work_.flying.assign(fall_.rocks.size(), 0);
  for (int i : island_.members)
  {
    const RockSimulator& sim = fall_.rocks[i].sim;
    const double rim = sim.body().block.largestRimSpeed(sim.body().state.spin);
    work_.flying[std::size_t(i)] = !sim.body().done &&
      sim.body().state.velocity.norm() + rim > sim.body().restingSpeed &&
      !anyClosed(sim.body().contacts);
  }
  for (const RockPair* pair : island_.pairs)
  {
    if (anyClosed(pair->contacts))
    {
      work_.flying[std::size_t(pair->first)] = work_.flying[std::size_t(pair->second)] = 0;
    }
  }
  double free = most;
  for (int i : island_.members)
  {
    free = work_.flying[std::size_t(i)] ? this->freeOfSlope(fall_.rocks[i].sim, free) : free;
  }
  for (const RockPair* pair : island_.pairs)
  {
    if (work_.flying[std::size_t(pair->first)] || work_.flying[std::size_t(pair->second)])
    {
      free = std::min(free, this->freeOfEachOther(*pair, fall_.parameters.gravity));
    }
  }
  return free;
}

} // namespace rockfall
