#include "world/IslandStepper.h"

#include "base/abort.h"
#include "base/parallel.h"
#include "law/settings.h"
#include "rock/fall/contactPhase.h"
#include "rock/fall/flightPhase.h"
#include "rock/fall/islandOfOne.h"
#include "world/EndDetection.h"
#include "world/StepResult.h"
#include "world/StepTrees.h"
#include "world/pairImpacts.h"
#include "world/stepContacts.h"
#include "world/stepLayout.h"

#include <algorithm>
#include <numeric>
#include <vector>

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

IslandStepper::IslandStepper(WorldState& world, const Island& island)
  : world_(world)
  , island_(island)
  , work_(workOfThread())
{
  work_.solver.setStiffness(pairStiffness(world.parameters));
}

double IslandStepper::timeReached(double until) const
{
  for (int i : island_.members)
  {
    if (!world_.rocks[i].body().done)
    {
      return world_.rocks[i].body().state.time;
    }
  }
  return until;
}

void IslandStepper::fly(double duration)
{
  work_.forMembers(world_, island_,
    [&](std::size_t m)
    {
      SingleRock& sim = world_.rocks[std::size_t(island_.members[m])].sim;
      if (!sim.body().done)
      {
        flyFree(sim.fall(), duration);
      }
    });
  for (RockPair* pair : island_.pairs)
  {
    pair->keep({});
    pair->touched = pair->seen = false;
    finishPairImpact(world_, *pair);
  }
}

double IslandStepper::beginContacts()
{
  double travel = world_.parameters.timeStep;
  for (const int i : island_.members)
  {
    SingleRock& sim = world_.rocks[std::size_t(i)].sim;
    beginContact(sim.fall());
    if (!sim.done())
    {
      travel = std::min(travel, kIslandTravel * sim.fall().springs.travelLimit(sim.body()));
    }
  }
  return travel;
}

void IslandStepper::advance(double until, bool atBarrier)
{
  work_.turns.clear();
  if (atBarrier)
  {
    const std::vector<double> times = world_.timesToBarriers(island_.members, until - world_.time);
    work_.turns.resize(times.size());
    std::iota(work_.turns.begin(), work_.turns.end(), std::size_t(0));
    std::ranges::stable_sort(work_.turns, {}, [&](std::size_t m) { return times[m]; });
  }
  while (this->timeReached(until) < until - kTooShort)
  {
    stayWanted();
    const double travel = this->beginContacts();
    const double remaining = until - this->timeReached(until), h = std::min(remaining, travel);
    this->gatherContacts(h);
    this->solve(h);
  }
}

void IslandStepper::addRock(std::size_t m)
{
  FallingRock& rock = world_.rocks[std::size_t(island_.members[m])];
  RockBody& body = rock.body();
  if (body.done)
  {
    return;
  }
  const std::size_t place = std::size_t(rock.place);
  body.before = body.state;
  body.springEnergyBefore = body.springEnergy;
  body.contactsBefore = body.contacts;
  work_.energyBefore[place] = body.mechanicalEnergy(world_.parameters.gravity) + body.springEnergy;
  IslandBody& asked = work_.bodies[place];
  asked = {};
  asked.block = &body.block;
  asked.state = &body.state;
  std::size_t next = work_.slopeFirsts[m];
  for (Contact& c : body.contacts)
  {
    work_.contacts[next++] = touchOnSlope(rock.fall(), rock.place, c);
  }
}

void IslandStepper::addPair(std::size_t t)
{
  const std::size_t p = work_.touching[t];
  RockPair& pair = *island_.pairs[p];
  if (pair.contacts.empty())
  {
    return;
  }
  const PairMotion motion = work_.motionOf(pair);
  std::size_t next = work_.firsts[p];
  for (Contact& c : pair.contacts)
  {
    IslandContact& touch = work_.contacts[next++] = touchOfPair(world_, pair, motion, c, work_);
    touch.bare = true;
  }
}

void IslandStepper::cutUntilAccepted(StepRequest& request)
{
  work_.iterations = work_.cuts = work_.unsettled = work_.tries = 0;
  for (int cut = 0;; ++cut)
  {
    // A step leaves little to settle; if it leaves more, a shorter one is taken.
    const bool last = cut >= kIslandCuts;
    const Accept accept = last ? Accept::Any : Accept::Settled;
    if (!work_.added.empty())
    {
      work_.contacts.resize(work_.firsts.back());
      work_.added.clear();
      work_.addedTo.clear();
    }
    StepTrees(world_, island_, work_).stand();
    work_.solver.begin(request, accept, work_.bodies, work_.contacts);
    while (work_.solver.asksForALook())
    {
      work_.solver.goOn(EndDetection(world_, island_, work_, request.duration).detect());
    }
    const IslandOutcome outcome = work_.solver.finish();
    work_.iterations += outcome.iterations;
    work_.cuts += !outcome.accepted && !last;
    work_.unsettled += !outcome.settled && (outcome.accepted || last);
    ++work_.tries;
    if (outcome.accepted || last)
    {
      break;
    }
    request.duration *= 0.5;
  }
}

void IslandStepper::solve(double h)
{
  // Places first, then each rock and each pair for itself.
  if (layOut(world_, island_, work_) == 0)
  {
    return; // the last of them was caught just now
  }
  forEach(island_.members.size(), kRockGrain, [&](std::size_t m) { this->addRock(m); });
  forEach(work_.touching.size(), kPairGrain, [&](std::size_t t) { this->addPair(t); });
  work_.added.clear();
  work_.addedTo.clear();
  work_.stems.clear();
  StepRequest request;
  request.duration = h;
  request.gravity = world_.parameters.gravity;
  request.substeps = substepsOf(h, world_.parameters.timeStep);
  this->cutUntilAccepted(request);
  const RockBody& first = world_.rocks[std::size_t(island_.members.front())].body();
  if (work_.bodies.front().state->time <= first.before.time && !first.done)
  {
    // Not even a finite displacement: the contacts are let go for this step.
    for (const int i : island_.members)
    {
      work_.count(world_.rocks[std::size_t(i)].sim);
    }
    this->fly(request.duration);
    return;
  }
  StepResult(world_, island_, work_, request.duration).apply();
}

} // namespace rockfall
