#include "world/stepContacts.h"

#include "law/cohesion.h"

#include <algorithm>

namespace rockfall
{

PairStiffness pairStiffness(const SimulationParameters& parameters)
{
  return { parameters.pairPenalty(), parameters.shearRatio, parameters.rigid };
}

void setSprings(const WorldState& world, const RockPair& pair, Contact& c)
{
  const RockBody& a = world.rocks[std::size_t(pair.first)].body();
  const RockBody& b = world.rocks[std::size_t(pair.second)].body();
  PairSprings(
    pairStiffness(world.parameters), pair.law.damping, a.block, a.state, &b.block, &b.state)
    .set(c);
}

IslandContact touchOfPair(const WorldState& world, RockPair& pair, const PairMotion& motion,
  Contact& c, const IslandWork& work)
{
  const double resting = std::min(
    work.sides[std::size_t(pair.first)].resting, work.sides[std::size_t(pair.second)].resting);
  IslandContact k;
  k.contact = &c;
  k.closed = c.closed();
  k.first = work.placeOf[std::size_t(pair.first)];
  k.second = work.placeOf[std::size_t(pair.second)];
  k.friction = pair.law.friction;
  k.damping = pair.law.damping;
  k.restitution = pair.law.restitution;
  k.resting = resting;
  k.cohesion = pair.law.cohesion;
  if (k.cohesion > 0.0)
  {
    k.cohesion = sharedCohesion(k.cohesion, closedCount(pair.contacts));
  }
  if (pair.strikes)
  {
    const double approach = -c.normal.dot(motion.at(c.point));
    if (c.closed() && pair.impact.time < world.rocks[pair.first].sim.body().state.time)
    {
      k.reboundSpeed = bounceLeft(c, approach); // as on the slope
    }
    pair.impact.approach = std::max(pair.impact.approach, approach);
  }
  return k;
}

} // namespace rockfall
