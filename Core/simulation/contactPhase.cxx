#include "simulation/RockSimulator.h"

#include "base/abort.h"
#include "block/flight.h"
#include "contact/detection.h"
#include "contact/motion.h"
#include "contact/timeToTouch.h"
#include "law/cohesion.h"
#include "law/settings.h"
#include "simulation/impactMode.h"
#include "simulation/pressOut.h"
#include "simulation/pressedIn.h"
#include "simulation/restitution.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// The features of the rock that carry, as a number that any change changes.
std::uint64_t carriers(const std::vector<Contact>& contacts)
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

bool anyClosed(const std::vector<Contact>& contacts)
{
  return std::any_of(contacts.begin(), contacts.end(), [](const Contact& c) { return c.closed(); });
}

} // namespace

bool RockSimulator::mayLast(double h) const
{
  bool any = false;
  const Vec3 spin = state_.angularVelocity();
  for (const Contact& c : contacts_)
  {
    const Vec3 v = state_.velocity + spin.cross(c.point - state_.position);
    const double approach = -c.normal.dot(v);
    if (c.closed())
    {
      any = true;
      if (std::abs(approach) > restingSpeed_)
      {
        return false;
      }
    }
    else if (approach > restingSpeed_)
    {
      if (c.gap() < approach * h)
      {
        return false;
      }
    }
    else if (c.gap() <= 0.5 * parameters_.gravity * h * h && approach > -restingSpeed_)
    {
      any = true; // laid down, not thrown
    }
  }
  return any;
}

double RockSimulator::settledSpeed() const
{
  return restingSpeed_ + 4.0 * parameters_.gravity * std::sqrt(block_.mass() * softness_);
}

bool RockSimulator::isCalm() const
{
  // At the turning point of an impact nothing moves either, but the springs hold its energy; at
  // rest they hold the weight's, ½ m v² with v = g √(m/p), several times that when the rock rolls.
  const double settled = this->settledSpeed();
  const double held = normalEnergy_ + (stiff_ ? 0.0 : strainEnergy(block_, state_));
  if (held > 0.5 * block_.mass() * settled * settled)
  {
    return false;
  }
  const Vec3 spin = state_.angularVelocity();
  return std::all_of(contacts_.begin(), contacts_.end(),
    [&](const Contact& c)
    {
      const Vec3 v = state_.velocity + spin.cross(c.point - state_.position);
      return !c.closed() || std::abs(c.normal.dot(v)) <= restingSpeed_;
    });
}

void RockSimulator::stayInContact()
{
  while (!done_ && !this->arrived())
  {
    stayWanted();
    const double small = this->impactStep();
    const double large = std::min(parameters_.timeStep, this->travelLimit());
    placed_.move(block_, state_);
    if (scar_.open() && contacts_.empty() && this->flyOverScar(small))
    {
      continue;
    }
    const double speed = state_.velocity.norm() + state_.spin.norm() * block_.radius();
    const auto reachOf = [&](double h)
    { return 1.5 * speed * h + parameters_.gravity * h * h + 1e-6 * block_.radius(); };
    // A long step is worth a look only when what carries is at rest along its normal.
    const bool calm = this->isCalm();
    const double reach = reachOf(calm ? large : small);
    this->ensureCandidates(reach);
    this->findContacts(candidates_, reach, calm ? large : 0.0);
    springEnergy_ = springEnergyOf(contacts_); // what has gone with a contact shows as numerical

    double h = std::min(large, horizon_ - state_.time);
    StepKind kind = StepKind::Lasting;
    if (!calm || !this->mayLast(h))
    {
      kind = StepKind::Impact;
      h = std::min(h, small);
      const double near = reachOf(h);
      std::erase_if(contacts_, [&](const Contact& c) { return !c.closed() && c.gap() > near; });
    }
    if (solid_ && this->breakTrees(h))
    {
      continue;
    }
    if (yields_ && this->followScar(h))
    {
      continue;
    }
    if (kind == StepKind::Impact && !anyClosed(contacts_) && openTime_ >= ringing_)
    {
      if (!stiff_ && !(state_.strain.isZero(0.0) && state_.strainRate.isZero(0.0)))
      {
        // The rock has taken off, and what flies does not strain. How long it is free is asked of
        // what it is then.
        energy_.vibration += relaxStrain(block_, state_);
        this->finishImpact();
        continue;
      }
      // Free until a pair closes, or until others than the candidates might.
      const double room = candidates_.room(state_, block_.radius(), 0.0);
      const double rim = block_.largestRimSpeed(state_.spin);
      const double served =
        std::min(timeToCover(room, state_.velocity.norm() + rim, parameters_.gravity),
          horizon_ - state_.time);
      const double free =
        timeToClose(placed_, state_, patch_, candidates_, parameters_.gravity, served);
      if (free >= served && served > small && !scar_.open())
      {
        contacts_.clear();
        if (!stiff_)
        {
          this->finishImpact();
        }
        freeUntil_ = state_.time + served;
        this->endContact();
        return;
      }
      if (const double sure = std::min(free, served); sure > small)
      {
        contacts_.clear();
        this->advanceInFlight(sure);
        this->checkEnd(0.0);
        continue;
      }
    }
    // A vertex that carries may be pressed in, and its neighbourhood with it; anything deeper
    // slipped through.
    double pressed = 0.0;
    for (const Contact& c : contacts_)
    {
      pressed = std::max(pressed, -c.gap());
    }
    holdOverlap(
      placed_, patch_, candidates_, kLooseOverlap * block_.radius() + 2.0 * pressed, contacts_);
    h = std::max(h, 1e-12);
    this->armContacts(h);
    if (kind == StepKind::Impact && contacts_.size() > 1)
    {
      const double touchdown = this->touchdownStep(h);
      if (touchdown < (1.0 - 1e-9) * h)
      {
        h = touchdown;
        this->armContacts(h);
      }
    }
    if (kind == StepKind::Lasting)
    {
      this->pressOutDeep(h, false);
    }
    this->takeStep(h, kind);
    this->checkEnd(state_.time - before_.time);
  }
}

void RockSimulator::findContacts(const CandidatePairs& candidates, double reach, double h)
{
  updateContacts(placed_, patch_, candidates, reach, contacts_, state_.spin.norm() * h);
}

double RockSimulator::dampingRatioFor(int ground, double restitution)
{
  if (surface_.deviationPer() != DeviationPer::Iteration)
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

void RockSimulator::armContacts(double h)
{
  // A rock that slides into something may be faster than when its contact began.
  penalty_ = std::max(penalty_, this->stoppingPenalty());
  for (Contact& c : contacts_)
  {
    this->armContact(c);
  }
  if (const std::ptrdiff_t points = closedCount(contacts_); points > kCohesivePoints)
  {
    for (Contact& c : contacts_)
    {
      c.cohesion = sharedCohesion(c.cohesion, points);
    }
  }
  if (!crowded_)
  {
    tuneDashpots(
      contacts_, h,
      [this, spin = state_.angularVelocity()](const Contact& c)
      { return -c.normal.dot(state_.velocity + spin.cross(c.point - state_.position)); },
      [this](const Vec3& force, const Vec3& moment, const Vec3& at)
      { return response(placed_, force, moment, at); });
  }
}

void RockSimulator::armContact(Contact& c)
{
  const GroundTouch touch = this->touchAt(c.cfe, c.point);
  const bool slips = yields_ && this->yieldingAt(c).slips();
  c.friction = slips ? this->yieldingAt(c).frictionAfter(slip_) : surface_.frictionAt(touch);
  c.cohesion = surface_.cohesionAt(c.cfe);
  if (c.closed())
  {
    return;
  }
  const Vec3 lever = c.point - state_.position;
  const Vec3 y = placed_.rotation().transpose() * lever;
  const Vec3 n = placed_.rotation().transpose() * c.normal;
  const Vec3 t = n.unitOrthogonal();
  const double shear = penalty_ * parameters_.shearRatio;
  const bool strains = stiff_ && !parameters_.rigid;
  c.stiffness = penalty_ / (1.0 + (strains ? penalty_ * block_.compliance(n, y) : 0.0));
  c.shearStiffness = shear / (1.0 + (strains ? shear * block_.compliance(t, y) : 0.0));
  const double speed = state_.velocity.norm();
  const double approach = -c.normal.dot(state_.velocity + state_.angularVelocity().cross(lever));
  const bool down =
    approach > restingSpeed_ && comesDown(approach, speed, parameters_.gravity, block_.radius());
  const int ground = surface_.restitutionClass(c.cfe);
  const double restitution = surface_.restitutionAt(touch);
  const double damped = contactDamping(surface_.terrain().restitutionMaterial(ground), restitution,
    this->dampingRatioFor(ground, restitution), approach, down);
  const double mobility = block_.mobility(n, y);
  c.frequency2 = c.stiffness * mobility;
  c.stopped = 1.0 / mobility;
  c.dashpot = damped > 0.0 ? 2.0 * damped * std::sqrt(c.stiffness / mobility) : 0.0;
  c.shearDashpot = 2.0 * kShearDamping * std::sqrt(c.shearStiffness / block_.mobility(t, y));
}

void RockSimulator::takeStep(double h, StepKind kind)
{
  before_ = state_;
  springEnergyBefore_ = springEnergy_;
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
  if (steppedAs_ == kind)
  {
    request.acceleration = acceleration_;
    request.spinAcceleration = spinAcceleration_;
  }
  else if (!lasting)
  {
    request.acceleration.z() = -parameters_.gravity;
  }
  contactsBefore_ = contacts_;
  thread_local StepSolver solver; // its work space is as large as the rest of a rock
  const double energyBefore = lasting ? this->mechanicalEnergy() + springEnergy_ : 0.0;

  StepOutcome outcome;
  for (int cut = 0;; ++cut)
  {
    const bool last = cut >= parameters_.maxCuts;
    outcome = solver.step(block_, request, contacts_, state_, last);
    summary.openCloseIterations += outcome.iterations;
    if (outcome.settled || last)
    {
      break;
    }
    ++summary.cutSteps;
    request.duration *= 0.5;
  }
  if (solid_ && this->undoAtTrees(request.duration))
  {
    return;
  }
  ++summary.contactSteps;
  if (!outcome.settled)
  {
    ++summary.unsettledSteps;
    if (state_.time <= before_.time)
    {
      // Not even a finite displacement: the contacts are let go for this step.
      state_ = fly(block_, state_, parameters_.gravity, request.duration);
      contacts_.clear();
      contactsBefore_.clear();
    }
  }
  this->absorb(kind, outcome, energyBefore, 0.0);
  if (lasting)
  {
    this->letDeepBe(this->looseOverlap());
  }
}

void RockSimulator::absorb(
  StepKind kind, const StepOutcome& outcome, double energyBefore, double given)
{
  const bool lasting = kind == StepKind::Lasting;
  const double taken = state_.time - before_.time;
  energy_.exchanged += given;
  energy_.friction += outcome.frictionWork;
  energy_.restitution += outcome.dampedWork;
  springEnergy_ = outcome.springEnergy;
  normalEnergy_ = outcome.normalEnergy;
  if (lasting)
  {
    const double damped = energyBefore - this->mechanicalEnergy() - springEnergy_ -
      outcome.frictionWork - outcome.dampedWork - given;
    // Energy that recovery of an overlap gives a rock comes from nowhere, and is booked as that.
    energy_.damping += pressed_ ? std::max(0.0, damped) : damped;
    pressed_ = false;
    // The lag of the next lasting step. What an impact left is no acceleration to go on with, nor
    // is that under other contacts: a rock that rattles would be fed by it.
    const double bound = 3.0 * parameters_.gravity;
    const std::uint64_t carrying = carriers(contacts_);
    const bool same = carrying == carrying_;
    carrying_ = carrying;
    acceleration_ = (state_.velocity - before_.velocity) / taken;
    spinAcceleration_ = (state_.spin - before_.spin) / taken;
    if (!same || acceleration_.norm() > bound || spinAcceleration_.norm() * block_.radius() > bound)
    {
      acceleration_.setZero();
      spinAcceleration_.setZero();
    }
    this->pressOut(taken);
  }
  else
  {
    acceleration_ = (state_.velocity - before_.velocity) / taken;
    spinAcceleration_ = (state_.spin - before_.spin) / taken;
    carrying_ = 0;
  }
  if (yields_)
  {
    this->yieldInStep(taken);
  }
  steppedAs_ = kind;
  const bool touching = anyClosed(contacts_);
  if (barriers_)
  {
    // Behind one that breaks there may be others.
    const BlockState end = state_;
    double lost = 0.0;
    const Way way{ before_, end, end.time - before_.time, false };
    this->findBarriers(way);
    for (this->passBarriers(way, lost); hit_.barrier >= 0; this->passBarriers(way, lost))
    {
      lost += this->endStepAtBarrier(end, lost, touching);
      if (done_)
      {
        return;
      }
    }
  }
  recorder_.recordBetween(before_, state_, touching);
  this->auditSamples(state_);
  recorder_.follow(state_);
  this->followImpact(before_, taken, outcome);
  // A soft block that is still being pressed together leaves its contacts and comes back to them:
  // it has taken off when it has not touched for a period of its own.
  openTime_ = touching ? 0.0 : openTime_ + taken;
  if (lasting || (!touching && stiff_ && !scar_.open()))
  {
    this->finishImpact();
  }
}

double RockSimulator::looseOverlap() const
{
  // In a crowd a rock may be pushed under the slope within a step; it may be alone soon after.
  return (crowded_ ? kLooseOverlap : kFirm) * block_.radius();
}

void RockSimulator::pressOut(double h)
{
  // No more per step than half the weight's compression, or a stiff spring would throw the rock
  // off.
  const double way =
    std::min(kPressOut * h, 0.5 * block_.mass() * parameters_.gravity / parameters_.normalPenalty);
  const double loose = this->looseOverlap();
  for (Contact& c : contacts_)
  {
    pressOutLoose(c, way, loose);
  }
}

void RockSimulator::pressOutDeep(double h, bool held)
{
  pressed_ = false;
  const double speed = deepSpeed(parameters_.gravity, block_.radius());
  const double loose = this->looseOverlap();
  for (Contact& c : contacts_)
  {
    const double way = held ? gentleWay(c, h, speed) : speed * h;
    pressed_ = rockfall::pressOutDeep(c, way, loose) || pressed_;
  }
}

void RockSimulator::letDeepBe(double loose)
{
  const bool deep = anyDeep(contacts_, loose);
  double held = 0.0;
  for (Contact& c : contacts_)
  {
    const double still = this->settledSpeed() * std::sqrt(block_.mass());
    const double normal = letBe(c, still / std::sqrt(c.stiffness), loose);
    normalEnergy_ = std::max(0.0, normalEnergy_ - normal);
    held += normal + (deep ? letSlipBe(c, still / std::sqrt(c.shearStiffness)) : 0.0);
  }
  springEnergy_ = std::max(0.0, springEnergy_ - held);
}

} // namespace rockfall
