// A step of an island: contacts into the system. Results back: massFallApply.cxx.

#include "simulation/massFallWork.h"

#include "base/parallel.h"
#include "contact/motion.h"
#include "law/cohesion.h"
#include "law/settings.h"
#include "simulation/pressOut.h"
#include "simulation/restitution.h"

#include <algorithm>

namespace rockfall
{

IslandContact MassFall::islandContact(
  const Member& member, Contact& c, double h, bool bounces) const
{
  const RockSimulator& sim = member.sim;
  const BlockState& state = sim.body().state;
  const Vec3 lever = c.point - state.position;
  const double approach = -c.normal.dot(state.velocity + state.angularVelocity().cross(lever));
  const bool down =
    comesDown(approach, state.velocity.norm(), parameters_.gravity, sim.body().block.radius());
  const int ground = surface_.restitutionClass(c.cfe);
  const SurfaceMaterial& material = surface_.terrain().restitutionMaterial(ground);
  double e = surface_.restitutionAt(sim.touchAt(c.cfe, c.point));
  if (material.restitutionModel == RestitutionModel::Velocity && down)
  {
    e = 1.0; // Rv is taken off the whole velocity when the impact is over
  }
  else if (material.restitutionModel == RestitutionModel::SpeedDependent)
  {
    e = restitutionAtSpeed(e, approach, material.restitutionSpeed);
  }
  IslandContact k;
  k.contact = &c;
  k.closed = c.closed();
  k.first = member.place;
  k.friction = c.friction;
  k.cohesion = c.cohesion;
  if (bounces && c.closed() && sim.impactUnderWay())
  {
    k.bounce = bounceLeft(c, approach); // begun where impacts are resolved in time
  }
  else if (bounces && hits(c, approach, sim.body().restingSpeed, h))
  {
    k.bounce = e * approach;
  }
  k.approach = approach;
  return k;
}

IslandContact MassFall::islandContact(RockPair& pair, const PairMotion& motion, Contact& c,
  double h, bool bounces, const Workspace& work)
{
  const double resting = std::min(
    work.sides[std::size_t(pair.first)].resting, work.sides[std::size_t(pair.second)].resting);
  IslandContact k;
  k.contact = &c;
  k.closed = c.closed();
  k.first = work.placeOf[std::size_t(pair.first)];
  k.second = work.placeOf[std::size_t(pair.second)];
  k.friction = pair.law.friction;
  k.cohesion = pair.law.cohesion;
  if (k.cohesion > 0.0)
  {
    k.cohesion = sharedCohesion(k.cohesion, closedCount(pair.contacts));
  }
  k.approach = -c.normal.dot(motion.at(c.point));
  const bool impacts = hits(c, k.approach, resting, h);
  if (bounces && impacts)
  {
    k.bounce = pair.law.restitution * k.approach;
  }
  else if (bounces && c.closed() && pair.strikes &&
    pair.impact.time < members_[pair.first]->sim.body().state.time)
  {
    k.bounce = bounceLeft(c, k.approach); // as on the slope
  }
  // For the events: what strikes one of two that touch strikes the other through it.
  if (impacts || (c.closed() && k.approach > resting))
  {
    this->beginPairImpact(pair, members_[pair.first]->sim.body().state,
      members_[pair.second]->sim.body().state, c.point);
  }
  if (pair.strikes)
  {
    pair.impact.approach = std::max(pair.impact.approach, k.approach);
  }
  return k;
}

void MassFall::pressOutDeep(RockPair& pair, double h, bool crowd, const Workspace& work)
{
  const double smaller = std::min(
    work.sides[std::size_t(pair.first)].radius, work.sides[std::size_t(pair.second)].radius);
  const double speed = deepSpeed(parameters_.gravity, smaller);
  for (Contact& c : pair.contacts)
  {
    rockfall::pressOutDeep(c, crowd ? speed * h : gentleWay(c, h, speed), kLooseOverlap * smaller);
  }
}

void MassFall::solve(const Island& island, double h, StepKind kind, bool bounces, Workspace& work)
{
  const bool lasting = kind == StepKind::Lasting;
  StepRequest request;
  request.duration = h;
  request.kind = kind;
  request.gravity = parameters_.gravity;
  request.maxOpenClose = parameters_.maxOpenClose;
  // Places first, then each rock and each pair for itself.
  if (this->layOut(island, work) == 0)
  {
    return; // the last of them was caught just now
  }
  const auto addRock = [&](std::size_t m)
  {
    this->comeToRock(island, m);
    Member& member = *members_[island.members[m]];
    RockSimulator& sim = member.sim;
    if (sim.body().done)
    {
      return;
    }
    sim.body().before = sim.body().state;
    sim.body().springEnergyBefore = sim.body().springEnergy;
    sim.body().contactsBefore = sim.body().contacts;
    work.energyBefore[member.place] = sim.mechanicalEnergy() + sim.body().springEnergy;
    if (lasting)
    {
      sim.pressOutDeep(h, !island.crowd);
    }
    IslandBody& body = work.bodies[member.place];
    body = {};
    body.block = &sim.body().block;
    body.state = &sim.body().state;
    if (sim.body().steppedAs == kind)
    {
      body.acceleration = sim.body().acceleration;
      body.spinAcceleration = sim.body().spinAcceleration;
    }
    else if (!lasting)
    {
      body.acceleration.z() = -parameters_.gravity;
    }
    std::size_t next = work.slopeFirsts[m];
    for (Contact& c : sim.body().contacts)
    {
      work.contacts[next++] = this->islandContact(member, c, h, bounces);
    }
  };
  forEach(island.members.size(), kRockGrain, addRock);
  const bool crowd = island.crowd, swept = work.solver.isSwept(kind, work.bodies.size());
  const auto addPair = [&](std::size_t t)
  {
    work.comeToTouching(island, t);
    const std::size_t p = work.touching[t];
    RockPair& pair = *island.pairs[p];
    if (pair.contacts.empty())
    {
      return;
    }
    const PairMotion motion = work.motionOf(pair);
    if (lasting)
    {
      this->pressOutDeep(pair, h, crowd, work);
    }
    std::size_t next = work.firsts[p];
    for (Contact& c : pair.contacts)
    {
      const IslandContact& touch = work.contacts[next++] =
        this->islandContact(pair, motion, c, h, bounces, work);
      if (crowd && !touch.closed && !(swept && mayStayOpen(touch, h)))
      {
        this->setSprings(pair, c);
      }
    }
  };
  forEach(work.touching.size(), kPairGrain, addPair);
  if (bounces)
  {
    this->settleBounces(lasting, work);
  }
  work.added.clear();
  work.addedTo.clear();
  work.stems.clear();
  const auto setSpringsLate = [&](std::size_t k)
  {
    const auto behind = std::upper_bound(work.firsts.begin(), work.firsts.end(), k);
    if (crowd && behind != work.firsts.begin() && behind != work.firsts.end())
    {
      const RockPair& pair = *island.pairs[std::size_t(behind - work.firsts.begin()) - 1];
      this->setSprings(pair, *work.contacts[k].contact);
    }
  };
  work.solver.setSpringsLate(setSpringsLate);
  const auto look = [&] { return this->lookAgain(island, request.duration, bounces, work); };
  IslandOutcome outcome;
  work.iterations = work.cuts = work.unsettled = work.tries = 0;
  for (int cut = 0;; ++cut)
  {
    // A large island leaves little to settle; if it leaves more, a shorter step is taken.
    const bool last = cut >= (crowd ? kCrowdCuts : parameters_.maxCuts);
    const Accept accept = last ? Accept::Any : crowd ? Accept::Converging : Accept::Settled;
    if (!work.added.empty())
    {
      work.contacts.resize(work.firsts.back());
      work.added.clear();
      work.addedTo.clear();
    }
    this->standTrees(island, work);
    work.looked = false;
    outcome = work.solver.step(request, work.bodies, work.contacts, accept, look);
    work.iterations += outcome.iterations;
    work.cuts += !outcome.accepted && !last;
    work.unsettled += outcome.unconverged && (outcome.accepted || last);
    ++work.tries;
    if (outcome.accepted || last)
    {
      break;
    }
    request.duration *= 0.5;
  }
  work.solver.setSpringsLate({}); // it knows this step only
  const IslandBody& one = work.bodies.front();
  const double start = members_[island.members.front()]->sim.body().before.time;
  if (one.state->time <= start && !members_[island.members.front()]->sim.body().done)
  {
    // Not even a finite displacement: the contacts are let go for this step.
    for (int i : island.members)
    {
      work.count(members_[i]->sim);
    }
    this->fly(island, request.duration);
    return;
  }
  this->applyStep(island, request.duration, kind, work);
}

} // namespace rockfall
