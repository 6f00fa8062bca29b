// One step of a group: contacts into the system. Back what comes of it: massFallAbsorb.cxx.

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

GroupContact MassFall::take(const Member& member, Contact& c, double h, bool bounces) const
{
  const RockSimulator& sim = member.sim;
  const BlockState& state = sim.state_;
  const Vec3 lever = c.point - state.position;
  const double approach = -c.normal.dot(state.velocity + state.angularVelocity().cross(lever));
  const bool down =
    comesDown(approach, state.velocity.norm(), parameters_.gravity, sim.block_.radius());
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
  GroupContact k;
  k.contact = &c;
  k.closed = c.closed();
  k.first = member.place;
  k.friction = c.friction;
  k.cohesion = c.cohesion;
  if (bounces && c.closed() && sim.impact_.pending)
  {
    k.bounce = bounceLeft(c, approach); // begun where impacts are resolved in time
  }
  else if (bounces && hits(c, approach, sim.restingSpeed_, h))
  {
    k.bounce = e * approach;
  }
  k.approach = approach;
  return k;
}

GroupContact MassFall::take(RockPair& pair, const PairMotion& motion, Contact& c, double h,
  bool bounces, const Workspace& work) const
{
  const double resting = std::min(
    work.sides[std::size_t(pair.first)].resting, work.sides[std::size_t(pair.second)].resting);
  GroupContact k;
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
    pair.impact.time < members_[pair.first]->sim.state_.time)
  {
    k.bounce = bounceLeft(c, k.approach); // as on the slope
  }
  // For the events: what strikes one of two that touch strikes the other through it.
  if (impacts || (c.closed() && k.approach > resting))
  {
    this->beginPairImpact(
      pair, members_[pair.first]->sim.state_, members_[pair.second]->sim.state_, c.point);
  }
  if (pair.strikes)
  {
    pair.impact.approach = std::max(pair.impact.approach, k.approach);
  }
  return k;
}

void MassFall::pressOutDeep(RockPair& pair, double h, bool crowd, const Workspace& work) const
{
  const double smaller = std::min(
    work.sides[std::size_t(pair.first)].radius, work.sides[std::size_t(pair.second)].radius);
  const double speed = deepSpeed(parameters_.gravity, smaller);
  for (Contact& c : pair.contacts)
  {
    rockfall::pressOutDeep(c, crowd ? speed * h : gentleWay(c, h, speed), kLooseOverlap * smaller);
  }
}

void MassFall::solve(
  const Group& group, double h, StepKind kind, bool bounces, Workspace& work) const
{
  const bool lasting = kind == StepKind::Lasting;
  StepRequest request;
  request.duration = h;
  request.kind = kind;
  request.gravity = parameters_.gravity;
  request.maxOpenClose = parameters_.maxOpenClose;
  // Places first, then each rock and each pair for itself.
  if (this->layOut(group, work) == 0)
  {
    return; // the last of them was caught just now
  }
  const auto takeRock = [&](std::size_t m)
  {
    this->comeToRock(group, m);
    Member& member = *members_[group.members[m]];
    RockSimulator& sim = member.sim;
    if (sim.done_)
    {
      return;
    }
    sim.before_ = sim.state_;
    sim.springEnergyBefore_ = sim.springEnergy_;
    sim.contactsBefore_ = sim.contacts_;
    work.energyBefore[member.place] = sim.mechanicalEnergy() + sim.springEnergy_;
    if (lasting)
    {
      sim.pressOutDeep(h, !group.crowd);
    }
    GroupBody& body = work.bodies[member.place];
    body = {};
    body.block = &sim.block_;
    body.state = &sim.state_;
    if (sim.steppedAs_ == kind)
    {
      body.acceleration = sim.acceleration_;
      body.spinAcceleration = sim.spinAcceleration_;
    }
    else if (!lasting)
    {
      body.acceleration.z() = -parameters_.gravity;
    }
    std::size_t next = work.slopeFirsts[m];
    for (Contact& c : sim.contacts_)
    {
      work.contacts[next++] = this->take(member, c, h, bounces);
    }
  };
  forEach(group.members.size(), kRockGrain, takeRock);
  const bool crowd = group.crowd, swept = work.solver.isSwept(kind, work.bodies.size());
  const auto takePair = [&](std::size_t t)
  {
    work.comeToTouching(group, t);
    const std::size_t p = work.touching[t];
    RockPair& pair = *group.pairs[p];
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
      const GroupContact& taken = work.contacts[next++] =
        this->take(pair, motion, c, h, bounces, work);
      if (crowd && !taken.closed && !(swept && mayStayOpen(taken, h)))
      {
        this->armContact(pair, c);
      }
    }
  };
  forEach(work.touching.size(), kPairGrain, takePair);
  if (bounces)
  {
    this->settleBounces(lasting, work);
  }
  work.added.clear();
  work.addedTo.clear();
  work.stems.clear();
  const auto armLate = [&](std::size_t k)
  {
    const auto behind = std::upper_bound(work.firsts.begin(), work.firsts.end(), k);
    if (crowd && behind != work.firsts.begin() && behind != work.firsts.end())
    {
      const RockPair& pair = *group.pairs[std::size_t(behind - work.firsts.begin()) - 1];
      this->armContact(pair, *work.contacts[k].contact);
    }
  };
  work.solver.armLate(armLate);
  const auto look = [&] { return this->lookAgain(group, request.duration, bounces, work); };
  GroupOutcome outcome;
  work.iterations = work.cuts = work.unsettled = work.tries = 0;
  for (int cut = 0;; ++cut)
  {
    // What a large group leaves to settle is small; if it is not, a shorter step is taken.
    const bool last = cut >= (crowd ? kCrowdCuts : parameters_.maxCuts);
    const Taken take = last ? Taken::Any : crowd ? Taken::NotRough : Taken::Settled;
    if (!work.added.empty())
    {
      work.contacts.resize(work.firsts.back());
      work.added.clear();
      work.addedTo.clear();
    }
    this->standTrees(group, work);
    work.looked = false;
    outcome = work.solver.step(request, work.bodies, work.contacts, take, look);
    work.iterations += outcome.iterations;
    work.cuts += !outcome.taken && !last;
    work.unsettled += outcome.rough && (outcome.taken || last);
    ++work.tries;
    if (outcome.taken || last)
    {
      break;
    }
    request.duration *= 0.5;
  }
  work.solver.armLate({}); // it knows this step only
  const GroupBody& one = work.bodies.front();
  const double start = members_[group.members.front()]->sim.before_.time;
  if (one.state->time <= start && !members_[group.members.front()]->sim.done_)
  {
    // Not even a finite displacement: the contacts are let go for this step.
    for (int i : group.members)
    {
      work.count(members_[i]->sim);
    }
    this->fly(group, request.duration);
    return;
  }
  this->absorb(group, request.duration, kind, work);
}

} // namespace rockfall
