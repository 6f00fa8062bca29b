#include "rock/fall/atStructures.h"

#include "block/flight.h"
#include "contact/ground/timeToTouch.h"
#include "law/settings.h"
#include "rock/fall/Fall.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

constexpr int kBrakingPieces = 8;   ///< In equal times: a quarter of a sine within 2e-2 of its way.
constexpr int kBrakingPlaces = 120; ///< Looked at for room: decimetres of 12 m.

/// What is left of the barrier that the rock hits.
BarrierState barrierNow(const Fall& fall)
{
  return stateOf(
    fall.structures.barrierHit(), fall.structures.loadOf(fall.structures.hit().barrier));
}

/// The barrier that the rock hits does not hold it, where it is `at` with this energy, J.
void breakBarrier(Fall& fall, const BlockState& at, double energy, double taken)
{
  const BarrierHit& hit = fall.structures.hit();
  StructureEvent event = eventAt(StructureOutcome::BarrierBroken,
    fall.structures.barrierHit().feature, fall.body.block, at, energy, hit.heightOverGround);
  noteLoad(event, fall.structures.loadOf(hit.barrier), barrierNow(fall));
  event.energyTaken = taken;
  fall.recorder.trajectory().structures.push_back(event);
  fall.structures.breakBarrier();
}

/// The rock goes on to `at` within a net, which takes what the rock loses and still falls: the net
/// is rated by the energy at its line.
void brakeTo(Fall& fall, const BlockState& at)
{
  RockBody& body = fall.body;
  const BlockState before = body.state;
  body.energy.structures += rigidKineticEnergy(body.block, before) -
    rigidKineticEnergy(body.block, at) +
    body.block.mass() * fall.parameters.gravity * (before.position.z() - at.position.z());
  body.state = at;
  fall.recorder.recordBetween(body, before, at, false);
  fall.recorder.follow(at);
}

/// Braking with barriers on the way but for the net itself, `own`. Whether one of them holds the rock
/// where it comes to it.
bool brakePast(Fall& fall, const BlockState& at, int own)
{
  RockBody& body = fall.body;
  const BlockState before = body.state;
  const Way way{ before, at, at.time - before.time, false };
  fall.structures.findBarriers(way, fall.parameters.gravity, body.block.radius());
  while (passBarriers(fall, way, 0.0))
  {
    const BarrierHit& hit = fall.structures.hit();
    if (hit.barrier == own)
    {
      continue;
    }
    const BlockState there = between(before, at, hit.fraction);
    const double energy = rigidKineticEnergy(body.block, there);
    if (energy <= barrierNow(fall).capacity)
    {
      brakeTo(fall, there);
      meetBarrier(fall);
      return true;
    }
    breakBarrier(fall, there, energy, 0.0);
  }
  brakeTo(fall, at);
  return false;
}

/// A held rock comes to rest on a straight way of this length b (m), as steep as the ground, with the
/// speed v √(1 − (x/b)²) of a spring, or before ground or an embankment higher than its centre.
/// Barriers on the way are met. False, and nothing done, where the way would lead off the slope or
/// past the end time.
bool brakeBehindNet(Fall& fall, double distance)
{
  RockBody& body = fall.body;
  const int own = fall.structures.hit().barrier;
  const BlockState start = body.state;
  const double speed = start.velocity.norm(), across = start.velocity.head<2>().norm();
  const double quarter = 0.5 * std::numbers::pi * distance / speed;
  if (!(distance > 0.0) || !(across > 0.0) || !(start.time + quarter <= fall.parameters.endTime))
  {
    return false;
  }
  const Eigen::Vector2d level = start.velocity.head<2>() / across;
  const auto slope = [&](double way)
  {
    const Eigen::Vector2d place = start.position.head<2>() + way * level;
    return fall.surface.elevation(place.x(), place.y());
  };
  const auto ground = [&](double way)
  {
    const Eigen::Vector2d place = start.position.head<2>() + way * level;
    return std::max(slope(way), fall.structures.obstacles().embankmentTop(place.x(), place.y()));
  };
  if (std::isnan(ground(distance)))
  {
    return false;
  }
  // Down with all ground, up with the slope alone.
  const double centre = start.position.z() - ground(0.0);
  double room = 0.0, foot = ground(0.0), rise = 0.0;
  for (int k = 1; k <= kBrakingPlaces; ++k)
  {
    const double next = std::min(distance, distance * k / kBrakingPlaces); // no rounding beyond it
    foot = std::min(ground(next), foot + std::max(0.0, slope(next) - slope(room)));
    if (!(ground(next + body.block.radius()) <= foot + centre))
    {
      break;
    }
    room = next;
    rise = foot - ground(0.0);
  }
  const Vec3 along = Vec3(level.x(), level.y(), room > 0.0 ? rise / room : 0.0).normalized();
  const double last = std::asin(room / distance); // of the quarter of a sine
  BlockState at = start;
  body.state.velocity = speed * along;
  body.springEnergyBefore = 0.0;
  for (int k = 1; k <= kBrakingPieces; ++k)
  {
    const double phase = last * k / kBrakingPieces;
    const double left = k < kBrakingPieces ? std::cos(phase) : 0.0;
    at.time = start.time + distance / speed * phase;
    at.position = start.position + distance * std::sin(phase) * along;
    at.velocity = left * speed * along;
    at.spin = left * start.spin;
    if (brakePast(fall, at, own))
    {
      break;
    }
  }
  return true;
}

} // namespace

double freeOfObstacles(Fall& fall, double duration)
{
  RockBody& body = fall.body;
  const double sure = std::min(duration, fall.freeUntil - body.state.time);
  const double free = timeToObstacle(body.placed, body.state, body.block,
    fall.structures.obstacles(), fall.structures.goneTrees(), fall.parameters.gravity,
    fall.springs.impactStep(body), duration);
  return std::max(sure, free);
}

bool undoAtTrees(Fall& fall, double h)
{
  RockBody& body = fall.body;
  const std::vector<int> hit = fall.structures.treesHit(body);
  if (hit.empty())
  {
    return false;
  }
  body.state = body.before;
  body.contacts = body.contactsBefore;
  return breakTrees(fall, h, hit);
}

bool breakTrees(Fall& fall, double h, std::span<const int> hit)
{
  const bool any =
    fall.structures.breakTrees(h, hit, fall.body, fall.recorder.trajectory().structures);
  if (any)
  {
    forgetTrees(fall);
  }
  return any;
}

void forgetTrees(Fall& fall, bool touched)
{
  RockBody& body = fall.body;
  std::erase_if(body.contacts,
    [&](const Contact& c) { return fall.structures.isGone(fall.structures.treeOf(c)); });
  if (touched)
  {
    body.acceleration.setZero();
    body.spinAcceleration.setZero();
  }
  fall.ground.forgetPatch();
}

bool applyBroken(Fall& fall, const StructuresOnWay::Broken& broken)
{
  RockBody& body = fall.body;
  if (!fall.structures.apply(broken, fall.ground.patch()))
  {
    return false;
  }
  // Energy of the springs against a stem goes with it.
  double held = 0.0;
  bool touched = false;
  for (const Contact& c : body.contacts)
  {
    if (fall.structures.isGone(fall.structures.treeOf(c)))
    {
      held += c.springEnergy();
      touched = touched || c.closed();
    }
  }
  body.springEnergy = std::max(0.0, body.springEnergy - held);
  body.energy.structures += held;
  forgetTrees(fall, touched);
  return touched;
}

bool passBarriers(Fall& fall, const Way& way, double taken)
{
  fall.structures.passBarriers(
    way, taken, fall.parameters.gravity, fall.body, fall.recorder.trajectory().structures);
  return fall.structures.hit().barrier >= 0;
}

bool holdsAtBarrier(const Fall& fall)
{
  return rigidKineticEnergy(fall.body.block, fall.body.state) + fall.structures.hit().stored <=
    barrierNow(fall).capacity;
}

void meetBarrier(Fall& fall)
{
  RockBody& body = fall.body;
  const BarrierHit& hit = fall.structures.hit();
  const Barrier& barrier = fall.structures.barrierHit();
  const double kinetic = rigidKineticEnergy(body.block, body.state), energy = kinetic + hit.stored;
  const BarrierLoad load = fall.structures.loadOf(hit.barrier);
  const BarrierState net = barrierNow(fall);
  const bool holds = holdsAtBarrier(fall);
  const double taken = holds ? energy : barrier.absorbs ? net.capacity : 0.0;
  StructureEvent event =
    eventAt(holds ? StructureOutcome::BarrierStopped : StructureOutcome::BarrierBroken,
      barrier.feature, body.block, body.state, energy, hit.heightOverGround);
  event.energyTaken = taken;
  noteLoad(event, load, net);
  TrajectorySummary& summary = fall.recorder.trajectory().summary;
  if (holds)
  {
    fall.impact.finish(body, fall.recorder, false); // the barrier takes what it would have left
    event.brakingDistance = brakingDistance(barrier, load, energy);
    if (isLoaded(barrier))
    {
      fall.structures.load({ energy, body.block.volume() });
    }
  }
  fall.recorder.trajectory().structures.push_back(event);
  fall.recorder.knot(body, false);
  if (!holds || !brakeBehindNet(fall, event.brakingDistance))
  {
    slowDown(body.state, kinetic, std::min(taken, kinetic));
    body.energy.structures += kinetic - rigidKineticEnergy(body.block, body.state);
  }
  if (holds)
  {
    summary.fate = Fate::Caught;
    body.contacts.clear();
    body.done = true;
    return;
  }
  fall.structures.breakBarrier();
  fall.freeUntil = 0.0;
  body.state.time += kInstant;
  fall.recorder.knot(body, false);
}

namespace
{

/// The one that the rock hits, in a step that would go to `end` and in which others have taken so
/// much (J); returns what this one takes if it breaks.
double endStepAtBarrier(Fall& fall, const BlockState& end, double taken, bool touching)
{
  RockBody& body = fall.body;
  const BarrierHit& hit = fall.structures.hit();
  const Barrier& barrier = fall.structures.barrierHit();
  BlockState at = between(body.before, end, hit.fraction);
  const double came = rigidKineticEnergy(body.block, at);
  slowDown(at, came, std::min(taken, came));
  const double energy = rigidKineticEnergy(body.block, at) + hit.stored;
  const double capacity = barrierNow(fall).capacity;
  if (energy <= capacity)
  {
    // The rest of the step did not happen; what it booked did. The barrier takes what makes it up.
    body.energy.structures += kineticEnergy(body.block, body.state) -
      kineticEnergy(body.block, at) +
      body.block.mass() * fall.parameters.gravity * (end.position.z() - at.position.z()) +
      body.springEnergy;
    body.state = at;
    body.springEnergy = body.normalEnergy = 0.0;
    fall.recorder.recordBetween(body, body.before, at, touching);
    fall.recorder.follow(body.state);
    meetBarrier(fall);
    return 0.0;
  }
  const double left = rigidKineticEnergy(body.block, body.state);
  slowDown(body.state, left, barrier.absorbs ? std::min(capacity, left) : 0.0);
  const double gone = left - rigidKineticEnergy(body.block, body.state);
  body.energy.structures += gone;
  fall.freeUntil = 0.0;
  breakBarrier(fall, at, energy, gone);
  return gone;
}

} // namespace

bool passBarriersInStep(Fall& fall, bool touching)
{
  const RockBody& body = fall.body;
  const BlockState end = body.state;
  double lost = 0.0;
  const Way way{ body.before, end, end.time - body.before.time, false };
  fall.structures.findBarriers(way, fall.parameters.gravity, body.block.radius());
  while (passBarriers(fall, way, lost))
  {
    lost += endStepAtBarrier(fall, end, lost, touching);
    if (body.done)
    {
      return false;
    }
  }
  return true;
}

} // namespace rockfall
