#include "rock/SingleRock.h"

#include "base/abort.h"
#include "block/flight.h"
#include "contact/ground/detection.h"
#include "contact/ground/timeToTouch.h"
#include "geometry/roundBody.h"
#include "law/settings.h"
#include "law/springs.h"
#include "rock/overlapRecovery.h"
#include "rock/placement.h"
#include "terrain/holes.h"
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

SingleRock::SingleRock(const Surface& surface, const Rock& rock, const Block& block,
  const SimulationParameters& p, std::uint32_t number)
  : surface_(surface)
  , rock_(rock)
  , parameters_(p)
  , number_(number)
  , body_(block)
  , structures_(surface)
  , recorder_(surface, block, p.outputInterval)
{
  body_.state.position = rock.position;
  body_.state.orientation = rock.orientation.normalized();
  body_.state.velocity = rock.velocity;
  body_.state.spin = body_.state.orientation.conjugate() * rock.angularVelocity;
  const double g = std::max(p.gravity, kLeastGravity);
  body_.restingSpeed = kRestingSpeed * std::sqrt(g * block.radius());
  penalty_ = p.normalPenalty;
  const double contacts = std::sqrt(p.normalPenalty * block.largestMobility());
  yields_ = surface.terrain().yields();
  stiff_ =
    p.rigid || block.strainFrequency() >= std::min(kStiffBesideContacts * contacts, kFastVibration);
  ringing_ = stiff_ ? 0.0 : 2.0 * std::numbers::pi / block.strainFrequency();
  impulses_ = stiff_ && !yields_ && p.impactResolution == ImpactResolution::Impulse &&
    !isRound(block.shape().layout());
  softness_ = 1.0 / p.normalPenalty + block.largestCompliance();
}

double SingleRock::travelLimit() const
{
  const double rim = body_.state.spin.norm() * body_.block.radius();
  const double speed =
    body_.state.velocity.norm() + rim + parameters_.gravity * parameters_.timeStep;
  return speed > 0.0 ? kTravelPerStep * body_.block.radius() / speed : parameters_.timeStep;
}

double SingleRock::impactStep() const
{
  ImpactFrequency closed;
  for (const Contact& c : body_.contacts)
  {
    closed.add(c, c.closed());
  }
  const double one = penalty_ * body_.block.largestMobility();
  const double frequency2 = closed.sum > 0.0 ? closed.ofAll(one) : one;
  const double resolved = std::numbers::pi / (kStepsPerImpact * std::sqrt(frequency2));
  return std::min({ parameters_.timeStep, resolved, this->travelLimit() });
}

double SingleRock::touchdownStep(double h) const
{
  ImpactFrequency closing;
  const Vec3 spin = body_.state.angularVelocity();
  for (const Contact& c : body_.contacts)
  {
    const double approach =
      -c.normal.dot(body_.state.velocity + spin.cross(c.point - body_.state.position));
    closing.add(c, c.closed() || c.gap() < approach * h);
  }
  const double frequency2 = closing.ofAll(penalty_ * body_.block.largestMobility());
  return std::min(h, std::numbers::pi / (kStepsPerImpact * std::sqrt(frequency2)));
}

double SingleRock::mechanicalEnergy() const
{
  return kineticEnergy(body_.block, body_.state) + strainEnergy(body_.block, body_.state) +
    body_.block.mass() * parameters_.gravity * body_.state.position.z();
}

EnergyAudit SingleRock::auditAt(const BlockState& state) const
{
  EnergyAudit audit = body_.energy;
  audit.kinetic = kineticEnergy(body_.block, state);
  audit.strain = strainEnergy(body_.block, state) + body_.springEnergy;
  audit.released = energyAtStart_ - body_.block.mass() * parameters_.gravity * state.position.z();
  audit.numerical = audit.released -
    (audit.kinetic + audit.strain + audit.friction + audit.restitution + audit.vibration +
      audit.damping + audit.structures + audit.scars + audit.rolling + audit.exchanged);
  return audit;
}

void SingleRock::auditSamples(const BlockState& state)
{
  if (recorder_.needsAudit())
  {
    recorder_.audit(this->auditAt(state));
  }
}

void SingleRock::advanceInFlight(double duration)
{
  const BlockState start = body_.state;
  BlockState reached = start;
  const PathPiece way{ start, reached, duration, true };
  if (structures_.hasBarriers())
  {
    reached.position = placeInFlight(start, parameters_.gravity, duration);
    structures_.findBarriers(way, parameters_.gravity, body_.block.radius());
    duration = this->passBarriers(way, 0.0) ? structures_.hit().fraction * duration : duration;
  }
  const double end = start.time + duration;
  BlockState at = start;
  while (!scar_.open() && recorder_.nextTime() <= end)
  {
    at = fly(body_.block, at, parameters_.gravity, std::max(0.0, recorder_.nextTime() - at.time));
    recorder_.record(at, false);
    this->auditSamples(at);
  }
  if (scar_.open())
  {
    this->flyThroughSoil(duration);
    body_.state.time = end;
    recorder_.recordBetween(start, body_.state, false);
    this->auditSamples(body_.state);
    recorder_.follow(body_.state);
  }
  else
  {
    body_.state = fly(body_.block, start, parameters_.gravity, duration);
    body_.state.time = end;
    recorder_.followFlight(start, body_.state);
  }
  this->forgetSlip(duration);
  while (structures_.hasBarriers() && !body_.done && structures_.hit().barrier >= 0)
  {
    this->meetBarrier();
    this->passBarriers(way, 0.0);
  }
}

void SingleRock::flyFree(double duration)
{
  body_.contacts.clear();
  this->finishImpact();
  const double end = body_.state.time + duration;
  this->advanceInFlight(duration);
  while (structures_.hasBarriers() && !body_.done && body_.state.time < end)
  {
    this->advanceInFlight(end - body_.state.time); // through a barrier that broke
  }
  if (!body_.done)
  {
    this->checkLeft();
  }
  body_.quietTime = 0.0;
}

void SingleRock::flyUntilNear()
{
  while (!body_.done && !this->arrived() && !scar_.open())
  {
    stayWanted();
    // Up to the edge of the slope, where the rock is let go.
    double remaining = horizon_ - body_.state.time;
    const double extent[2] = { surface_.terrain().width(), surface_.terrain().height() };
    for (int axis = 0; axis < 2; ++axis)
    {
      const double v = body_.state.velocity[axis];
      const double way =
        v > 0.0 ? extent[axis] - body_.state.position[axis] : body_.state.position[axis];
      if (v != 0.0)
      {
        // A hair beyond, so that the edge is passed and not met for ever.
        remaining = std::min(
          remaining, (way + 1e-9 * body_.block.radius() + 1e-15 * extent[axis]) / std::abs(v));
      }
    }
    double duration = std::min(kLongFlight, remaining);
    if (!this->clearFor(duration))
    {
      // A window over some of the way: nearer than its plane only the rock itself is looked at.
      const double across = body_.state.velocity.head<2>().norm();
      const double way = kHeightWindow * std::max(body_.block.radius(), surface_.grid().cellSize);
      duration = std::min(duration, across * duration > way ? way / across : duration);
      this->ensureWindow(duration);
      const double near =
        timeToNear(body_.state, body_.block.radius(), window_, parameters_.gravity, duration);
      if (near > this->impactStep())
      {
        duration = near;
      }
      else
      {
        const double sure = std::max(0.0, freeUntil_ - body_.state.time);
        if (impulses_ && !structures_.solid() && sure == 0.0 && window_.whole())
        {
          if (!this->hop(duration))
          {
            return;
          }
          this->checkEnd(0.0);
          continue;
        }
        body_.placed.place(body_.block, body_.state);
        const double touch = std::max(sure, this->timeToGround(duration));
        // So near that the pairs that can touch tell more.
        const double speed =
          body_.state.velocity.norm() + body_.block.largestRimSpeed(body_.state.spin);
        const double close = 0.5 * kCandidateSlack * body_.block.radius() / std::max(speed, 1e-9);
        if (sure == 0.0 && touch < std::min(duration, std::max(close, this->impactStep())))
        {
          return;
        }
        duration = std::min(duration, touch);
      }
    }
    if (structures_.solid())
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

void SingleRock::checkLeft()
{
  const Terrain& terrain = surface_.terrain();
  const Vec3& p = body_.state.position;
  const double r = body_.block.radius();
  bool left =
    !(p.x() >= 0.0 && p.y() >= 0.0 && p.x() <= terrain.width() && p.y() <= terrain.height());
  if (!left && !this->isClearAt(p, 0.0) && terrain.cfeAt(p.x(), p.y()) == 0)
  {
    // Over a hole it has left once it is below everything around; the bound costs next to nothing.
    const double x0 = p.x() - r, x1 = p.x() + r, y0 = p.y() - r, y1 = p.y() + r;
    left = p.z() < terrain.lowest() - 2.0 * r ||
      (p.z() + r < surface_.maxHeight(x0, x1, y0, y1) &&
        p.z() + r < lowestNode(surface_, x0, x1, y0, y1));
  }
  if (left)
  {
    this->end(isHole(terrain, p.x(), p.y()) ? Fate::LostInNodata : Fate::LeftDomain);
  }
}

void SingleRock::followRest(double h, bool touching)
{
  const double r = body_.block.radius();
  const double speed = body_.state.velocity.norm() + body_.state.spin.norm() * r;
  const double still = kStillSpeed * std::sqrt(std::max(parameters_.gravity, kLeastGravity) * r);
  body_.quietTime = touching && speed < still ? body_.quietTime + h : 0.0;
}

void SingleRock::checkEnd(double h)
{
  if (!body_.done)
  {
    this->checkLeft();
  }
  if (body_.done)
  {
    return;
  }
  this->followRest(h, anyClosed(body_.contacts));
  if (body_.quietTime >= kStillTime)
  {
    this->end(Fate::Rested);
  }
  else if (body_.state.time >= parameters_.endTime - 1e-9)
  {
    this->end(Fate::Moving);
  }
}

void SingleRock::liftOntoGround()
{
  // The placement was checked on the slope as surveyed; roughness can raise the ground into the
  // rock. By steps, so it ends a hair over the ground.
  const double step = 0.01 * body_.block.radius();
  body_.placed.place(body_.block, body_.state);
  if (structures_.solid())
  {
    structures_.clearTrees(body_.placed, body_.state);
    this->forgetPatch();
  }
  this->ensurePatch(step);
  double depth = penetration(body_.placed, patch_);
  // A rock that starts in the ground by rounding alone is set onto it by what follows.
  const double worldZ = body_.state.position.z() + surface_.terrain().geometry().origin().z();
  const double least =
    std::max(1e-6 * body_.block.radius(), startRounding(worldZ, body_.block.radius()));
  for (int k = 0; k < 1000 && depth > least; ++k)
  {
    body_.state.position.z() += std::max(depth, step);
    body_.placed.place(body_.block, body_.state);
    depth = penetration(body_.placed, patch_);
  }
  // Edges across each other are not seen by that, and embankments may be upright walls.
  body_.state.position.z() += liftOut(body_.placed, patch_);
  body_.placed.place(body_.block, body_.state);
}

void SingleRock::letStrainFollow()
{
  stiff_ = true;
  ringing_ = 0.0;
}

void SingleRock::end(Fate fate)
{
  this->trajectory().summary.fate = fate;
  body_.done = true;
}

void SingleRock::wake(double time)
{
  body_.done = false;
  body_.quietTime = 0.0;
  body_.state.time = time;
  this->trajectory().summary.fate = Fate::Moving;
  recorder_.resume(body_.state);
  this->auditSamples(body_.state);
}

void SingleRock::release()
{
  this->liftOntoGround();
  this->begin();
}

void SingleRock::begin()
{
  TrajectorySummary& summary = recorder_.trajectory().summary;
  summary.blockId = rock_.blockId;
  summary.mass = body_.block.mass();
  summary.volume = body_.block.volume();
  energyAtStart_ = this->mechanicalEnergy();
  recorder_.begin(body_.state);
  this->auditSamples(body_.state);
  this->checkEnd(0.0);
}

double SingleRock::stoppingPenalty() const
{
  // All that moves in one spring.
  const double depth =
    std::min(kDeepestImpact * body_.block.radius(), kDeepestOfThin * body_.block.thickness());
  return std::max(parameters_.normalPenalty,
    2.0 * rigidKineticEnergy(body_.block, body_.state) / (depth * depth));
}

void SingleRock::beginContact()
{
  if (inContact_)
  {
    return;
  }
  penalty_ = this->stoppingPenalty();
  body_.steppedAs = StepKind::Lasting; // no impact's step to go by yet
  openTime_ = ringing_;
  inContact_ = true;
  recorder_.knot(body_.state, false);
  this->auditSamples(body_.state);
}

void SingleRock::endContact()
{
  inContact_ = false;
  recorder_.knot(body_.state, false);
  this->auditSamples(body_.state);
}

void SingleRock::advance(double until, double enough)
{
  if (body_.inIsland)
  {
    body_.inIsland = false; // alone, and what others have pressed in is theirs
    body_.energy.damping += this->limitDeepOverlaps(kLooseOverlap * body_.block.radius());
    candidates_.distance =
      -1.0; // flight goes by them, and would hang on how the island was looked at
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
  while (!body_.done && !this->arrived() && !seen())
  {
    if (!inContact_)
    {
      this->flyUntilNear();
      if (body_.done || this->arrived())
      {
        return;
      }
      this->beginContact();
    }
    this->stayInContact();
  }
}

Trajectory SingleRock::finish()
{
  TrajectorySummary& summary = recorder_.trajectory().summary;
  const bool touching = anyClosed(body_.contacts);
  this->finishImpact(false);
  recorder_.end(body_.state, touching);
  // One that ends later may have begun earlier.
  std::vector<ImpactEvent>& impacts = recorder_.trajectory().impacts;
  std::stable_sort(impacts.begin(), impacts.end(),
    [](const ImpactEvent& a, const ImpactEvent& b) { return a.time < b.time; });
  summary.stop = body_.state.position;
  summary.endTime = body_.state.time;
  summary.runOut = (body_.state.position - summary.start).head<2>().norm();
  this->auditSamples(body_.state);
  summary.energy = this->auditAt(body_.state);
  return std::move(recorder_.trajectory());
}

Trajectory SingleRock::run(double enough)
{
  this->release();
  this->advance(parameters_.endTime, enough);
  return this->finish();
}

} // namespace rockfall
