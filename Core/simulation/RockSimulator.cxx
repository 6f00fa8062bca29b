#include "simulation/RockSimulator.h"

#include "base/abort.h"
#include "block/flight.h"
#include "contact/clearance.h"
#include "contact/detection.h"
#include "contact/timeToTouch.h"
#include "law/settings.h"
#include "law/springs.h"
#include "simulation/placement.h"
#include "simulation/pressOut.h"
#include "terrain/walls.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace rockfall
{

namespace
{

/// Frequencies of a block on the springs of several contacts, squared, 1/s².
struct ImpactFrequency
{
  double sum = 0.0;      ///< Of each alone.
  double together = 0.0; ///< Of what they stop together (impactMode.h).

  void add(const Contact& c, bool acts)
  {
    this->sum += acts ? c.frequency2 : 0.0;
    this->together = std::max(this->together, acts ? c.stiffness / c.stopped : 0.0);
  }
  /// `one`: of one where the block is turned best.
  double ofAll(double one) const
  {
    return std::min(this->sum, std::max({ one, kOneMotionShare * this->sum, this->together }));
  }
};

} // namespace

RockSimulator::RockSimulator(const Surface& surface, const Rock& rock, const Block& block,
  const SimulationParameters& p, std::uint32_t number)
  : surface_(surface)
  , rock_(rock)
  , block_(block)
  , parameters_(p)
  , number_(number)
  , recorder_(surface, block, p.outputInterval)
{
  state_.position = rock.position;
  state_.orientation = rock.orientation.normalized();
  state_.velocity = rock.velocity;
  state_.spin = state_.orientation.conjugate() * rock.angularVelocity;
  const double g = std::max(p.gravity, kLeastGravity);
  restingSpeed_ = kRestingSpeed * std::sqrt(g * block.radius());
  penalty_ = p.normalPenalty;
  const double contacts = std::sqrt(p.normalPenalty * block.largestMobility());
  obstacles_ = surface.terrain().obstacles();
  solid_ = obstacles_ && obstacles_->solid();
  yields_ = surface.terrain().yields();
  barriers_ = obstacles_ && !obstacles_->structures().barriers.empty();
  stiff_ =
    p.rigid || block.strainFrequency() >= std::min(kStiffBesideContacts * contacts, kFastVibration);
  ringing_ = stiff_ ? 0.0 : 2.0 * std::numbers::pi / block.strainFrequency();
  softness_ = 1.0 / p.normalPenalty + block.largestCompliance();
}

double RockSimulator::travelLimit() const
{
  const double rim = state_.spin.norm() * block_.radius();
  const double speed = state_.velocity.norm() + rim + parameters_.gravity * parameters_.timeStep;
  return speed > 0.0 ? kTravelPerStep * block_.radius() / speed : parameters_.timeStep;
}

double RockSimulator::impactStep() const
{
  ImpactFrequency closed;
  for (const Contact& c : contacts_)
  {
    closed.add(c, c.closed());
  }
  const double one = penalty_ * block_.largestMobility();
  const double frequency2 = closed.sum > 0.0 ? closed.ofAll(one) : one;
  const double resolved = std::numbers::pi / (kStepsPerImpact * std::sqrt(frequency2));
  return std::min({ parameters_.timeStep, resolved, this->travelLimit() });
}

double RockSimulator::touchdownStep(double h) const
{
  ImpactFrequency closing;
  const Vec3 spin = state_.angularVelocity();
  for (const Contact& c : contacts_)
  {
    const double approach = -c.normal.dot(state_.velocity + spin.cross(c.point - state_.position));
    closing.add(c, c.closed() || c.gap() < approach * h);
  }
  const double frequency2 = closing.ofAll(penalty_ * block_.largestMobility());
  return std::min(h, std::numbers::pi / (kStepsPerImpact * std::sqrt(frequency2)));
}

double RockSimulator::mechanicalEnergy() const
{
  return kineticEnergy(block_, state_) + strainEnergy(block_, state_) +
    block_.mass() * parameters_.gravity * state_.position.z();
}

EnergyAudit RockSimulator::auditAt(const BlockState& state) const
{
  EnergyAudit audit = energy_;
  audit.kinetic = kineticEnergy(block_, state);
  audit.strain = strainEnergy(block_, state) + springEnergy_;
  audit.released = energyAtStart_ - block_.mass() * parameters_.gravity * state.position.z();
  audit.numerical = audit.released -
    (audit.kinetic + audit.strain + audit.friction + audit.restitution + audit.vibration +
      audit.damping + audit.structures + audit.scars + audit.rolling + audit.exchanged);
  return audit;
}

void RockSimulator::auditSamples(const BlockState& state)
{
  if (recorder_.needsAudit())
  {
    recorder_.audit(this->auditAt(state));
  }
}

std::array<double, 4> RockSimulator::boxOfWay(double duration) const
{
  const double r = block_.radius();
  const Vec3& p = state_.position;
  const Vec3 end = p + duration * state_.velocity;
  return { std::min(p.x(), end.x()) - r, std::max(p.x(), end.x()) + r, std::min(p.y(), end.y()) - r,
    std::max(p.y(), end.y()) + r };
}

void RockSimulator::ensureWindow(double duration)
{
  const auto [x0, x1, y0, y1] = this->boxOfWay(duration);
  if (!window_.covers(x0, x1, y0, y1))
  {
    window_.gather(surface_, x0, x1, y0, y1);
  }
}

double RockSimulator::timeToGround(double duration)
{
  if (window_.whole())
  {
    return timeToTouch(placed_, state_, window_, parameters_.gravity, duration);
  }
  // A rock over a hole has no gap to close: it comes to a rim or a wall from beside.
  const auto [x0, x1, y0, y1] = this->boxOfWay(duration);
  if (!holed_.covers(x0, x1, y0, y1))
  {
    gatherPatch(surface_, x0, x1, y0, y1, holed_);
  }
  return clearance(placed_, state_, holed_, parameters_.gravity, duration).time;
}

bool RockSimulator::clearFor(double duration) const
{
  const double r = block_.radius();
  const Vec3& p = state_.position;
  const Vec3 end = p + duration * state_.velocity;
  const double zEnd = end.z() - 0.5 * parameters_.gravity * duration * duration;
  // The parabola is concave: its lowest point is at one of its ends.
  const double lowest = std::min(p.z(), zEnd) - r;
  return surface_.maxHeight(std::min(p.x(), end.x()) - r, std::max(p.x(), end.x()) + r,
           std::min(p.y(), end.y()) - r, std::max(p.y(), end.y()) + r) < lowest;
}

void RockSimulator::advanceInFlight(double duration)
{
  const BlockState start = state_;
  BlockState reached = start;
  const Way way{ start, reached, duration, true };
  if (barriers_)
  {
    reached.position = placeInFlight(start, parameters_.gravity, duration);
    this->findBarriers(way);
    this->passBarriers(way, 0.0);
    duration = hit_.barrier >= 0 ? hit_.fraction * duration : duration;
  }
  const double end = start.time + duration;
  BlockState at = start;
  while (!scar_.open() && recorder_.nextTime() <= end)
  {
    at = fly(block_, at, parameters_.gravity, std::max(0.0, recorder_.nextTime() - at.time));
    recorder_.record(at, false);
    this->auditSamples(at);
  }
  if (scar_.open())
  {
    this->flyThroughSoil(duration);
    state_.time = end;
    recorder_.recordBetween(start, state_, false);
    this->auditSamples(state_);
    recorder_.follow(state_);
  }
  else
  {
    state_ = fly(block_, start, parameters_.gravity, duration);
    state_.time = end;
    recorder_.followFlight(start, state_);
  }
  this->forgetSlip(duration);
  while (barriers_ && !done_ && hit_.barrier >= 0)
  {
    this->meetBarrier();
    this->passBarriers(way, 0.0);
  }
}

void RockSimulator::flyUntilNear()
{
  while (!done_ && !this->arrived() && !scar_.open())
  {
    stayWanted();
    // Up to the edge of the slope, where the rock is let go.
    double remaining = horizon_ - state_.time;
    const double extent[2] = { surface_.terrain().width(), surface_.terrain().height() };
    for (int axis = 0; axis < 2; ++axis)
    {
      const double v = state_.velocity[axis];
      const double way = v > 0.0 ? extent[axis] - state_.position[axis] : state_.position[axis];
      if (v != 0.0)
      {
        // A hair beyond, so that the edge is passed and not met for ever.
        remaining =
          std::min(remaining, (way + 1e-9 * block_.radius() + 1e-15 * extent[axis]) / std::abs(v));
      }
    }
    double duration = std::min(kLongFlight, remaining);
    if (!this->clearFor(duration))
    {
      // A window over some of the way: nearer than its plane only the rock itself is looked at.
      const double across = state_.velocity.head<2>().norm();
      const double way = kHeightWindow * std::max(block_.radius(), surface_.grid().cellSize);
      duration = std::min(duration, across * duration > way ? way / across : duration);
      this->ensureWindow(duration);
      const double near =
        timeToNear(state_, block_.radius(), window_, parameters_.gravity, duration);
      if (near > this->impactStep())
      {
        duration = near;
      }
      else
      {
        placed_.place(block_, state_);
        const double sure = std::max(0.0, freeUntil_ - state_.time);
        const double touch = std::max(sure, this->timeToGround(duration));
        // So near that the pairs that can touch tell more.
        const double speed = state_.velocity.norm() + block_.largestRimSpeed(state_.spin);
        const double close = 0.5 * kCandidateSlack * block_.radius() / std::max(speed, 1e-9);
        if (sure == 0.0 && touch < std::min(duration, std::max(close, this->impactStep())))
        {
          return;
        }
        duration = std::min(duration, touch);
      }
    }
    if (solid_)
    {
      const double free = this->freeOfObstacles(duration);
      if (free < std::min(duration, this->impactStep()))
      {
        return;
      }
      duration = free;
    }
    this->advanceInFlight(duration);
    this->checkEnd(0.0);
  }
}

void RockSimulator::checkLeft()
{
  const Terrain& terrain = surface_.terrain();
  const Vec3& p = state_.position;
  const double r = block_.radius();
  bool left =
    !(p.x() >= 0.0 && p.y() >= 0.0 && p.x() <= terrain.width() && p.y() <= terrain.height());
  if (!left && !this->isHighAt(p, 0.0) && terrain.cfeAt(p.x(), p.y()) == 0)
  {
    // Over a hole it has left once it is below everything around; the bound costs next to nothing.
    const double x0 = p.x() - r, x1 = p.x() + r, y0 = p.y() - r, y1 = p.y() + r;
    left = p.z() < terrain.lowest() - 2.0 * r ||
      (p.z() + r < surface_.maxHeight(x0, x1, y0, y1) &&
        p.z() + r < lowestNode(surface_, x0, x1, y0, y1));
  }
  if (left)
  {
    recorder_.trajectory().summary.fate = Fate::LeftDomain;
    done_ = true;
  }
}

void RockSimulator::followRest(double h, bool touching)
{
  const double r = block_.radius();
  const double speed = state_.velocity.norm() + state_.spin.norm() * r;
  const double still = kStillSpeed * std::sqrt(std::max(parameters_.gravity, kLeastGravity) * r);
  quietTime_ = touching && speed < still ? quietTime_ + h : 0.0;
}

void RockSimulator::checkEnd(double h)
{
  if (!done_)
  {
    this->checkLeft();
  }
  if (done_)
  {
    return;
  }
  TrajectorySummary& summary = recorder_.trajectory().summary;
  this->followRest(h,
    std::any_of(contacts_.begin(), contacts_.end(), [](const Contact& c) { return c.closed(); }));
  if (quietTime_ >= kStillTime)
  {
    summary.fate = Fate::Rested;
    done_ = true;
  }
  else if (state_.time >= parameters_.endTime - 1e-9)
  {
    summary.fate = Fate::Moving;
    done_ = true;
  }
}

void RockSimulator::liftOntoGround()
{
  // The placement was checked on the slope as surveyed; roughness can raise the ground into the
  // rock. By steps, so it ends a hair over the ground.
  const double step = 0.01 * block_.radius();
  if (solid_)
  {
    this->clearTrees();
  }
  placed_.place(block_, state_);
  this->ensurePatch(step);
  double depth = penetration(placed_, patch_);
  // A rock that starts in the ground by rounding alone is set onto it by what follows.
  const double worldZ = state_.position.z() + surface_.terrain().geometry().origin().z();
  const double least = std::max(1e-6 * block_.radius(), startRounding(worldZ, block_.radius()));
  for (int k = 0; k < 1000 && depth > least; ++k)
  {
    state_.position.z() += std::max(depth, step);
    placed_.place(block_, state_);
    depth = penetration(placed_, patch_);
  }
  // Edges across each other are not seen by that, and embankments may be upright walls.
  state_.position.z() += liftOut(placed_, patch_);
  placed_.place(block_, state_);
}

void RockSimulator::release()
{
  this->liftOntoGround();
  this->begin();
}

void RockSimulator::begin()
{
  TrajectorySummary& summary = recorder_.trajectory().summary;
  summary.blockId = rock_.blockId;
  summary.mass = block_.mass();
  summary.volume = block_.volume();
  energyAtStart_ = this->mechanicalEnergy();
  recorder_.begin(state_);
  this->auditSamples(state_);
  this->checkEnd(0.0);
}

double RockSimulator::stoppingPenalty() const
{
  // All that moves in one spring.
  const double depth =
    std::min(kDeepestImpact * block_.radius(), kDeepestOfThin * block_.thickness());
  return std::max(
    parameters_.normalPenalty, 2.0 * rigidKineticEnergy(block_, state_) / (depth * depth));
}

void RockSimulator::beginContact()
{
  penalty_ = this->stoppingPenalty();
  steppedAs_ = StepKind::Lasting; // no impact's step to go by yet
  openTime_ = ringing_;
  inContact_ = true;
  recorder_.knot(state_, false);
  this->auditSamples(state_);
}

void RockSimulator::endContact()
{
  inContact_ = false;
  recorder_.knot(state_, false);
  this->auditSamples(state_);
}

void RockSimulator::advance(double until, double enough)
{
  if (crowded_)
  {
    crowded_ = false; // alone, and what others have pressed in is theirs
    this->letDeepBe(kLooseOverlap * block_.radius());
  }
  horizon_ = std::min(until, parameters_.endTime);
  const auto seen = [&]
  {
    // A knot that is the last sample may still be replaced.
    const std::vector<Sample>& samples = recorder_.trajectory().samples;
    const std::size_t last = samples.size() - 1;
    return samples[last].kind != SampleKind::Knot ? samples[last].time >= enough
                                                  : last > 0 && samples[last - 1].time >= enough;
  };
  while (!done_ && !this->arrived() && !seen())
  {
    if (!inContact_)
    {
      this->flyUntilNear();
      if (done_ || this->arrived())
      {
        return;
      }
      this->beginContact();
    }
    this->stayInContact();
  }
}

Trajectory RockSimulator::finish()
{
  TrajectorySummary& summary = recorder_.trajectory().summary;
  const bool touching =
    std::any_of(contacts_.begin(), contacts_.end(), [](const Contact& c) { return c.closed(); });
  this->finishImpact(false);
  recorder_.end(state_, touching);
  // One that ends later may have begun earlier.
  std::vector<ImpactEvent>& impacts = recorder_.trajectory().impacts;
  std::stable_sort(impacts.begin(), impacts.end(),
    [](const ImpactEvent& a, const ImpactEvent& b) { return a.time < b.time; });
  summary.stop = state_.position;
  summary.endTime = state_.time;
  summary.runOut = (state_.position - summary.start).head<2>().norm();
  this->auditSamples(state_);
  summary.energy = this->auditAt(state_);
  return std::move(recorder_.trajectory());
}

Trajectory RockSimulator::run(double enough)
{
  this->release();
  this->advance(parameters_.endTime, enough);
  return this->finish();
}

} // namespace rockfall
