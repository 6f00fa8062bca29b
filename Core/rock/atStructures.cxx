// What a rock does at structures: trees that it breaks or passes, barriers that stop it or break.

#include "contact/ground/timeToTouch.h"
#include "law/settings.h"
#include "rock/SingleRock.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

constexpr int kBrakingPieces = 8; ///< In equal times: a quarter of a sine within 2e-2 of its way.

void noteLoad(StructureEvent& event, const BarrierLoad& before, const BarrierState& barrier)
{
  event.heldBefore = before.energy;
  event.usefulHeight = std::max(0.0, barrier.rope - barrier.fill);
}

} // namespace

double SingleRock::freeOfObstacles(double duration)
{
  const double sure = std::min(duration, freeUntil_ - body_.state.time);
  const double free =
    timeToObstacle(body_.placed, body_.state, body_.block, structures_.obstacles(),
      structures_.goneTrees(), parameters_.gravity, this->impactStep(), duration);
  return std::max(sure, free);
}

void SingleRock::forgetPatch()
{
  patch_.xMax = patch_.xMin - 1.0;
  candidates_.distance = -1.0;
}

bool SingleRock::undoAtTrees(double h)
{
  const std::vector<int> hit = structures_.treesHit(body_);
  if (hit.empty())
  {
    return false;
  }
  body_.state = body_.before;
  body_.contacts = body_.contactsBefore;
  return this->breakTrees(h, hit);
}

bool SingleRock::breakTrees(double h, std::span<const int> hit)
{
  const bool any = structures_.breakTrees(h, hit, body_, recorder_.trajectory().structures);
  if (any)
  {
    this->forgetTrees();
  }
  return any;
}

void SingleRock::forgetTrees(bool touched)
{
  std::erase_if(
    body_.contacts, [&](const Contact& c) { return structures_.isGone(structures_.treeOf(c)); });
  if (touched)
  {
    body_.acceleration.setZero();
    body_.spinAcceleration.setZero();
  }
  this->forgetPatch();
}

bool SingleRock::applyBroken(const StructuresOnWay::Broken& broken)
{
  if (!structures_.apply(broken, patch_))
  {
    return false;
  }
  // Energy of the springs against a stem goes with it.
  double held = 0.0;
  bool touched = false;
  for (const Contact& c : body_.contacts)
  {
    if (structures_.isGone(structures_.treeOf(c)))
    {
      held += c.springEnergy();
      touched = touched || c.closed();
    }
  }
  body_.springEnergy = std::max(0.0, body_.springEnergy - held);
  body_.energy.structures += held;
  this->forgetTrees(touched);
  return touched;
}

bool SingleRock::passBarriers(const PathPiece& way, double taken)
{
  structures_.passBarriers(
    way, taken, parameters_.gravity, body_, recorder_.trajectory().structures);
  return structures_.hit().barrier >= 0;
}

void SingleRock::meetBarrier()
{
  const BarrierHit& hit = structures_.hit();
  const Barrier& barrier = structures_.barrierHit();
  const double kinetic = rigidKineticEnergy(body_.block, body_.state),
               energy = kinetic + hit.stored;
  const BarrierLoad load = structures_.loadOf(hit.barrier);
  const BarrierState net = stateOf(barrier, load);
  const bool holds = energy <= net.capacity;
  const double taken = holds ? energy : barrier.absorbs ? net.capacity : 0.0;
  StructureEvent event =
    eventAt(holds ? StructureOutcome::BarrierStopped : StructureOutcome::BarrierBroken,
      barrier.feature, body_.state, energy, hit.heightOverGround);
  event.energyTaken = taken;
  noteLoad(event, load, net);
  TrajectorySummary& summary = recorder_.trajectory().summary;
  if (holds)
  {
    this->finishImpact(false); // the barrier takes what it would have left
    event.brakingDistance = brakingDistance(barrier, load, energy);
    if (isLoaded(barrier))
    {
      structures_.load({ energy, body_.block.volume() });
    }
  }
  recorder_.trajectory().structures.push_back(event);
  recorder_.knot(body_.state, false);
  this->auditSamples(body_.state);
  if (!holds || !this->brakeBehindNet(event.brakingDistance))
  {
    slowDown(body_.state, kinetic, std::min(taken, kinetic));
    body_.energy.structures += kinetic - rigidKineticEnergy(body_.block, body_.state);
  }
  if (holds)
  {
    summary.fate = Fate::Caught;
    body_.contacts.clear();
    body_.done = true;
    return;
  }
  structures_.breakBarrier();
  freeUntil_ = 0.0;
  body_.state.time += kInstant;
  recorder_.knot(body_.state, false);
  this->auditSamples(body_.state);
}

bool SingleRock::brakeBehindNet(double distance)
{
  const BlockState start = body_.state;
  const double speed = start.velocity.norm(), across = start.velocity.head<2>().norm();
  const double duration = 0.5 * std::numbers::pi * distance / speed;
  if (!(distance > 0.0) || !(across > 0.0) || !(start.time + duration <= parameters_.endTime))
  {
    return false;
  }
  // As the ground goes down or up on a level way of that length.
  const Eigen::Vector2d level = start.velocity.head<2>() / across;
  const auto ground = [&](double way)
  {
    const Eigen::Vector2d place = start.position.head<2>() + way * level;
    return std::max(surface_.elevation(place.x(), place.y()),
      structures_.obstacles().embankmentTop(place.x(), place.y()));
  };
  const double rise = ground(distance) - ground(0.0);
  if (std::isnan(rise))
  {
    return false;
  }
  const Vec3 along = Vec3(level.x(), level.y(), rise / distance).normalized();
  BlockState at = start;
  at.velocity = speed * along;
  for (int k = 1; k <= kBrakingPieces; ++k)
  {
    const BlockState before = at;
    const double phase = 0.5 * std::numbers::pi * k / kBrakingPieces;
    const double left = k < kBrakingPieces ? std::cos(phase) : 0.0;
    at.time = start.time + duration * k / kBrakingPieces;
    at.position = start.position + distance * std::sin(phase) * along;
    at.velocity = left * speed * along;
    at.spin = left * start.spin;
    // What the rock still falls is taken, too; a net is rated by the energy at its line.
    body_.energy.structures += rigidKineticEnergy(body_.block, before) -
      rigidKineticEnergy(body_.block, at) +
      body_.block.mass() * parameters_.gravity * (before.position.z() - at.position.z());
    body_.state = at;
    recorder_.recordBetween(before, at, false);
    this->auditSamples(at);
    recorder_.follow(at);
  }
  return true;
}

double SingleRock::endStepAtBarrier(const BlockState& end, double taken, bool touching)
{
  const BarrierHit& hit = structures_.hit();
  const Barrier& barrier = structures_.barrierHit();
  BlockState at = between(body_.before, end, hit.fraction);
  const double came = rigidKineticEnergy(body_.block, at);
  slowDown(at, came, std::min(taken, came));
  const double energy = rigidKineticEnergy(body_.block, at) + hit.stored;
  const BarrierLoad load = structures_.loadOf(hit.barrier);
  const BarrierState net = stateOf(barrier, load);
  if (energy <= net.capacity)
  {
    // The rest of the step did not happen; what it booked did. The barrier takes what makes it up.
    recorder_.recordBetween(body_.before, at, touching);
    body_.energy.structures += kineticEnergy(body_.block, body_.state) -
      kineticEnergy(body_.block, at) +
      body_.block.mass() * parameters_.gravity * (end.position.z() - at.position.z()) +
      body_.springEnergy;
    body_.state = at;
    body_.springEnergy = body_.normalEnergy = 0.0;
    recorder_.follow(body_.state);
    this->meetBarrier();
    return 0.0;
  }
  StructureEvent event =
    eventAt(StructureOutcome::BarrierBroken, barrier.feature, at, energy, hit.heightOverGround);
  const double left = rigidKineticEnergy(body_.block, body_.state);
  slowDown(body_.state, left, barrier.absorbs ? std::min(net.capacity, left) : 0.0);
  noteLoad(event, load, net);
  event.energyTaken = left - rigidKineticEnergy(body_.block, body_.state);
  body_.energy.structures += event.energyTaken;
  recorder_.trajectory().structures.push_back(event);
  structures_.breakBarrier();
  return event.energyTaken;
}

} // namespace rockfall
