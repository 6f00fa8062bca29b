#include "world/stepContacts.h"

#include "base/parallel.h"
#include "law/cohesion.h"
#include "rock/restitution.h"
#include "world/pairImpacts.h"
#include "world/stepLayout.h"

#include <algorithm>

namespace rockfall
{

namespace
{

/// Partners of a rock in the step (IslandWork::partners), if not one other rock or the
/// slope (−1).
constexpr int kMeetsSeveral = -2, kMeetsNone = -3;

/// Newton's law of restitution asked of a rock by several others at once may make energy. It holds
/// for what meets one other only; rocks that are hit on several sides, or lie on something, come
/// to rest against each other.
void meet(std::vector<int>& partners, const IslandContact& k)
{
  const auto meets = [&](int body, int other)
  {
    if (body >= 0)
    {
      int& partner = partners[std::size_t(body)];
      partner = partner == kMeetsNone || partner == other ? other : kMeetsSeveral;
    }
  };
  meets(k.first, k.second);
  meets(k.second, k.first);
}

bool mayBounce(const std::vector<int>& partners, const IslandContact& k)
{
  return partners[std::size_t(k.first)] != kMeetsSeveral ||
    (k.second >= 0 && partners[std::size_t(k.second)] != kMeetsSeveral);
}

} // namespace

IslandContact touchOnSlope(const WorldState& world, const FallingRock& member, Contact& c, double h)
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
  k.restitution = world.surface.restitutionAt(sim.touchAt(c.cfe, c.point));
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
  if (c.closed() && sim.impactUnderWay())
  {
    k.reboundSpeed = bounceLeft(c, approach); // begun where impacts are resolved in time
  }
  else if (hits(c, approach, sim.body().restingSpeed, h))
  {
    k.reboundSpeed = k.restitutionAt(approach) * approach;
  }
  k.approach = approach;
  return k;
}

IslandContact touchOfPair(const WorldState& world, RockPair& pair, const PairMotion& motion,
  Contact& c, double h, const IslandWork& work)
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
  k.approach = -c.normal.dot(motion.at(c.point));
  const bool impacts = hits(c, k.approach, resting, h);
  if (impacts)
  {
    k.reboundSpeed = pair.law.restitution * k.approach;
  }
  else if (c.closed() && pair.strikes &&
    pair.impact.time < world.rocks[pair.first].sim.body().state.time)
  {
    k.reboundSpeed = bounceLeft(c, k.approach); // as on the slope
  }
  // For the events: what strikes one of two that touch strikes the other through it.
  const bool crowd = work.solver.method == IslandMethod::Crowd;
  if (crowd && (impacts || (c.closed() && k.approach > resting)))
  {
    beginPairImpact(pair, world.rocks[pair.first].sim.body().state,
      world.rocks[pair.second].sim.body().state, c.point);
  }
  if (pair.strikes)
  {
    pair.impact.approach = std::max(pair.impact.approach, k.approach);
  }
  return k;
}

void settleBounces(IslandWork& work)
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
      to += c.reboundSpeed >= 0.0 || c.closed;
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
    if (k.reboundSpeed < 0.0)
    {
      return;
    }
    k.reboundSpeed = mayBounce(work.partners, k) ? k.reboundSpeed : -1.0;
    if (k.reboundSpeed < 0.0)
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

void appendTouch(IslandContact touch, bool crowd, IslandWork& work)
{
  if (crowd)
  {
    meet(work.partners, touch);
    touch.reboundSpeed = mayBounce(work.partners, touch) ? touch.reboundSpeed : -1.0;
  }
  work.contacts.push_back(touch);
}

} // namespace rockfall
