#include "world/sleep.h"

#include "base/parallel.h"
#include "law/settings.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace rockfall
{

namespace
{

void lingerAnew(FallingRock& rock)
{
  rock.slowRestAnchor = rock.sim.state();
  rock.furthest = rock.halfway = 0.0;
}

} // namespace

bool isStill(const WorldState& world, FallingRock& rock)
{
  const RockBody& body = rock.body();
  if (body.done)
  {
    return true;
  }
  const double r = body.block.radius();
  const auto displacementFrom = [&](const FallingRock::Place& place)
  { return (body.state.position - place.position).norm(); };
  const auto turnFrom = [&](const FallingRock::Place& place)
  { return r * body.state.orientation.angularDistance(place.orientation); };
  const double unit = std::sqrt(std::max(world.parameters.gravity, kLeastGravity) * r); // m/s
  // Most go so far that how far they turn does not matter.
  const double still = kStillSpeed * unit * kStillTime,
               displacement = displacementFrom(rock.restAnchor);
  if (displacement > still || displacement + turnFrom(rock.restAnchor) > still)
  {
    rock.restAnchor = body.state;
  }
  const double near = kLingerWay * r, further = displacementFrom(rock.slowRestAnchor);
  const auto turns = [&] { return r * body.state.spin.norm() > kLingerRim * unit; };
  rock.furthest = std::max(rock.furthest, further);
  const double since = world.time - rock.slowRestAnchor.time;
  if (since <= 0.5 * kLingerTime)
  {
    rock.halfway = rock.furthest;
  }
  // What swings comes back, what settles becomes slower: neither is true of what begins to slide.
  const bool slides = since >= kLingerTime && further >= (1.0 - kComesBack) * rock.furthest &&
    further > (1.0 + kFaster) * 2.0 * rock.halfway && further > kComesBack * near;
  if (slides || further > near || (turns() && further + turnFrom(rock.slowRestAnchor) > near))
  {
    lingerAnew(rock);
  }
  return world.time - rock.restAnchor.time >= kStillTime ||
    world.time - rock.slowRestAnchor.time >= kLingerTime;
}

void restAnew(FallingRock& rock)
{
  RockBody& body = rock.body();
  if (!body.done)
  {
    rock.restAnchor = body.state;
    lingerAnew(rock);
    body.quietTime = 0.0;
  }
}

void putToSleep(FallingRock& rock)
{
  rock.asleep = true;
  rock.fall().end(Fate::Rested);
  RockBody& body = rock.body();
  body.state.velocity.setZero();
  body.state.spin.setZero();
  body.acceleration.setZero();
  body.spinAcceleration.setZero();
}

void wake(FallingRock& rock, double time)
{
  rock.asleep = false;
  rock.sim.wake(time);
  rock.restAnchor = rock.sim.state();
  lingerAnew(rock);
}

bool touchedLately(const RockPair& pair, double time)
{
  return pair.touchedAt > time - kStillTime;
}

void settleIsland(WorldState& world, const Island& island, double since)
{
  constexpr std::size_t kStayGrain = 64;
  std::atomic<bool> still = true, gone = false;
  const auto look = [&](std::size_t k)
  {
    FallingRock& rock = world.rocks[std::size_t(island.members[k])];
    if (!isStill(world, rock))
    {
      still.store(false, std::memory_order_relaxed);
    }
    if (rock.sim.done() && !rock.asleep && rock.sim.state().time > since)
    {
      gone.store(true, std::memory_order_relaxed);
    }
  };
  forEach(island.members.size(), kStayGrain, look);
  for (const int i : island.members)
  {
    FallingRock& rock = world.rocks[std::size_t(i)];
    if (gone)
    {
      restAnew(rock);
    }
    else if (still && !rock.sim.done())
    {
      putToSleep(rock);
    }
  }
}

} // namespace rockfall
