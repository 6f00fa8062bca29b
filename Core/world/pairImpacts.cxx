#include "world/pairImpacts.h"

#include "rock/restitution.h"

#include <algorithm>

namespace rockfall
{

namespace
{

/// Whether it is one to either of the two, as on the slope: what rattles in a heap is none.
bool isImpactOf(const WorldState& world, const RockPair& pair)
{
  const RockPair::Impact& impact = pair.impact;
  const RockBody &a = world.rocks[pair.first].body(), &b = world.rocks[pair.second].body();
  return isImpact(impact.approach, std::min(impact.before[0].norm(), impact.before[1].norm()),
    std::min(a.restingSpeed, b.restingSpeed), world.parameters.gravity,
    std::min(a.block.radius(), b.block.radius()));
}

} // namespace

void beginPairImpact(
  RockPair& pair, const BlockState& first, const BlockState& second, const Vec3& point)
{
  RockPair::Impact& impact = pair.impact;
  if (pair.strikes)
  {
    return;
  }
  impact = {};
  pair.strikes = true;
  impact.time = first.time;
  impact.before[0] = first.velocity;
  impact.before[1] = second.velocity;
  impact.point = point;
}

void findLateImpact(const WorldState& world, RockPair& pair, const IslandContact& touch, double h)
{
  const Contact& c = *touch.contact;
  const RockBody &a = world.rocks[pair.first].body(), &b = world.rocks[pair.second].body();
  if (touch.struck > 0.0)
  {
    const bool first = !pair.strikes;
    beginPairImpact(pair, a.before, b.before, c.point);
    const double time = a.before.time + touch.struckAt;
    pair.impact.time = first ? time : std::min(pair.impact.time, time);
    pair.impact.approach = std::max(pair.impact.approach, touch.struck);
    return;
  }
  if (touch.closed || c.normalForce <= 0.0)
  {
    return;
  }
  const double resting = std::min(a.restingSpeed, b.restingSpeed);
  const double closing = -touch.opening / h;
  if (closing > resting + world.parameters.gravity * h)
  {
    beginPairImpact(pair, a.before, b.before, c.point);
    pair.impact.approach = std::max(pair.impact.approach, closing);
  }
}

void finishPairImpact(WorldState& world, RockPair& pair, bool over)
{
  RockPair::Impact& impact = pair.impact;
  if (!pair.strikes)
  {
    return;
  }
  pair.strikes = false;
  const double size = impact.impulse.norm();
  const double held = over ? 0.0 : springEnergyOf(pair.contacts);
  const bool noted = size > 0.0 && isImpactOf(world, pair);
  const double loss = noted ? impact.loss - held : 0.0;
  pair.lastingLoss += impact.loss - loss; // springs that had been compressed before, or are now
  if (!noted)
  {
    return;
  }
  for (int side = 0; side < 2; ++side)
  {
    const int own = side == 0 ? pair.first : pair.second;
    const int other = side == 0 ? pair.second : pair.first;
    SingleRock& sim = world.rocks[own].sim;
    ImpactEvent event;
    event.time = impact.time;
    event.position = impact.point;
    event.normal = (side == 0 ? 1.0 : -1.0) / size * impact.impulse;
    event.cfe = 0;
    event.impulse = size;
    event.approachSpeed = impact.approach;
    event.velocityBefore = impact.before[side];
    event.velocityAfter = sim.body().state.velocity;
    event.energyLoss = loss;
    event.restitution = pair.law.restitution;
    event.otherRock = other;
    noteImpact(sim.trajectory(), event, world.parameters.kept.impacts);
  }
}

void closePairBooks(WorldState& world, RockPair& pair)
{
  finishPairImpact(world, pair, false);
  for (const int i : { pair.first, pair.second })
  {
    world.rocks[i].sim.trajectory().summary.lastingLoss += 0.5 * pair.lastingLoss;
  }
  pair.lastingLoss = 0.0;
}

} // namespace rockfall
