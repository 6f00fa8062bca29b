#include "fall/IslandStepper.h"

#include "base/abort.h"
#include "base/parallel.h"
#include "fall/EndLook.h"
#include "fall/StepResult.h"
#include "fall/StepTrees.h"
#include "fall/pairImpacts.h"
#include "fall/pairSprings.h"
#include "fall/stepContacts.h"
#include "fall/stepLayout.h"
#include "law/settings.h"
#include "rock/pressOut.h"

#include <algorithm>

namespace rockfall
{

namespace
{

IslandWork& workOfThread()
{
  thread_local IslandWork work;
  return work;
}

} // namespace

IslandStepper::IslandStepper(FallState& fall, const Island& island)
  : fall_(fall)
  , island_(island)
  , work_(workOfThread())
{
  work_.solver.method = fall.method;
  work_.solver.stiffness = pairStiffness(fall.parameters);
}

double IslandStepper::timeReached(double until) const
{
  for (int i : island_.members)
  {
    if (!fall_.rocks[i].body().done)
    {
      return fall_.rocks[i].body().state.time;
    }
  }
  return until;
}

void IslandStepper::fly(double duration)
{
  for (int i : island_.members)
  {
    RockSimulator& sim = fall_.rocks[i].sim;
    if (!sim.body().done)
    {
      sim.flyFree(duration);
    }
  }
  for (RockPair* pair : island_.pairs)
  {
    pair->contacts.clear();
    pair->touched = pair->seen = false;
    finishPairImpact(fall_, *pair);
  }
}

bool IslandStepper::touches() const
{
  return std::any_of(island_.members.begin(), island_.members.end(),
           [&](int i) { return anyClosed(fall_.rocks[std::size_t(i)].body().contacts); }) ||
    std::any_of(island_.pairs.begin(), island_.pairs.end(),
      [](const RockPair* pair) { return anyClosed(pair->contacts); });
}

double IslandStepper::beginContacts()
{
  double travel = fall_.parameters.timeStep;
  for (const int i : island_.members)
  {
    RockSimulator& sim = fall_.rocks[std::size_t(i)].sim;
    sim.beginContact();
    if (!sim.done())
    {
      travel = std::min(travel, (island_.crowd ? kCrowdTravel : 1.0) * sim.travelLimit());
    }
  }
  return travel;
}

double IslandStepper::advance(double until, bool lastingOnly)
{
  const bool inTime = !island_.crowd;
  const auto now = [&] { return this->timeReached(until); };
  while (now() < until - kTooShort)
  {
    stayWanted();
    const double travel = this->beginContacts();
    const double remaining = until - now();
    const double large = std::min(remaining, travel);
    double small = inTime ? std::min(remaining, impactStepOf(fall_, island_)) : large;
    const bool calm = inTime && isCalm(fall_, island_);
    this->gatherContacts(calm ? large : small);
    // Stiffnesses are known now: the faster rocks meet, the stiffer.
    small = inTime ? std::min(small, impactStepOf(fall_, island_)) : small;
    const bool any = this->touches();
    if (const double free = any ? 0.0 : this->freeTime(remaining); free > small)
    {
      this->fly(free);
      continue;
    }
    if (!inTime)
    {
      this->solve(large, StepKind::Lasting, true);
      continue;
    }
    const double lasting = calm && any ? this->freeOfFlying(large) : 0.0;
    if ((lasting == large || lasting > small) && this->mayLast(lasting))
    {
      this->solve(lasting, StepKind::Lasting, false);
    }
    else if (lastingOnly)
    {
      return now();
    }
    else
    {
      this->solve(small, StepKind::Impact, false);
    }
  }
  return until;
}

void IslandStepper::pressOutDeep(RockPair& pair, double h) const
{
  const double smaller = work_.smallerRadius(pair);
  const double speed = deepSpeed(fall_.parameters.gravity, smaller);
  for (Contact& c : pair.contacts)
  {
    const double way = island_.crowd ? speed * h : gentleWay(c, h, speed);
    rockfall::pressOutDeep(c, way, kLooseOverlap * smaller);
  }
}

void IslandStepper::addRock(std::size_t m, double h, StepKind kind, bool bounces)
{
  comeToRock(fall_, island_, m);
  FallingRock& rock = fall_.rocks[std::size_t(island_.members[m])];
  RockBody& body = rock.body();
  if (body.done)
  {
    return;
  }
  const std::size_t place = std::size_t(rock.place);
  body.before = body.state;
  body.springEnergyBefore = body.springEnergy;
  body.contactsBefore = body.contacts;
  work_.energyBefore[place] = rock.sim.mechanicalEnergy() + body.springEnergy;
  if (kind == StepKind::Lasting)
  {
    rock.sim.pressOutDeep(h, !island_.crowd);
  }
  IslandBody& asked = work_.bodies[place];
  asked = {};
  asked.block = &body.block;
  asked.state = &body.state;
  if (body.steppedAs == kind)
  {
    asked.acceleration = body.acceleration;
    asked.spinAcceleration = body.spinAcceleration;
  }
  else if (kind == StepKind::Impact)
  {
    asked.acceleration.z() = -fall_.parameters.gravity;
  }
  std::size_t next = work_.slopeFirsts[m];
  for (Contact& c : body.contacts)
  {
    work_.contacts[next++] = touchOnSlope(fall_, rock, c, h, bounces);
  }
}

void IslandStepper::addPair(std::size_t t, double h, StepKind kind, bool bounces)
{
  work_.comeToTouching(island_, t);
  const std::size_t p = work_.touching[t];
  RockPair& pair = *island_.pairs[p];
  if (pair.contacts.empty())
  {
    return;
  }
  const bool crowd = island_.crowd, swept = work_.solver.isSwept(kind, work_.bodies.size());
  const PairMotion motion = work_.motionOf(pair);
  if (kind == StepKind::Lasting)
  {
    this->pressOutDeep(pair, h);
  }
  std::size_t next = work_.firsts[p];
  for (Contact& c : pair.contacts)
  {
    IslandContact& touch = work_.contacts[next++] =
      touchOfPair(fall_, pair, motion, c, h, bounces, work_);
    touch.bare = crowd && swept && mayStayOpen(touch, h);
    if (crowd && !touch.closed && !touch.bare)
    {
      setSprings(fall_, pair, c);
    }
  }
}

void IslandStepper::cutUntilAccepted(StepRequest& request, bool bounces)
{
  work_.iterations = work_.cuts = work_.unsettled = work_.tries = 0;
  for (int cut = 0;; ++cut)
  {
    // A large island leaves little to settle; if it leaves more, a shorter step is taken.
    const bool crowd = island_.crowd;
    const bool last = cut >= (crowd ? kCrowdCuts : fall_.parameters.maxCuts);
    const Accept accept = last ? Accept::Any : crowd ? Accept::Converging : Accept::Settled;
    if (!work_.added.empty())
    {
      work_.contacts.resize(work_.firsts.back());
      work_.added.clear();
      work_.addedTo.clear();
    }
    StepTrees(fall_, island_, work_).stand();
    work_.looked = false;
    work_.solver.begin(request, accept, work_.bodies, work_.contacts);
    while (work_.solver.asksForALook())
    {
      work_.solver.goOn(EndLook(fall_, island_, work_, request.duration, bounces).look());
    }
    const IslandOutcome outcome = work_.solver.finish();
    work_.iterations += outcome.iterations;
    work_.cuts += !outcome.accepted && !last;
    work_.unsettled += outcome.unconverged && (outcome.accepted || last);
    ++work_.tries;
    if (outcome.accepted || last)
    {
      break;
    }
    request.duration *= 0.5;
  }
}

void IslandStepper::solve(double h, StepKind kind, bool bounces)
{
  // Places first, then each rock and each pair for itself.
  if (layOut(fall_, island_, work_) == 0)
  {
    return; // the last of them was caught just now
  }
  forEach(
    island_.members.size(), kRockGrain, [&](std::size_t m) { this->addRock(m, h, kind, bounces); });
  forEach(
    work_.touching.size(), kPairGrain, [&](std::size_t t) { this->addPair(t, h, kind, bounces); });
  if (bounces)
  {
    settleBounces(kind == StepKind::Lasting, work_);
  }
  work_.added.clear();
  work_.addedTo.clear();
  work_.stems.clear();
  StepRequest request;
  request.duration = h;
  request.kind = kind;
  request.gravity = fall_.parameters.gravity;
  request.maxOpenClose = fall_.parameters.maxOpenClose;
  this->cutUntilAccepted(request, bounces);
  const RockBody& first = fall_.rocks[std::size_t(island_.members.front())].body();
  if (work_.bodies.front().state->time <= first.before.time && !first.done)
  {
    // Not even a finite displacement: the contacts are let go for this step.
    for (const int i : island_.members)
    {
      work_.count(fall_.rocks[std::size_t(i)].sim);
    }
    this->fly(request.duration);
    return;
  }
  StepResult(fall_, island_, work_, request.duration, kind).apply();
}

} // namespace rockfall
