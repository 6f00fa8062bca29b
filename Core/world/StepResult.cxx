#include "world/StepResult.h"

#include "base/parallel.h"
#include "contact/ground/motion.h"
#include "law/settings.h"
#include "rock/fall/contactPhase.h"
#include "rock/fall/endOfFall.h"
#include "world/StepTrees.h"
#include "world/pairImpacts.h"

#include <algorithm>
#include <atomic>

namespace rockfall
{

StepResult::StepResult(WorldState& world, const Island& island, IslandWork& work, double duration)
  : world_(world)
  , island_(island)
  , work_(work)
  , h_(duration)
{
}

void StepResult::apply()
{
  work_.touchesOthers.assign(work_.bodies.size(), 0);
  work_.flags.resize(std::max(work_.flags.size(), island_.pairs.size()));
  for (std::size_t k = 0; k < work_.added.size(); ++k)
  {
    if (!work_.addedTo[k].onSlope)
    {
      findLateImpact(
        world_, *island_.pairs[work_.addedTo[k].of], work_.contacts[work_.firsts.back() + k], h_);
    }
  }
  this->splitOffSingles();
  StepTrees(world_, island_, work_).forgetSingles();
  forEach(work_.touching.size(), kPairGrain, [this](std::size_t t) { this->applyToPair(t); });
  this->applyAdded();
  this->finishImpacts();
  work_.forMembers(world_, island_, [this](std::size_t m) { this->applyToRock(m); });
  forEach(island_.pairs.size(), kPairGrain, [this](std::size_t p) { this->keepAxis(p); });
}

void StepResult::splitOffSingles()
{
  work_.alone.assign(work_.bodies.size(), 0);
  const auto mark = [&](std::size_t m, const IslandContact& touch)
  {
    const FallingRock& rock = world_.rocks[std::size_t(island_.members[m])];
    if (touch.struck > 0.0 && !rock.sim.done())
    {
      work_.alone[std::size_t(rock.place)] = 1;
    }
  };
  for (std::size_t m = 0; m < island_.members.size(); ++m)
  {
    const FallingRock& rock = world_.rocks[std::size_t(island_.members[m])];
    const bool done = rock.sim.done();
    if (!done && rock.fall().impact.pending())
    {
      work_.alone[std::size_t(rock.place)] = 1;
    }
    for (std::size_t k = 0; k < rock.body().contacts.size() && !done; ++k)
    {
      mark(m, work_.contacts[work_.slopeFirsts[m] + k]);
    }
  }
  for (std::size_t k = 0; k < work_.addedTo.size(); ++k)
  {
    if (work_.addedTo[k].onSlope)
    {
      mark(work_.addedTo[k].of, work_.contacts[work_.firsts.back() + k]);
    }
  }
  const auto isAlone = [&](int place) { return place >= 0 && work_.alone[std::size_t(place)]; };
  const auto keep = [&](std::size_t p)
  {
    for (const int place : work_.places[p])
    {
      if (place >= 0)
      {
        work_.alone[std::size_t(place)] = 0;
      }
    }
  };
  for (const IslandWork::Added& added : work_.addedTo)
  {
    if (!added.onSlope)
    {
      keep(added.of);
    }
  }
  for (std::size_t p = 0; p < island_.pairs.size(); ++p)
  {
    if ((isAlone(work_.places[p][0]) || isAlone(work_.places[p][1])) && this->isNearAnother(p))
    {
      keep(p);
    }
  }
}

bool StepResult::isNearAnother(std::size_t p) const
{
  RockPair& pair = *island_.pairs[p];
  const auto [a, b] = work_.places[p];
  if (a < 0 || b < 0)
  {
    return false;
  }
  const IslandContact* const contacts = work_.contacts.data();
  const auto carries = [](const IslandContact& k)
  { return k.closed || k.contact->normalForce > 0.0; };
  if (pair.strikes ||
    std::any_of(contacts + work_.firsts[p], contacts + work_.firsts[p + 1], carries))
  {
    return true;
  }
  double way = 0.0;
  for (const int rock : { pair.first, pair.second })
  {
    const IslandWork::Side& side = work_.sides[std::size_t(rock)];
    way += h_ * (side.velocity.norm() + side.rim + world_.parameters.gravity * h_);
  }
  const double near = kLoneWay * way;
  if (pair.end.distance <= near)
  {
    pair.end = findAxis(world_.rocks[std::size_t(pair.first)].endHull,
      world_.rocks[std::size_t(pair.second)].endHull, pair.end, near);
  }
  return !(pair.end.distance > near);
}

void StepResult::stepSingle(FallingRock& rock)
{
  RockBody& body = rock.body();
  const BlockState from = body.before;
  body.state = from;
  body.contacts = body.contactsBefore;
  body.quietTime = 0.0; // the island comes to rest as a whole
  rock.advanceAlone(from.time + h_);
  this->noteMotion(rock, from);
}

void StepResult::noteMotion(const FallingRock& rock, const BlockState& from)
{
  const BlockState& to = rock.body().state;
  const double r = rock.body().block.radius();
  IslandWork::Motion& motion = work_.motions[std::size_t(rock.place)];
  motion.displacement = to.position - from.position;
  motion.rimTravel =
    rimTravel(from.orientation, to.orientation, r) + r * (to.strain - from.strain).norm();
}

void StepResult::bookContact(RockPair& pair, const IslandContact& touch) const
{
  const Contact& c = *touch.contact;
  RockPair::Impact& impact = pair.impact;
  if (!pair.strikes)
  {
    pair.lastingLoss += touch.work;
    return;
  }
  if (c.normalForce > 0.0)
  {
    impact.impulse += (h_ * c.normalForce) * c.normal;
    if (c.normalForce > impact.largest)
    {
      impact.largest = c.normalForce;
      impact.point = touch.struck > 0.0 ? touch.struckPoint : c.point;
    }
  }
  impact.loss += touch.work;
}

void StepResult::applyToPair(std::size_t t)
{
  const std::size_t p = work_.touching[t];
  RockPair& pair = *island_.pairs[p];
  for (std::size_t k = work_.firsts[p]; k < work_.firsts[p + 1]; ++k)
  {
    findLateImpact(world_, pair, work_.contacts[k], h_);
  }
  for (std::size_t k = work_.firsts[p]; k < work_.firsts[p + 1]; ++k)
  {
    this->bookContact(pair, work_.contacts[k]);
    pair.touched = pair.touched || work_.contacts[k].contact->closed();
  }
  work_.flags[p] = pair.strikes;
  if (!pair.touched)
  {
    return;
  }
  pair.touchedAt = work_.bodies.front().state->time;
  for (const int place : work_.places[p])
  {
    std::atomic_ref(work_.touchesOthers[std::size_t(place)]).store(1, std::memory_order_relaxed);
  }
}

void StepResult::applyAdded()
{
  const double end = work_.bodies.front().state->time;
  for (std::size_t k = 0; k < work_.added.size(); ++k)
  {
    const Contact& c = work_.added[k];
    const IslandWork::Added& added = work_.addedTo[k];
    if (added.onSlope)
    {
      const FallingRock& rock = world_.rocks[std::size_t(island_.members[added.of])];
      if (work_.alone[std::size_t(rock.place)])
      {
        continue;
      }
      RockBody& body = world_.rocks[std::size_t(island_.members[added.of])].body();
      body.contacts.push_back(c);
      body.contactsBefore.push_back(added.before);
      continue;
    }
    RockPair& pair = *island_.pairs[added.of];
    const IslandContact& touch = work_.contacts[work_.firsts.back() + k];
    this->bookContact(pair, touch);
    work_.flags[added.of] = pair.strikes;
    if (c.closed())
    {
      pair.touched = true;
      pair.touchedAt = end;
      const std::size_t first = std::size_t(work_.placeOf[std::size_t(pair.first)]);
      const std::size_t second = std::size_t(work_.placeOf[std::size_t(pair.second)]);
      work_.touchesOthers[first] = work_.touchesOthers[second] = 1;
    }
    pair.contacts.push_back(c);
  }
}

void StepResult::finishImpacts()
{
  for (const IslandWork::Added& added : work_.addedTo)
  {
    if (!added.onSlope && work_.firsts[added.of] == work_.firsts[added.of + 1])
    {
      work_.touching.push_back(added.of);
    }
  }
  if (!work_.addedTo.empty())
  {
    std::sort(work_.touching.begin(), work_.touching.end()); // one may be there twice: it ends once
  }
  for (const std::size_t p : work_.touching)
  {
    if (work_.flags[p])
    {
      finishPairImpact(world_, *island_.pairs[p]);
    }
  }
}

void StepResult::applyToRock(std::size_t k)
{
  FallingRock& rock = world_.rocks[std::size_t(island_.members[k])];
  SingleRock& sim = rock.sim;
  RockBody& body = rock.body();
  if (body.done)
  {
    return;
  }
  const std::size_t place = std::size_t(rock.place);
  work_.arrived[place] = false;
  if (work_.alone[place])
  {
    this->stepSingle(rock);
    return;
  }
  work_.count(sim);
  const IslandBody& answer = work_.bodies[place];
  commitStep(
    sim.fall(), StepKind::Lasting, answer.onSlope, work_.energyBefore[place], answer.given, false);
  const bool carried = work_.touchesOthers[place] || anyClosed(body.contacts);
  // Some contact of an island opens or closes in every step, and the acceleration of one step says
  // little of the next: carried on it would keep a pile in motion for ever.
  if (carried || rock.touching)
  {
    body.acceleration.setZero();
    body.spinAcceleration.setZero();
  }
  rock.touching = work_.touchesOthers[place];
  if (body.done)
  {
    return; // caught
  }
  StepTrees(world_, island_, work_).fell(k);
  checkLeft(sim.fall());
  followRest(sim.fall(), h_, carried);
  if (!body.done && body.state.time >= world_.parameters.endTime - kTooShort)
  {
    sim.fall().end(Fate::Moving);
  }
  const bool arrived = rock.adoptEnd();
  work_.arrived[place] = arrived;
  if (!arrived)
  {
    this->noteMotion(rock, body.before);
  }
}

void StepResult::keepAxis(std::size_t p)
{
  RockPair& pair = *island_.pairs[p];
  const auto [a, b] = work_.places[p];
  const bool both = a >= 0 && b >= 0;
  pair.seen = both && work_.arrived[std::size_t(a)] && work_.arrived[std::size_t(b)];
  if (pair.seen)
  {
    pair.before = pair.axis;
    pair.axis = pair.end;
  }
  else if (both && !pair.touched && !world_.rocks[std::size_t(pair.first)].sim.done() &&
    !world_.rocks[std::size_t(pair.second)].sim.done())
  {
    // The look was before the last sweeps; the two may still be apart as they were.
    const IslandWork::Motion& motion = work_.motions[std::size_t(a)];
    const IslandWork::Motion& other = work_.motions[std::size_t(b)];
    const double gap = pair.axis.distance +
      pair.axis.normal.dot(motion.displacement - other.displacement) - motion.rimTravel -
      other.rimTravel;
    pair.seen = gap > 0.0;
    if (pair.seen)
    {
      pair.before = pair.axis;
      pair.axis.distance = gap;
    }
  }
}

} // namespace rockfall
