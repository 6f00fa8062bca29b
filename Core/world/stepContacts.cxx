#include "world/stepContacts.h"

#include "law/cohesion.h"
#include "rock/restitution.h"

#include <algorithm>

namespace rockfall
{

IslandContact touchOnSlope(const WorldState& world, const FallingRock& member, Contact& c)
{
  const SingleRock& sim = member.sim;
  const BlockState& state = sim.body().state;
  const Vec3 lever = c.point - state.position;
  const double approach = -c.normal.dot(state.velocity + state.angularVelocity().cross(lever));
  const bool down =
    comesDown(approach, state.velocity.norm(), world.parameters.gravity, sim.body().block.radius());
  const int ground = world.surface.restitutionClass(c.cfe);
  const SurfaceMaterial& material = world.surface.terrain().restitutionMaterial(ground);
  IslandContact k;
  k.restitution = world.surface.restitutionAt(sim.fall().impact.touchAt(c.cfe, c.point));
  if (material.restitutionModel == RestitutionModel::Velocity && down)
  {
    k.restitution = 1.0; // Rv is taken off the whole velocity when the impact is over
  }
  else if (material.restitutionModel == RestitutionModel::SpeedDependent)
  {
    k.restitutionSpeed = material.restitutionSpeed;
  }
  k.resting = sim.body().restingSpeed;
  k.contact = &c;
  k.closed = c.closed();
  k.first = member.place;
  k.friction = c.friction;
  k.cohesion = c.cohesion;
  if (c.closed() && sim.fall().impact.pending())
  {
    k.reboundSpeed = bounceLeft(c, approach); // begun where impacts are resolved in time
  }
  return k;
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
