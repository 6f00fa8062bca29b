// A rock in contact with the slope, from touch-down to take-off or rest: steps that resolve an impact
// (small, conserving) and steps that last (up to Δt, damped), each for what it is right for.

#include "rock/SingleRock.h"

#include "base/abort.h"
#include "block/flight.h"
#include "contact/ground/detection.h"
#include "contact/ground/motion.h"
#include "contact/ground/timeToTouch.h"
#include "contact/impactMode.h"
#include "law/cohesion.h"
#include "law/settings.h"
#include "rock/overlapRecovery.h"
#include "rock/restitution.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// The features of the rock that carry, as a number that any change changes.
std::uint64_t supportHash(const std::vector<Contact>& contacts)
{
  std::uint64_t sum = 0;
  for (const Contact& c : contacts)
  {
    if (c.closed())
    {
      const std::uint64_t feature = 4 * std::uint64_t(c.rockFeature) + std::uint64_t(c.kind) + 1;
      sum += feature * 0x9e3779b97f4a7c15ull;
    }
  }
  return sum;
}

} // namespace

bool SingleRock::mayLast(double h) const
{
  bool any = false;
  const Vec3 spin = body_.state.angularVelocity();
  for (const Contact& c : body_.contacts)
  {
    const Vec3 v = body_.state.velocity + spin.cross(c.point - body_.state.position);
    const double approach = -c.normal.dot(v);
    if (c.closed())
    {
      any = true;
      if (std::abs(approach) > body_.restingSpeed)
      {
        return false;
      }
    }
    else if (approach > body_.restingSpeed)
    {
      if (c.gap() < approach * h)
      {
        return false;
      }
    }
    else if (c.gap() <= 0.5 * parameters_.gravity * h * h && approach > -body_.restingSpeed)
    {
      any = true; // laid down, not thrown
    }
  }
  return any;
}

double SingleRock::settledSpeed() const
{
  return body_.restingSpeed + 4.0 * parameters_.gravity * std::sqrt(body_.block.mass() * softness_);
}

bool SingleRock::isCalm() const
{
  // At the turning point of an impact nothing moves either, but the springs hold its energy; at
  // rest they hold the weight's, ½ m v² with v = g √(m/p), several times that when the rock rolls.
  const double settled = this->settledSpeed();
  const double held = body_.normalEnergy + (stiff_ ? 0.0 : strainEnergy(body_.block, body_.state));
  if (held > 0.5 * body_.block.mass() * settled * settled)
  {
    return false;
  }
  const Vec3 spin = body_.state.angularVelocity();
  return std::all_of(body_.contacts.begin(), body_.contacts.end(),
    [&](const Contact& c)
    {
      const Vec3 v = body_.state.velocity + spin.cross(c.point - body_.state.position);
      return !c.closed() || std::abs(c.normal.dot(v)) <= body_.restingSpeed;
    });
}

bool SingleRock::flyFromContact(double small)
{
  if (!stiff_ && !(body_.state.strain.isZero(0.0) && body_.state.strainRate.isZero(0.0)))
  {
    // The rock has taken off, and what flies does not strain. How long it is free is asked of what
    // it is then.
    body_.energy.vibration += relaxStrain(body_.block, body_.state);
    this->finishImpact();
    return true;
  }
  // Free until a pair closes, or until others than the candidates might.
  const double gravity = parameters_.gravity;
  const double room = candidates_.room(body_.state, body_.block.radius(), 0.0);
  const double rim = body_.block.largestRimSpeed(body_.state.spin);
  const double served = std::min(
    timeToCover(room, body_.state.velocity.norm() + rim, gravity), horizon_ - body_.state.time);
  const double free = timeToClose(body_.placed, body_.state, patch_, candidates_, gravity, served);
  if (free >= served && served > small && !scar_.open())
  {
    body_.contacts.clear();
    if (!stiff_)
    {
      this->finishImpact();
    }
    freeUntil_ = body_.state.time + served;
    this->endContact();
    return true;
  }
  if (const double sure = std::min(free, served); sure > small)
  {
    body_.contacts.clear();
    this->advanceInFlight(sure);
    this->checkEnd(0.0);
    return true;
  }
  return false;
}

void SingleRock::guardPenetrations(const CandidatePairs& candidates)
{
  // A vertex that carries may be pressed in, and its neighbourhood with it; anything deeper slipped
  // through.
  double pressed = 0.0;
  for (const Contact& c : body_.contacts)
  {
    pressed = std::max(pressed, -c.gap());
  }
  guardPenetration(body_.placed, patch_, candidates,
    kLooseOverlap * body_.block.radius() + 2.0 * pressed, body_.contacts);
}

void SingleRock::stayInContact()
{
  const double r = body_.block.radius();
  while (inContact_ && !body_.done && !this->arrived())
  {
    stayWanted();
    // Two lengths of a step: one that resolves an impact, one as far as candidates serve.
    const double small = this->impactStep();
    const double large = std::min(parameters_.timeStep, this->travelLimit());
    body_.placed.move(body_.block, body_.state);
    if (scar_.open() && body_.contacts.empty() && this->flyOverScar(small))
    {
      continue;
    }
    const double speed = body_.state.velocity.norm() + body_.state.spin.norm() * r;
    const auto reachOf = [&](double h)
    { return kFasterApproach * speed * h + parameters_.gravity * h * h + 1e-6 * r; };
    // A long step is worth a look only when what carries is at rest along its normal.
    const bool calm = this->isCalm();
    const double reach = reachOf(calm ? large : small);
    // What may close within the step: a gap that is not among the contacts has no spring in it.
    this->ensureCandidates(reach);
    this->findContacts(candidates_, reach, calm ? large : 0.0);
    body_.springEnergy = springEnergyOf(body_.contacts); // what has gone shows as numerical

    // A long, damped step would swallow a rebound: it is taken only where nothing comes or goes.
    double h = std::min(large, horizon_ - body_.state.time);
    StepKind kind = StepKind::Lasting;
    bool lasts = calm && this->mayLast(h);
    if (impulses_ && calm && !lasts)
    {
      double first = 0.0;
      if (this->strikeSoon(std::min(small, h), first))
      {
        this->checkEnd(first);
        continue;
      }
      // Up to the impact what carries does so.
      const double until = 0.98 * first; // and a hair of a gap is left
      if (first > small && until < h && anyClosed(body_.contacts) && this->mayLast(until))
      {
        h = until;
        lasts = true;
      }
    }
    if (!lasts)
    {
      kind = StepKind::Impact;
      h = std::min(h, small);
      const double near = reachOf(h);
      std::erase_if(
        body_.contacts, [&](const Contact& c) { return !c.closed() && c.gap() > near; });
    }
    // What gives way first changes the ground under the step, which is then looked at anew.
    if ((structures_.solid() && this->breakTrees(h)) || (yields_ && this->followScar(h)))
    {
      continue;
    }
    // Hops have a closed form, and need no steps.
    if (kind == StepKind::Impact && !anyClosed(body_.contacts) && openTime_ >= ringing_ &&
      this->flyFromContact(small))
    {
      continue;
    }
    // What has slipped through between looks is held where it is, before springs are given out.
    this->guardPenetrations(candidates_);
    h = std::max(h, 1e-12);
    this->setNewSprings(h);
    // Springs that are pressed together swing faster than each by itself: a shorter step.
    if (kind == StepKind::Impact && body_.contacts.size() > 1)
    {
      const double touchdown = this->touchdownStep(h);
      if (touchdown < (1.0 - 1e-9) * h)
      {
        h = touchdown;
        this->setNewSprings(h);
      }
    }
    if (kind == StepKind::Lasting)
    {
      this->recoverDeepOverlap(h);
    }
    this->takeStep(h, kind);
    this->checkEnd(body_.state.time - body_.before.time);
  }
}

void SingleRock::findContacts(const CandidatePairs& candidates, double reach, double h)
{
  updateContacts(
    body_.placed, patch_, candidates, reach, body_.contacts, body_.state.spin.norm() * h);
}

double SingleRock::dampingRatioFor(int ground, double restitution)
{
  if (surface_.deviationPer(ground) != DeviationPer::Iteration)
  {
    if (restitution != dampedFor_)
    {
      dampedFor_ = restitution;
      damped_ = dampingRatio(restitution);
    }
    return damped_;
  }
  // Solved for when a rock meets the class for the first time.
  const auto number = std::size_t(ground);
  dampingRatios_.resize(std::max(dampingRatios_.size(), number + 1), -1.0);
  double& ratio = dampingRatios_[number];
  if (ratio < 0.0)
  {
    ratio = dampingRatio(restitution);
  }
  return ratio;
}

void SingleRock::setNewSprings(double h)
{
  // A rock that slides into something may be faster than when its contact began.
  penalty_ = std::max(penalty_, this->stoppingPenalty());
  for (Contact& c : body_.contacts)
  {
    this->setSprings(c);
  }
  if (const std::ptrdiff_t points = closedCount(body_.contacts); points > kCohesivePoints)
  {
    for (Contact& c : body_.contacts)
    {
      c.cohesion = sharedCohesion(c.cohesion, points);
    }
  }
  if (!body_.inIsland)
  {
    tuneDashpots(
      body_.contacts, h,
      [this, spin = body_.state.angularVelocity()](const Contact& c)
      { return -c.normal.dot(body_.state.velocity + spin.cross(c.point - body_.state.position)); },
      [this](const Vec3& force, const Vec3& moment, const Vec3& at)
      { return response(body_.placed, force, moment, at); });
  }
}

void SingleRock::setSprings(Contact& c)
{
  const GroundTouch touch = this->touchAt(c.cfe, c.point);
  const bool slips = yields_ && this->yieldingAt(c).slips();
  c.friction = slips ? this->yieldingAt(c).frictionAfter(slip_) * this->softnessAt(c)
                     : surface_.frictionAt(touch);
  c.cohesion = surface_.cohesionAt(c.cfe);
  if (c.closed())
  {
    return;
  }
  const Vec3 lever = c.point - body_.state.position;
  const Vec3 y = body_.placed.rotation().transpose() * lever;
  const Vec3 n = body_.placed.rotation().transpose() * c.normal;
  const Vec3 t = n.unitOrthogonal();
  const double shear = penalty_ * parameters_.shearRatio;
  const bool strains = stiff_ && !parameters_.rigid;
  c.stiffness = penalty_ / (1.0 + (strains ? penalty_ * body_.block.compliance(n, y) : 0.0));
  c.shearStiffness = shear / (1.0 + (strains ? shear * body_.block.compliance(t, y) : 0.0));
  const double speed = body_.state.velocity.norm();
  const double approach =
    -c.normal.dot(body_.state.velocity + body_.state.angularVelocity().cross(lever));
  const bool down = approach > body_.restingSpeed &&
    comesDown(approach, speed, parameters_.gravity, body_.block.radius());
  const int ground = surface_.restitutionClass(c.cfe);
  const double restitution = surface_.restitutionAt(touch);
  const double damped = contactDamping(surface_.terrain().restitutionMaterial(ground), restitution,
    this->dampingRatioFor(ground, restitution), approach, down);
  const double mobility = body_.block.mobility(n, y);
  c.frequency2 = c.stiffness * mobility;
  c.stopped = 1.0 / mobility;
  c.dashpot = damped > 0.0 ? 2.0 * damped * std::sqrt(c.stiffness / mobility) : 0.0;
  c.shearDashpot = 2.0 * kShearDamping * std::sqrt(c.shearStiffness / body_.block.mobility(t, y));
}

void SingleRock::takeStep(double h, StepKind kind)
{
  body_.before = body_.state;
  struckAtOnce_ = 0;
  body_.springEnergyBefore = body_.springEnergy;
  const bool lasting = kind == StepKind::Lasting;
  TrajectorySummary& summary = recorder_.trajectory().summary;
  StepRequest request;
  request.duration = h;
  request.kind = kind;
  request.gravity = parameters_.gravity;
  request.normalPenalty = penalty_;
  request.shearPenalty = penalty_ * parameters_.shearRatio;
  request.friction = surface_.friction();
  request.cohesion = surface_.cohesion();
  request.rigid = stiff_;
  request.maxOpenClose = parameters_.maxOpenClose;
  if (body_.steppedAs == kind)
  {
    request.acceleration = body_.acceleration;
    request.spinAcceleration = body_.spinAcceleration;
  }
  else if (!lasting)
  {
    request.acceleration.z() = -parameters_.gravity;
  }
  body_.contactsBefore = body_.contacts;
  thread_local StepSolver solver; // its work space is as large as the rest of a rock
  const double energyBefore = lasting ? this->mechanicalEnergy() + body_.springEnergy : 0.0;

  StepOutcome outcome;
  for (int cut = 0;; ++cut)
  {
    const bool last = cut >= parameters_.maxCuts;
    outcome = solver.step(body_.block, request, body_.contacts, body_.state, last);
    summary.openCloseIterations += outcome.iterations;
    if (outcome.settled || last)
    {
      break;
    }
    ++summary.cutSteps;
    request.duration *= 0.5;
  }
  if (structures_.solid() && this->undoAtTrees(request.duration))
  {
    return;
  }
  ++summary.contactSteps;
  if (!outcome.settled)
  {
    ++summary.unsettledSteps;
    if (body_.state.time <= body_.before.time)
    {
      // Not even a finite displacement: the contacts are let go for this step.
      body_.state = fly(body_.block, body_.state, parameters_.gravity, request.duration);
      body_.contacts.clear();
      body_.contactsBefore.clear();
    }
  }
  this->commitStep(kind, outcome, energyBefore, 0.0, true);
  if (lasting)
  {
    this->limitDeepOverlaps(this->looseOverlap());
  }
}

void SingleRock::commitStep(
  StepKind kind, const StepOutcome& outcome, double energyBefore, double given, bool recovers)
{
  const bool lasting = kind == StepKind::Lasting;
  const double taken = body_.state.time - body_.before.time;
  body_.energy.exchanged += given;
  body_.energy.friction += outcome.frictionWork;
  body_.energy.restitution += outcome.dampedWork;
  body_.springEnergy = outcome.springEnergy;
  body_.normalEnergy = outcome.normalEnergy;
  if (lasting)
  {
    const double damped = energyBefore - this->mechanicalEnergy() - body_.springEnergy -
      outcome.frictionWork - outcome.dampedWork - given;
    // Energy that recovery of an overlap gives a rock comes from nowhere, and is booked as that.
    body_.energy.damping += recovering_ && recovers ? std::max(0.0, damped) : damped;
    recovering_ = false;
    // The lag of the next lasting step. What an impact left is no acceleration to go on with, nor
    // is that under other contacts: a rock that rattles would be fed by it.
    const double bound = 3.0 * parameters_.gravity;
    const std::uint64_t carrying = supportHash(body_.contacts);
    const bool same = carrying == carrying_;
    carrying_ = carrying;
    body_.acceleration = (body_.state.velocity - body_.before.velocity) / taken;
    body_.spinAcceleration = (body_.state.spin - body_.before.spin) / taken;
    if (!same || body_.acceleration.norm() > bound ||
      body_.spinAcceleration.norm() * body_.block.radius() > bound)
    {
      body_.acceleration.setZero();
      body_.spinAcceleration.setZero();
    }
    if (recovers)
    {
      this->recoverOverlap(taken);
    }
  }
  else
  {
    body_.acceleration = (body_.state.velocity - body_.before.velocity) / taken;
    body_.spinAcceleration = (body_.state.spin - body_.before.spin) / taken;
    carrying_ = 0;
  }
  if (yields_)
  {
    this->yieldInStep(taken);
  }
  body_.steppedAs = kind;
  const bool touching = anyClosed(body_.contacts);
  if (structures_.hasBarriers())
  {
    // Behind one that breaks there may be others.
    const BlockState end = body_.state;
    double lost = 0.0;
    const PathPiece way{ body_.before, end, end.time - body_.before.time, false };
    structures_.findBarriers(way, parameters_.gravity, body_.block.radius());
    while (this->passBarriers(way, lost))
    {
      lost += this->endStepAtBarrier(end, lost, touching);
      if (body_.done)
      {
        return;
      }
    }
  }
  recorder_.recordBetween(body_.before, body_.state, touching);
  this->auditSamples(body_.state);
  recorder_.follow(body_.state);
  this->followImpact(body_.before, taken, outcome);
  // A soft block that is still being pressed together leaves its contacts and comes back to them:
  // it has taken off when it has not touched for a period of its own.
  openTime_ = touching ? 0.0 : openTime_ + taken;
  if (lasting || (!touching && stiff_ && !scar_.open()))
  {
    this->finishImpact();
  }
}

double SingleRock::looseOverlap() const
{
  // In an island a rock may be pushed under the slope within a step; it may be alone soon after.
  return (body_.inIsland ? kLooseOverlap : kFirm) * body_.block.radius();
}

void SingleRock::recoverOverlap(double h)
{
  // No more per step than half the weight's compression, or a stiff spring would throw the rock
  // off.
  const double way = std::min(
    kRecover * h, 0.5 * body_.block.mass() * parameters_.gravity / parameters_.normalPenalty);
  const double loose = this->looseOverlap();
  for (Contact& c : body_.contacts)
  {
    // What springs get by it comes from nowhere, and stays numerical.
    const double lost = std::max(0.0, recoverLooseOverlap(c, way, loose));
    body_.energy.damping += lost;
    body_.springEnergy -= lost;
  }
}

void SingleRock::recoverDeepOverlap(double h)
{
  recovering_ = false;
  const double speed = deepSpeed(parameters_.gravity, body_.block.radius());
  const double loose = this->looseOverlap();
  for (Contact& c : body_.contacts)
  {
    recovering_ = rockfall::recoverDeepOverlap(c, speed * h, loose) || recovering_;
  }
}

double SingleRock::limitDeepOverlaps(double loose)
{
  const bool deep = anyDeep(body_.contacts, loose);
  double held = 0.0;
  for (Contact& c : body_.contacts)
  {
    const double still = this->settledSpeed() * std::sqrt(body_.block.mass());
    const double normal = limitOverlap(c, still / std::sqrt(c.stiffness), loose);
    body_.normalEnergy = std::max(0.0, body_.normalEnergy - normal);
    held += normal + (deep ? limitSlip(c, still / std::sqrt(c.shearStiffness)) : 0.0);
  }
  const double before = body_.springEnergy;
  body_.springEnergy = std::max(0.0, before - held);
  return before - body_.springEnergy;
}

} // namespace rockfall
