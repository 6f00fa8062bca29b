// One step of a group: contacts into the system, and back what comes of it.

#include "simulation/massFallWork.h"

#include "simulation/restitution.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

constexpr double kPressOut = 0.005;    // m/s, as for single rocks
constexpr double kPressOutDeep = 0.02; // m/s, of overlaps beyond the loose one
constexpr double kLooseOverlap = 1e-3; // of the radius, as for single rocks

/// Newton's law of restitution asked of a rock by several others at once may make energy. It holds
/// for what meets one other only; rocks that are hit on several sides, or lie on something, come
/// to rest against each other.
void settleBounces(
  std::size_t bodies, std::vector<GroupContact>& contacts, std::vector<int>& partners)
{
  constexpr int none = -3, several = -2; // else the other body, −1 the slope
  partners.assign(bodies, none);
  const auto meet = [&](int body, int other)
  {
    if (body >= 0)
    {
      int& partner = partners[body];
      partner = partner == none || partner == other ? other : several;
    }
  };
  for (const GroupContact& k : contacts)
  {
    if (k.bounce >= 0.0 || k.contact->closed())
    {
      meet(k.first, k.second);
      meet(k.second, k.first);
    }
  }
  for (GroupContact& k : contacts)
  {
    const bool alone =
      partners[k.first] != several || (k.second >= 0 && partners[k.second] != several);
    k.bounce = alone ? k.bounce : -1.0;
  }
}

} // namespace

void MassFall::solve(
  const Group& group, double h, StepKind kind, bool bounces, Workspace& work) const
{
  const bool lasting = kind == StepKind::Lasting;
  StepRequest request;
  request.duration = h;
  request.kind = kind;
  request.gravity = parameters_.gravity;
  request.maxOpenClose = parameters_.maxOpenClose;
  work.bodies.clear();
  work.contacts.clear();
  work.firsts.clear();
  work.energyBefore.clear();
  for (int i : group.members)
  {
    RockSimulator& sim = members_[i]->sim;
    members_[i]->place = sim.done_ ? -1 : int(work.bodies.size());
    if (sim.done_)
    {
      continue;
    }
    sim.before_ = sim.state_;
    sim.contactsBefore_ = sim.contacts_;
    work.energyBefore.push_back(sim.mechanicalEnergy() + sim.springEnergy_);
    GroupBody body;
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
    work.bodies.push_back(body);
  }
  const auto bounceOf = [&](const Contact& c, double approach, double resting, double e)
  {
    const bool hits = bounces && !c.closed() && approach > resting && c.gap() < approach * h;
    return hits ? e * approach : -1.0;
  };
  for (int i : group.members)
  {
    RockSimulator& sim = members_[i]->sim;
    if (sim.done_)
    {
      continue;
    }
    const Vec3 spin = sim.state_.angularVelocity();
    for (Contact& c : sim.contacts_)
    {
      const double approach =
        -c.normal.dot(sim.state_.velocity + spin.cross(c.point - sim.state_.position));
      const bool down =
        comesDown(approach, sim.state_.velocity.norm(), parameters_.gravity, sim.block_.radius());
      const int ground = surface_.restitutionClass(c.cfe);
      const SurfaceMaterial& material = surface_.terrain().restitutionMaterial(ground);
      double e = surface_.restitutionOf(ground);
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
      k.first = members_[i]->place;
      k.friction = c.friction;
      k.cohesion = c.cohesion;
      k.bounce = bounceOf(c, approach, sim.restingSpeed_, e);
      k.approach = approach;
      work.contacts.push_back(k);
    }
  }
  for (RockPair* pair : group.pairs)
  {
    work.firsts.push_back(work.contacts.size());
    const double resting =
      std::min(members_[pair->first]->sim.restingSpeed_, members_[pair->second]->sim.restingSpeed_);
    for (Contact& c : pair->contacts)
    {
      const double approach = -c.normal.dot(this->relativeVelocity(*pair, c.point));
      GroupContact k;
      k.contact = &c;
      k.first = members_[pair->first]->place;
      k.second = members_[pair->second]->place;
      k.friction = pair->law.friction;
      k.cohesion = pair->law.cohesion;
      k.bounce = bounceOf(c, approach, resting, pair->law.restitution);
      k.approach = approach;
      work.contacts.push_back(k);
    }
  }
  work.firsts.push_back(work.contacts.size());
  if (bounces)
  {
    settleBounces(work.bodies.size(), work.contacts, work.partners);
  }
  for (const GroupContact& k : work.contacts)
  {
    // What bounces has no acceleration to go on with.
    for (int b : { k.first, k.second })
    {
      if (lasting && k.bounce >= 0.0 && b >= 0)
      {
        work.bodies[b].acceleration.setZero();
        work.bodies[b].spinAcceleration.setZero();
      }
    }
  }
  // Approach speeds at the start, for the events.
  for (RockPair* pair : group.pairs)
  {
    for (const Contact& c : pair->contacts)
    {
      const double approach = -c.normal.dot(this->relativeVelocity(*pair, c.point));
      RockPair::Impact& impact = pair->impact;
      const double resting = std::min(
        members_[pair->first]->sim.restingSpeed_, members_[pair->second]->sim.restingSpeed_);
      if (!c.closed() && approach > resting && c.gap() < approach * h && !impact.pending)
      {
        impact = {};
        impact.pending = true;
        impact.time = members_[pair->first]->sim.state_.time;
        impact.before[0] = members_[pair->first]->sim.state_.velocity;
        impact.before[1] = members_[pair->second]->sim.state_.velocity;
        impact.point = c.point;
      }
      if (impact.pending && !c.closed())
      {
        impact.approach = std::max(impact.approach, approach);
      }
    }
  }
  GroupOutcome outcome;
  for (int cut = 0;; ++cut)
  {
    // A large group is not stepped again: what is left to settle is counted and small.
    const bool last = !(int(group.members.size()) <= resolved) || cut >= parameters_.maxCuts;
    outcome = work.solver.step(request, work.bodies, work.contacts, last);
    for (int i : group.members)
    {
      TrajectorySummary& summary = members_[i]->sim.recorder_.trajectory().summary;
      summary.openCloseIterations += members_[i]->sim.done_ ? 0 : outcome.iterations;
      summary.contactSteps += members_[i]->sim.done_ ? 0 : 1;
      summary.cutSteps += !outcome.settled && !last && !members_[i]->sim.done_;
      summary.unsettledSteps += !outcome.settled && last && !members_[i]->sim.done_;
    }
    if (outcome.settled || last)
    {
      break;
    }
    request.duration *= 0.5;
  }
  const GroupBody& one = work.bodies.front();
  const double start = members_[group.members.front()]->sim.before_.time;
  if (one.state->time <= start && !members_[group.members.front()]->sim.done_)
  {
    // Not even a finite displacement: the contacts are let go for this step.
    this->fly(group, request.duration);
    return;
  }
  this->absorb(group, request.duration, kind, work);
}

void MassFall::absorb(const Group& group, double h, StepKind kind, Workspace& work) const
{
  for (int i : group.members)
  {
    members_[i]->touchesOthers = false;
  }
  std::vector<std::uint64_t> carriers(work.bodies.size(), 0);
  for (std::size_t p = 0; p < group.pairs.size(); ++p)
  {
    RockPair& pair = *group.pairs[p];
    pair.touched = false;
    for (std::size_t k = work.firsts[p]; k < work.firsts[p + 1]; ++k)
    {
      const Contact& c = *work.contacts[k].contact;
      RockPair::Impact& impact = pair.impact;
      if (impact.pending && c.normalForce > 0.0)
      {
        impact.impulse += (h * c.normalForce) * c.normal;
        if (c.normalForce > impact.largest)
        {
          impact.largest = c.normalForce;
          impact.point = c.point;
        }
      }
      if (impact.pending)
      {
        impact.loss += work.contacts[k].work;
      }
      pair.touched = pair.touched || c.closed();
      if (c.closed())
      {
        const std::uint64_t key =
          (std::uint64_t(c.rockFeature + 1000) * 4 + std::uint64_t(c.kind) + 1) *
          0x9e3779b97f4a7c15ull;
        carriers[work.contacts[k].first] += key * std::uint64_t(pair.second + 2);
        carriers[work.contacts[k].second] += key * std::uint64_t(pair.first + 2);
      }
    }
    if (pair.touched)
    {
      members_[pair.first]->touchesOthers = members_[pair.second]->touchesOthers = true;
      // What was found overlapping is pressed out slowly.
      const double mass =
        std::min(members_[pair.first]->sim.block_.mass(), members_[pair.second]->sim.block_.mass());
      const double slow =
        std::min(kPressOut * h, 0.5 * mass * parameters_.gravity / parameters_.normalPenalty);
      const double loose = kLooseOverlap *
        std::min(
          members_[pair.first]->sim.block_.radius(), members_[pair.second]->sim.block_.radius());
      for (Contact& c : pair.contacts)
      {
        const bool deep = kind == StepKind::Lasting && c.offset < -loose;
        const double way = deep ? kPressOutDeep * h : slow;
        c.offset = c.offset < 0.0 ? std::min(0.0, c.offset + way) : std::max(0.0, c.offset - way);
      }
    }
    if (pair.impact.pending && (!pair.touched || kind == StepKind::Lasting))
    {
      this->finishPairImpact(pair);
    }
  }
  for (int i : group.members)
  {
    Member& m = *members_[i];
    if (m.sim.done_)
    {
      continue;
    }
    const int b = members_[i]->place;
    const GroupBody& body = work.bodies[b];
    StepOutcome outcome;
    outcome.frictionWork = body.frictionWork;
    outcome.dampedWork = body.dampedWork;
    outcome.springEnergy = body.springEnergy;
    outcome.normalEnergy = body.normalEnergy;
    m.sim.absorb(kind, outcome, work.energyBefore[b], body.given);
    if (carriers[b] != m.carriers)
    {
      m.sim.acceleration_.setZero();
      m.sim.spinAcceleration_.setZero();
      m.carriers = carriers[b];
    }
    if (m.sim.done_)
    {
      continue; // caught
    }
    m.sim.checkLeft();
    const std::vector<Contact>& c = m.sim.contacts_;
    m.sim.followRest(h,
      m.touchesOthers ||
        std::any_of(c.begin(), c.end(), [](const Contact& k) { return k.closed(); }));
    if (!m.sim.done_ && m.sim.state_.time >= parameters_.endTime - kTooShort)
    {
      m.sim.recorder_.trajectory().summary.fate = Fate::Moving;
      m.sim.done_ = true;
    }
  }
}

void MassFall::finishPairImpact(RockPair& pair) const
{
  RockPair::Impact& impact = pair.impact;
  if (!impact.pending)
  {
    return;
  }
  impact.pending = false;
  const double size = impact.impulse.norm();
  if (size <= 0.0)
  {
    return;
  }
  for (int side = 0; side < 2; ++side)
  {
    const int own = side == 0 ? pair.first : pair.second;
    const int other = side == 0 ? pair.second : pair.first;
    RockSimulator& sim = members_[own]->sim;
    ImpactEvent event;
    event.time = impact.time;
    event.position = impact.point;
    event.normal = (side == 0 ? 1.0 : -1.0) / size * impact.impulse;
    event.cfe = 0;
    event.impulse = size;
    event.approachSpeed = impact.approach;
    event.velocityBefore = impact.before[side];
    event.velocityAfter = sim.state_.velocity;
    event.energyLoss = std::max(0.0, impact.loss);
    event.restitution = pair.law.restitution;
    event.otherRock = other;
    event.otherBlockId = members_[other]->sim.rock_.blockId;
    Trajectory& trajectory = sim.recorder_.trajectory();
    trajectory.impacts.push_back(event);
    ++trajectory.summary.impacts;
  }
}

} // namespace rockfall
