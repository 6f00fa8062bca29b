// One group of rocks that touch each other, over one step of Δt.

#include "contact/motion.h"
#include "simulation/MassFall.h"
#include "simulation/restitution.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// However fast two rocks meet, their contact is stiff enough to stop them in this part of the
/// smaller radius.
constexpr double kDeepestImpact = 0.1;
/// Steps per half period of an impact, as for single rocks.
constexpr double kStepsPerImpact = 8.0;
constexpr double kPressOut = 0.005;    // m/s, as for single rocks
constexpr double kPressOutDeep = 0.02; // m/s, of overlaps beyond the loose one
constexpr double kShearDamping = 5.0;  // as for single rocks
constexpr double kLooseOverlap = 1e-3; // of the radius, as for single rocks
constexpr double kTooShort = 1e-9;     // s

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

/// What a step of a group needs, kept by thread.
struct MassFall::Workspace
{
  GroupSolver solver;
  std::vector<GroupBody> bodies;
  std::vector<GroupContact> contacts;
  std::vector<double> energyBefore;
  std::vector<int> partners;
  std::vector<std::size_t> firsts; ///< First contact of each pair among `contacts`.
};

Vec3 MassFall::relativeVelocity(const RockPair& pair, const Vec3& point) const
{
  const auto at = [&](int i)
  {
    const BlockState& s = members_[i]->sim.state_;
    return Vec3(s.velocity + s.angularVelocity().cross(point - s.position));
  };
  return at(pair.first) - at(pair.second);
}

double MassFall::groupStep(const Group& group) const
{
  double h = parameters_.timeStep;
  for (int i : group.members)
  {
    const RockSimulator& sim = members_[i]->sim;
    h = sim.done_ ? h : std::min(h, sim.impactStep());
  }
  for (const RockPair* pair : group.pairs)
  {
    double sum = 0.0;
    for (const Contact& c : pair->contacts)
    {
      sum += c.frequency2;
    }
    const Block& a = members_[pair->first]->sim.block_;
    const Block& b = members_[pair->second]->sim.block_;
    const double all = parameters_.normalPenalty * (a.largestMobility() + b.largestMobility());
    h = std::min(h, std::numbers::pi / (kStepsPerImpact * std::sqrt(std::max(sum, all))));
  }
  return h;
}

void MassFall::gatherContacts(const Group& group, double h) const
{
  const auto reachOf = [&](double speed, double radius)
  { return 1.5 * speed * h + parameters_.gravity * h * h + 1e-6 * radius; };
  for (int i : group.members)
  {
    Member& m = *members_[i];
    RockSimulator& sim = m.sim;
    if (sim.done_)
    {
      continue;
    }
    sim.placed_.place(sim.block_, sim.state_);
    m.body.update(sim.placed_);
    const double r = sim.block_.radius();
    const double reach = reachOf(sim.state_.velocity.norm() + sim.state_.spin.norm() * r, r);
    sim.ensureCandidates(reach);
    updateContacts(sim.placed_, sim.patch_, sim.candidates_, reach, sim.contacts_);
    while (sim.solid_ && sim.breakTrees(h))
    {
      sim.ensureCandidates(reach);
      updateContacts(sim.placed_, sim.patch_, sim.candidates_, reach, sim.contacts_);
    }
    double pressed = 0.0;
    for (const Contact& c : sim.contacts_)
    {
      pressed = std::max(pressed, -c.distance);
    }
    holdOverlap(
      sim.placed_, sim.patch_, sim.candidates_, kLooseOverlap * r + 2.0 * pressed, sim.contacts_);
    sim.armContacts();
  }
  for (RockPair* pair : group.pairs)
  {
    const Member &a = *members_[pair->first], &b = *members_[pair->second];
    if (a.sim.done_ || b.sim.done_)
    {
      pair->contacts.clear();
      pair->axis.distance = std::max(0.0, pair->axis.distance);
      continue;
    }
    const BlockState &s = a.sim.state_, &t = b.sim.state_;
    const double ra = a.sim.block_.radius(), rb = b.sim.block_.radius();
    const double speed = (s.velocity - t.velocity).norm() + s.spin.norm() * ra + t.spin.norm() * rb;
    updatePair(a.body, b.body, reachOf(speed, std::min(ra, rb)), *pair);
    this->armPair(*pair);
  }
}

void MassFall::armPair(RockPair& pair) const
{
  const RockSimulator &a = members_[pair.first]->sim, &b = members_[pair.second]->sim;
  const double mass = 1.0 / (1.0 / a.block_.mass() + 1.0 / b.block_.mass());
  const double depth = kDeepestImpact * std::min(a.block_.radius(), b.block_.radius());
  for (Contact& c : pair.contacts)
  {
    if (c.closed())
    {
      continue;
    }
    const double speed = (a.state_.velocity - b.state_.velocity).norm();
    const double penalty =
      std::max(parameters_.normalPenalty, mass * speed * speed / (depth * depth));
    const double shear = penalty * parameters_.shearRatio;
    double soft = 0.0, softAlong = 0.0, mobile = 0.0, mobileAlong = 0.0;
    const Vec3 along = c.normal.unitOrthogonal();
    for (const RockSimulator* rock : { &a, &b })
    {
      const Mat3& r = rock->placed_.rotation();
      const Vec3 x = r.transpose() * (c.point - rock->state_.position);
      const Vec3 n = r.transpose() * c.normal, t = r.transpose() * along;
      soft += parameters_.rigid ? 0.0 : rock->block_.compliance(n, x);
      softAlong += parameters_.rigid ? 0.0 : rock->block_.compliance(t, x);
      mobile += rock->block_.mobility(n, x);
      mobileAlong += rock->block_.mobility(t, x);
    }
    c.stiffness = penalty / (1.0 + penalty * soft);
    c.shearStiffness = shear / (1.0 + shear * softAlong);
    c.frequency2 = c.stiffness * mobile;
    c.dashpot = dampingRatio_ > 0.0 ? 2.0 * dampingRatio_ * std::sqrt(c.stiffness / mobile) : 0.0;
    c.shearDashpot = 2.0 * kShearDamping * std::sqrt(c.shearStiffness / mobileAlong);
  }
}

bool MassFall::isCalm(const Group& group) const
{
  for (int i : group.members)
  {
    const RockSimulator& sim = members_[i]->sim;
    if (!sim.done_ && !sim.isCalm())
    {
      return false;
    }
  }
  for (const RockPair* pair : group.pairs)
  {
    const RockSimulator &a = members_[pair->first]->sim, &b = members_[pair->second]->sim;
    const double resting = std::min(a.restingSpeed_, b.restingSpeed_);
    const double mass = 1.0 / (1.0 / a.block_.mass() + 1.0 / b.block_.mass());
    double held = 0.0;
    for (const Contact& c : pair->contacts)
    {
      if (!c.closed())
      {
        continue;
      }
      if (std::abs(c.normal.dot(this->relativeVelocity(*pair, c.point))) > resting)
      {
        return false;
      }
      // Beyond what the weights of a pile can hold, it is the turning point of an impact.
      const double weight =
        double(group.members.size()) * parameters_.gravity * (a.block_.mass() + b.block_.mass());
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

bool MassFall::mayLast(const Group& group, double h) const
{
  // Whatever is about to close must not come in as an impact.
  const auto impact = [&](const Contact& c, const Vec3& velocity, double resting)
  {
    const double approach = -c.normal.dot(velocity);
    return !c.closed() && approach > resting && c.gap() < approach * h;
  };
  for (int i : group.members)
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
  for (const RockPair* pair : group.pairs)
  {
    const double resting =
      std::min(members_[pair->first]->sim.restingSpeed_, members_[pair->second]->sim.restingSpeed_);
    for (const Contact& c : pair->contacts)
    {
      if (impact(c, this->relativeVelocity(*pair, c.point), resting))
      {
        return false;
      }
    }
  }
  return true;
}

double MassFall::freeTime(const Group& group, double most) const
{
  double free = most;
  for (int i : group.members)
  {
    const RockSimulator& sim = members_[i]->sim;
    if (sim.done_)
    {
      continue;
    }
    const double room = sim.candidates_.room(sim.state_, sim.block_.radius(), 0.0);
    const double rim = sim.block_.largestRimSpeed(sim.state_.spin);
    free = std::min(free, timeToCover(room, sim.state_.velocity.norm() + rim, parameters_.gravity));
    free =
      timeToClose(sim.placed_, sim.state_, sim.patch_, sim.candidates_, parameters_.gravity, free);
  }
  for (const RockPair* pair : group.pairs)
  {
    const RockSimulator &a = members_[pair->first]->sim, &b = members_[pair->second]->sim;
    if (a.done_ || b.done_)
    {
      continue;
    }
    // Both fall alike; along the axis that tells them apart they come no nearer than this.
    const double closing = -pair->axis.normal.dot(a.state_.velocity - b.state_.velocity) +
      a.block_.largestRimSpeed(a.state_.spin) + b.block_.largestRimSpeed(b.state_.spin);
    free = std::min(free, timeToCover(pair->axis.distance, closing, 0.0));
  }
  return free;
}

void MassFall::fly(const Group& group, double duration) const
{
  for (int i : group.members)
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
  for (RockPair* pair : group.pairs)
  {
    pair->contacts.clear();
    pair->touched = false;
    this->finishPairImpact(*pair);
  }
}

void MassFall::advanceGroup(const Group& group, double until) const
{
  thread_local Workspace work;
  work.solver.method = method;
  for (int i : group.members)
  {
    RockSimulator& sim = members_[i]->sim;
    if (!sim.inContact_)
    {
      sim.beginContact();
    }
  }
  const bool inTime = int(group.members.size()) <= resolved;
  const auto now = [&]
  {
    for (int i : group.members)
    {
      if (!members_[i]->sim.done_)
      {
        return members_[i]->sim.state_.time;
      }
    }
    return until;
  };
  while (now() < until - kTooShort)
  {
    double travel = parameters_.timeStep;
    for (int i : group.members)
    {
      const RockSimulator& sim = members_[i]->sim;
      travel = sim.done_ ? travel : std::min(travel, sim.travelLimit());
    }
    const double remaining = until - now();
    const double large = std::min(remaining, travel);
    const double small = inTime ? std::min(remaining, this->groupStep(group)) : large;
    const bool calm = this->isCalm(group);
    this->gatherContacts(group, calm || !inTime ? large : small);
    bool any = false;
    for (int i : group.members)
    {
      const std::vector<Contact>& c = members_[i]->sim.contacts_;
      any = any || std::any_of(c.begin(), c.end(), [](const Contact& k) { return k.closed(); });
    }
    for (const RockPair* pair : group.pairs)
    {
      const std::vector<Contact>& c = pair->contacts;
      any = any || std::any_of(c.begin(), c.end(), [](const Contact& k) { return k.closed(); });
    }
    if (!any)
    {
      const double free = this->freeTime(group, remaining);
      if (free > small)
      {
        this->fly(group, free);
        continue;
      }
    }
    if (!inTime)
    {
      this->solve(group, large, StepKind::Lasting, true, work);
    }
    else if (calm && any && this->mayLast(group, large))
    {
      this->solve(group, large, StepKind::Lasting, false, work);
    }
    else
    {
      this->solve(group, small, StepKind::Impact, false, work);
    }
  }
  for (int i : group.members)
  {
    Member& m = *members_[i];
    m.sim.horizon_ = until;
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
      k.friction = std::tan(parameters_.rockFrictionAngle);
      k.cohesion = parameters_.rockCohesion;
      k.bounce = bounceOf(c, approach, resting, parameters_.rockRestitution);
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
    event.restitution = parameters_.rockRestitution;
    event.otherRock = other;
    event.otherBlockId = members_[other]->sim.rock_.blockId;
    Trajectory& trajectory = sim.recorder_.trajectory();
    trajectory.impacts.push_back(event);
    ++trajectory.summary.impacts;
  }
}

} // namespace rockfall
