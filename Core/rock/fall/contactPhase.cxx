#include "rock/fall/contactPhase.h"

#include "base/abort.h"
#include "block/flight.h"
#include "contact/ground/detection.h"
#include "contact/ground/motion.h"
#include "contact/ground/roundContact.h"
#include "contact/ground/timeToTouch.h"
#include "law/cohesion.h"
#include "law/settings.h"
#include "rock/fall/Fall.h"
#include "rock/fall/atStructures.h"
#include "rock/fall/endOfFall.h"
#include "rock/fall/flightPhase.h"
#include "rock/fall/impulseImpacts.h"
#include "rock/fall/inSoil.h"
#include "rock/fall/islandOfOne.h"
#include "rock/parts/OverlapRecovery.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// The lag of the next lasting step. What an impact left is no acceleration to go on with, nor is
/// that under other contacts: a rock that rattles would be fed by it.
void keepAcceleration(Fall& fall)
{
  RockBody& body = fall.body;
  const double bound = kMostLag * fall.parameters.gravity;
  const std::uint64_t carrying = supportHash(body.contacts);
  const bool same = carrying == std::exchange(fall.carrying, carrying);
  if (!same || body.acceleration.norm() > bound ||
    body.spinAcceleration.norm() * body.block.radius() > bound)
  {
    body.acceleration.setZero();
    body.spinAcceleration.setZero();
  }
}

void endContact(Fall& fall)
{
  fall.inContact = false;
  fall.recorder.knot(fall.body, false);
}

/// Without contacts that carry: relaxes, takes off, or flies as long as nothing can close within
/// steps of `small` (s). Whether anything was done.
bool flyFromContact(Fall& fall, double small)
{
  RockBody& body = fall.body;
  if (!body.stiff && !(body.state.strain.isZero(0.0) && body.state.strainRate.isZero(0.0)))
  {
    // The rock has taken off, and what flies does not strain. How long it is free is asked of what
    // it is then.
    body.energy.vibration += relaxStrain(body.block, body.state);
    fall.impact.finish(body, fall.recorder);
    return true;
  }
  if (fall.impulses && !fall.structures.solid() && body.state.time > fall.nearSince)
  {
    // A hop finds its next touch by itself.
    body.contacts.clear();
    endContact(fall);
    return true;
  }
  // Free until a pair closes, or until others than the candidates might.
  const double gravity = fall.parameters.gravity;
  const double room = fall.ground.candidates().room(body.state, body.block.radius(), 0.0);
  const double rim = body.block.largestRimSpeed(body.state.spin);
  const double served = std::min(
    timeToCover(room, body.state.velocity.norm() + rim, gravity), fall.horizon - body.state.time);
  const double free = timeToClose(
    body.placed, body.state, fall.ground.patch(), fall.ground.candidates(), gravity, served);
  if (free >= served && served > small && !fall.soil.scar().open())
  {
    body.contacts.clear();
    if (!body.stiff)
    {
      fall.impact.finish(body, fall.recorder);
    }
    fall.freeUntil = body.state.time + served;
    endContact(fall);
    return true;
  }
  if (const double sure = std::min(free, served); sure > small)
  {
    body.contacts.clear();
    advanceInFlight(fall, sure);
    checkEnd(fall, 0.0);
    return true;
  }
  return false;
}

/// Lets go of open contacts whose own gaps do not close within a step: each is a row of its system.
void forgetFarContacts(Fall& fall, double h)
{
  RockBody& body = fall.body;
  const Vec3 spin = body.state.angularVelocity();
  const double r = body.block.radius();
  const double bend = body.pull(fall.parameters.gravity) + spin.squaredNorm() * r;
  const double strains = body.state.strainRate.norm() * r;
  std::erase_if(body.contacts,
    [&](const Contact& c)
    {
      const double approach = approachOf(body.state, spin, c.point, c.normal) + strains;
      return !c.closed() &&
        c.gap() > (kFasterApproach * std::max(0.0, approach) + bend * h) * h + kHiddenGap * r;
    });
}

/// Energy that a step to where the rock is now has damped, J; < 0: made.
double dampedIn(
  const StepOutcome& outcome, double energyBefore, const RockBody& body, double gravity)
{
  return energyBefore - body.mechanicalEnergy(gravity) - outcome.springEnergy -
    outcome.frictionWork - outcome.dampedWork;
}

/// How deep a feature may be in the ground without a contact, m. A vertex that carries may be pressed
/// in, and its neighbourhood with it; anything deeper slipped through.
double looseOverlap(const RockBody& body)
{
  double pressed = 0.0;
  for (const Contact& c : body.contacts)
  {
    pressed = std::max(pressed, std::min(-c.gap(), -c.distance)); // by force, and by place
  }
  return kLooseOverlap * body.block.radius() + 2.0 * pressed;
}

/// That any point of the rock has gone in the step, at most, m.
double wayOf(const RockBody& body)
{
  const BlockState &from = body.before, &to = body.state;
  const double r = body.block.radius();
  return (to.position - from.position).norm() + rimTravel(from.orientation, to.orientation, r) +
    r * (to.strain - from.strain).norm();
}

/// One step of contact, halved until open–close settles: as far as steps that resolve an impact
/// (`small`, s) whatever it takes, from there on as often as is asked for. Friction that is steep, as
/// cohesion under small forces, has no balance in a step that resolves nothing; what is taken
/// unsettled then can make any energy.
void takeStep(Fall& fall, double h, StepKind kind, double small)
{
  RockBody& body = fall.body;
  body.before = body.state;
  fall.struckAtOnce = 0;
  body.springEnergyBefore = body.springEnergy;
  const bool lasting = kind == StepKind::Lasting;
  TrajectorySummary& summary = fall.recorder.trajectory().summary;
  StepRequest request;
  request.duration = h;
  request.kind = kind;
  request.gravity = fall.parameters.gravity;
  request.normalPenalty = fall.springs.penalty();
  request.shearPenalty = fall.springs.penalty() * fall.parameters.shearRatio;
  request.friction = fall.surface.friction();
  request.cohesion = fall.surface.cohesion();
  request.rigid = body.stiff;
  request.maxOpenClose = fall.parameters.maxOpenClose;
  if (body.steppedAs == kind)
  {
    request.acceleration = body.acceleration;
    request.spinAcceleration = body.spinAcceleration;
  }
  else if (!lasting)
  {
    request.acceleration.z() = -fall.parameters.gravity;
  }
  body.contactsBefore = body.contacts;
  thread_local StepSolver solver; // its work space is as large as the rest of a rock
  const double energyBefore =
    lasting ? body.mechanicalEnergy(fall.parameters.gravity) + body.springEnergy : 0.0;

  StepOutcome outcome;
  const auto again = [&]
  {
    body.state = body.before;
    body.contacts = body.contactsBefore;
  };
  for (int cut = 0;;)
  {
    const bool last = cut >= fall.parameters.maxCuts;
    outcome = solver.step(body.block, request, body.contacts, body.state, last);
    summary.openCloseIterations += outcome.iterations;
    if (!outcome.settled && !last)
    {
      ++summary.cutSteps;
      cut += !(request.duration >= small);
      request.duration *= 0.5;
      continue;
    }
    // Other contacts than in the last step have come to carry: its acceleration is none to go on with.
    const bool lags = !(request.acceleration.isZero(0.0) && request.spinAcceleration.isZero(0.0));
    if (lasting && lags &&
      dampedIn(outcome, energyBefore, body, fall.parameters.gravity) <
        -kGainOfLag * body.block.mass() * fall.parameters.gravity * body.block.radius())
    {
      again();
      request.acceleration.setZero();
      request.spinAcceleration.setZero();
      continue;
    }
    // Features that are to meet beside where they are now, as over a ridge, are no contact yet.
    if (lasting && request.duration > small)
    {
      body.placed.move(body.block, body.state);
      if (passed(body.placed, fall.ground.patch(), fall.ground.candidates(), looseOverlap(body),
            { body.before.position, wayOf(body) }, body.contacts))
      {
        ++summary.cutSteps;
        again();
        request.duration *= 0.5;
        continue;
      }
    }
    break;
  }
  if (fall.structures.solid() && undoAtTrees(fall, request.duration))
  {
    return;
  }
  ++summary.contactSteps;
  if (!outcome.settled)
  {
    ++summary.unsettledSteps;
    if (body.state.time <= body.before.time)
    {
      // Not even a finite displacement: the contacts are let go for this step.
      body.state = fly(body.block, body.state, fall.parameters.gravity, request.duration);
      body.contacts.clear();
      body.contactsBefore.clear();
    }
  }
  commitStep(fall, kind, outcome, energyBefore, 0.0, true);
}

} // namespace

void beginContact(Fall& fall)
{
  RockBody& body = fall.body;
  if (fall.inContact)
  {
    return;
  }
  fall.springs.beginContact(body);
  fall.nearSince = body.state.time;
  body.steppedAs = StepKind::Lasting; // no impact's step to go by yet
  fall.openTime = body.ringing;
  fall.inContact = true;
  fall.recorder.knot(body, false);
}

void stayInContact(Fall& fall)
{
  RockBody& body = fall.body;
  const double r = body.block.radius();
  while (fall.inContact && !body.done && !fall.arrived())
  {
    stayWanted();
    // Two lengths of a step: one that resolves an impact, one as far as candidates serve.
    const double small = fall.springs.impactStep(body);
    const double large = std::min(fall.parameters.timeStep, fall.springs.travelLimit(body));
    body.placed.move(body.block, body.state);
    if (fall.soil.scar().open() && body.contacts.empty() && flyOverScar(fall, small))
    {
      continue;
    }
    // A long step is worth a look only when what carries is at rest along its normal: whether it is, is
    // seen where it is now, as a point that slides has gone on since the last look.
    const bool quiet = fall.springs.holdLittle(body);
    const double ahead = quiet ? large : small;
    const double speed =
      body.state.velocity.norm() + (body.state.spin.norm() + body.state.strainRate.norm()) * r;
    const double reach =
      (kFasterApproach * speed + body.pull(fall.parameters.gravity) * ahead) * ahead +
      kHiddenGap * r;
    // What may close within the step: a gap that is not among the contacts has no spring in it.
    fall.ground.ensureCandidates(body, fall.structures, reach);
    findContacts(fall, fall.ground.candidates(), reach, quiet ? large : 0.0);
    const bool calm = quiet && fall.springs.carryAtRest(body);
    body.springEnergy = springEnergyOf(body.contacts); // what has gone shows as numerical

    // A long, damped step would swallow a rebound: it is taken only where nothing comes or goes.
    double h = std::min(large, fall.horizon - body.state.time);
    StepKind kind = StepKind::Lasting;
    bool lasts = calm && fall.springs.mayLast(body, h);
    if (fall.impulses && calm && !lasts)
    {
      double first = 0.0;
      if (strikeSoon(fall, std::min(small, h), first))
      {
        checkEnd(fall, first);
        continue;
      }
      // Up to the impact what carries does so.
      const double until = kUpToImpact * first;
      if (first > small && until < h && anyClosed(body.contacts) &&
        fall.springs.mayLast(body, until))
      {
        h = until;
        lasts = true;
      }
    }
    if (!lasts)
    {
      kind = StepKind::Impact;
      h = std::min(h, small);
    }
    forgetFarContacts(fall, h);
    // What gives way first changes the ground under the step, which is then looked at anew.
    if ((fall.structures.solid() && breakTrees(fall, h)) ||
      (fall.soil.yields() && followScar(fall, h)))
    {
      continue;
    }
    // Hops have a closed form, and need no steps.
    if (kind == StepKind::Impact && !anyClosed(body.contacts) && fall.openTime >= body.ringing &&
      flyFromContact(fall, small))
    {
      continue;
    }
    // What has slipped through between looks is held where it is, before springs are given out.
    guardPenetrations(fall, fall.ground.candidates());
    h = std::max(h, 1e-12);
    setNewSprings(fall, h);
    // Springs that are pressed together swing faster than each by itself: a shorter step.
    if (kind == StepKind::Impact && body.contacts.size() > 1)
    {
      const double touchdown = fall.springs.touchdownStep(body, h);
      if (touchdown < (1.0 - 1e-9) * h)
      {
        h = touchdown;
        setNewSprings(fall, h);
      }
    }
    if (isRound(body.placed)) // it rolls off the plane that it touches
    {
      turnToMiddle(body.placed, body.state, fall.ground.patch(), h, body.contacts);
    }
    if (isPressedIn(fall, kind))
    {
      stepAsIsland(fall, h);
    }
    else
    {
      takeStep(fall, h, kind, small);
    }
    checkEnd(fall, body.state.time - body.before.time);
  }
}

void findContacts(Fall& fall, const CandidatePairs& candidates, double reach, double h)
{
  RockBody& body = fall.body;
  const double faster = body.pull(fall.parameters.gravity) / body.block.radius() * h; // rad/s
  updateContacts(body.placed, fall.ground.patch(), candidates, reach, body.contacts,
    (body.state.spin.norm() + faster) * h);
}

void guardPenetrations(Fall& fall, const CandidatePairs& candidates)
{
  RockBody& body = fall.body;
  guardPenetration(body.placed, fall.ground.patch(), candidates, looseOverlap(body),
    { body.state.position }, body.contacts);
}

void setNewSprings(Fall& fall, double h)
{
  RockBody& body = fall.body;
  fall.springs.stiffen(body);
  for (Contact& c : body.contacts)
  {
    setSprings(fall, c);
  }
  if (const std::ptrdiff_t points = closedCount(body.contacts); points > kCohesivePoints)
  {
    for (Contact& c : body.contacts)
    {
      c.cohesion = sharedCohesion(c.cohesion, points);
    }
  }
  if (!body.inIsland)
  {
    fall.springs.tuneTogether(body, h);
  }
}

void setSprings(Fall& fall, Contact& c)
{
  const GroundTouch touch = fall.impact.touchAt(c.cfe, c.point);
  const double slipping = fall.soil.slipFriction(c, fall.body, fall.structures);
  c.friction = std::isnan(slipping) ? fall.surface.frictionAt(touch) : slipping;
  c.cohesion = fall.surface.cohesionAt(c.cfe);
  if (!c.closed())
  {
    fall.springs.give(c, fall.body, fall.surface.restitutionAt(touch));
  }
}

void commitStep(Fall& fall, StepKind kind, const StepOutcome& outcome, double energyBefore,
  double given, bool recovers)
{
  RockBody& body = fall.body;
  const bool lasting = kind == StepKind::Lasting;
  const double taken = body.state.time - body.before.time;
  body.energy.exchanged += given;
  body.energy.friction += outcome.frictionWork;
  body.energy.restitution += outcome.dampedWork;
  body.springEnergy = outcome.springEnergy;
  body.normalEnergy = outcome.normalEnergy;
  body.acceleration = (body.state.velocity - body.before.velocity) / taken;
  body.spinAcceleration = (body.state.spin - body.before.spin) / taken;
  if (lasting)
  {
    body.energy.damping += dampedIn(outcome, energyBefore, body, fall.parameters.gravity) - given;
    keepAcceleration(fall);
    if (recovers)
    {
      recoverLooseOverlaps(body, taken, fall.parameters.gravity, fall.springs.leastPenalty());
    }
  }
  else
  {
    fall.carrying = 0;
  }
  if (fall.soil.yields())
  {
    yieldInStep(fall, taken);
  }
  body.steppedAs = kind;
  const bool touching = anyClosed(body.contacts);
  if (fall.structures.hasBarriers() && !passBarriersInStep(fall, touching))
  {
    return;
  }
  fall.recorder.recordBetween(body, body.before, body.state, touching);
  fall.recorder.follow(body);
  fall.impact.follow(body, body.before, taken, outcome, fall.recorder);
  // A soft block that is still being pressed together leaves its contacts and comes back to them:
  // it has taken off when it has not touched for a period of its own.
  fall.openTime = touching ? 0.0 : fall.openTime + taken;
  const bool off = !touching && body.stiff;
  if (lasting || (off && !fall.soil.scar().open()))
  {
    fall.impact.finish(body, fall.recorder);
  }
  else if (off)
  {
    fall.impact.takeOff(body, fall.recorder);
  }
}

} // namespace rockfall
