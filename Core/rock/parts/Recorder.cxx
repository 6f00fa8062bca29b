// Samples of a path: at even times, and as many knots as its curve needs between them.

#include "rock/parts/Recorder.h"

#include "base/grow.h"
#include "block/flight.h"
#include "contact/ground/roundContact.h"
#include "geometry/roundBody.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

double heightOverGround(const Surface& surface, const Block& block, const BlockState& state)
{
  double lowest = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vec3& p)
  {
    const double ground = surface.elevation(p.x(), p.y());
    if (!std::isnan(ground))
    {
      lowest = std::min(lowest, p.z() - ground);
    }
  };
  if (isRound(block.shape().layout()))
  {
    // Straight under the centre and square to the ground there.
    const Mat3 axes = state.orientation.toRotationMatrix() * roundAxes(block.shape().layout());
    const Vec3& c = state.position;
    const double side = kGroundAside * block.radius();
    const auto at = [&](double x, double y)
    { return surface.elevation(c.x() + x * side, c.y() + y * side); };
    for (const Vec3& n :
      { Vec3(Vec3::UnitZ()), Vec3(at(-1, 0) - at(1, 0), at(0, -1) - at(0, 1), 2.0 * side) })
    {
      look(c - axes * (axes.transpose() * n) / roundReach(axes, n));
    }
  }
  else
  {
    for (const Vec3& x : block.shape().vertices())
    {
      look(state.position + state.orientation * x);
    }
  }
  return std::isinf(lowest) ? std::numeric_limits<double>::quiet_NaN() : lowest;
}

Sample Recorder::makeSample(const BlockState& state, bool contact)
{
  Sample s;
  s.time = state.time;
  s.position = state.position;
  s.orientation = state.orientation;
  s.velocity = state.velocity;
  s.angularVelocity = state.angularVelocity();
  s.kineticEnergy = rigidKineticEnergy(block_, state);
  if (std::isnan(height_.overGround) || height_.position != state.position ||
    height_.orientation.coeffs() != state.orientation.coeffs())
  {
    height_ = { state.position, state.orientation, heightOverGround(surface_, block_, state) };
  }
  s.heightOverGround = height_.overGround;
  s.contact = contact;
  TrajectorySummary& summary = trajectory_.summary;
  if (s.heightOverGround > summary.maxHeightOverGround)
  {
    summary.maxHeightOverGround = s.heightOverGround;
  }
  return s;
}

EnergyAudit Recorder::auditAt(const RockBody& body, const BlockState& state) const
{
  EnergyAudit audit = body.energy;
  audit.kinetic = kineticEnergy(block_, state);
  audit.strain = strainEnergy(block_, state) + body.springEnergy;
  audit.released = energyAtStart_ - block_.mass() * gravity_ * state.position.z();
  audit.numerical = audit.released -
    (audit.kinetic + audit.strain + audit.friction + audit.restitution + audit.vibration +
      audit.damping + audit.structures + audit.scars + audit.rolling + audit.breaking +
      audit.exchanged);
  return audit;
}

void Recorder::audit(const RockBody& body, const BlockState& state)
{
  if (audited_ < trajectory_.samples.size())
  {
    const EnergyAudit audit = this->auditAt(body, state);
    for (; audited_ < trajectory_.samples.size(); ++audited_)
    {
      trajectory_.samples[audited_].energy = audit;
    }
  }
}

void Recorder::begin(const RockBody& body)
{
  energyAtStart_ = body.mechanicalEnergy(gravity_);
  leastEnergy_ = energyAtStart_ + body.springEnergy + body.energy.exchanged;
  last_ = body.state.position;
  knot_ = body.state;
  trajectory_.summary.start = body.state.position;
  this->follow(body.state);
  if (body.state.time > 0.0)
  {
    this->resume(body); // a piece of a rock, which comes to be later
    return;
  }
  this->record(body, body.state, false);
}

void Recorder::record(const RockBody& body, const BlockState& at, bool contact)
{
  this->addEven(at, contact);
  this->audit(body, at);
}

void Recorder::addEven(const BlockState& state, bool contact)
{
  const bool knot = this->isAt(state.time) && trajectory_.samples.back().kind == SampleKind::Knot;
  if (knot)
  {
    contact = trajectory_.samples.back().contact;
    this->dropLast();
  }
  this->add(this->makeSample(state, contact));
  trajectory_.samples.back().kind = knot ? SampleKind::EvenKnot : SampleKind::Even;
  ++next_;
}

void Recorder::knot(const RockBody& body, bool contact)
{
  this->addKnot(body.state, contact);
  this->audit(body, body.state);
}

void Recorder::addKnot(const BlockState& state, bool contact)
{
  knot_ = state;
  // There is one sample at a time: the state after an impact replaces the one before it.
  const SampleKind kind = this->knotAt(state.time);
  this->add(this->makeSample(state, contact));
  trajectory_.samples.back().kind = kind;
}

void Recorder::beforeJump(const RockBody& body, bool contact)
{
  this->addBeforeJump(body.state, contact);
  this->audit(body, body.state);
}

void Recorder::addBeforeJump(BlockState state, bool contact)
{
  jump_ = this->knotAt(state.time);
  state.time -= kInstant;
  const bool begins = trajectory_.samples.empty(); // no path before it
  if (!begins && !this->isAt(state.time))
  {
    this->add(this->makeSample(state, contact));
    trajectory_.samples.back().kind = SampleKind::Knot;
  }
}

void Recorder::afterJump(const RockBody& body, bool contact)
{
  this->addAfterJump(body.state, contact);
  this->audit(body, body.state);
}

void Recorder::addAfterJump(const BlockState& state, bool contact)
{
  knot_ = state;
  this->add(this->makeSample(state, contact));
  trajectory_.samples.back().kind = jump_;
}

bool Recorder::isAt(double time) const
{
  return !trajectory_.samples.empty() && trajectory_.samples.back().time >= time - kOneTime;
}

SampleKind Recorder::knotAt(double time)
{
  if (!this->isAt(time))
  {
    return SampleKind::Knot;
  }
  const bool even = trajectory_.samples.back().kind != SampleKind::Knot;
  this->dropLast();
  return even ? SampleKind::EvenKnot : SampleKind::Knot;
}

void Recorder::dropLast()
{
  trajectory_.samples.pop_back();
  audited_ = std::min(audited_, trajectory_.samples.size());
}

void Recorder::add(const Sample& sample)
{
  std::vector<Sample>& samples = trajectory_.samples;
  if (samples.size() > 2)
  {
    const std::size_t between = samples.size() - 2;
    if (!isKeptBetween(samples[between], retention_))
    {
      samples[between] = samples.back();
      samples.pop_back();
      audited_ -= between < audited_ ? 1 : 0;
    }
  }
  append(samples, sample);
}

void Recorder::resume(const RockBody& body)
{
  next_ = std::max(next_, std::int64_t(std::ceil(body.state.time / interval_)));
  this->knot(body, true);
}

bool Recorder::follows(const BlockState& state) const
{
  const double h = state.time - knot_.time;
  const Vec3 bend = state.position - knot_.position - 0.5 * h * (knot_.velocity + state.velocity);
  const double allowed = kPathTolerance * block_.radius();
  return bend.squaredNorm() <= allowed * allowed;
}

void Recorder::recordBetween(
  const RockBody& body, const BlockState& from, const BlockState& to, bool contact)
{
  const bool even = this->follows(to);
  if (!even)
  {
    this->addKnot(from, contact);
  }
  if (even || this->follows(to) || !(to.time > from.time))
  {
    this->addEvens(from, to, contact);
  }
  else
  {
    this->addStraight(from, to, contact);
  }
  this->audit(body, to);
}

void Recorder::addStraight(const BlockState& from, const BlockState& to, bool contact)
{
  const double h = to.time - from.time, allowed = kPathTolerance * block_.radius();
  BlockState first = from, last = to;
  first.velocity = last.velocity = (to.position - from.position) / h;
  const auto jumps = [&](const BlockState& end)
  { return (end.velocity - first.velocity).norm() * h > allowed; };
  if (jumps(from))
  {
    this->addBeforeJump(from, contact);
    this->addAfterJump(first, contact);
  }
  this->addEvens(first, last, contact);
  if (jumps(to))
  {
    this->addBeforeJump(last, contact);
    this->addAfterJump(to, contact);
  }
}

void Recorder::addEvens(const BlockState& from, const BlockState& to, bool contact)
{
  const double h = to.time - from.time;
  while (this->nextTime() <= to.time && h > 0.0)
  {
    BlockState at = between(from, to, std::clamp((this->nextTime() - from.time) / h, 0.0, 1.0));
    at.time = this->nextTime();
    this->addEven(at, contact);
  }
}

void Recorder::follow(const BlockState& state)
{
  trajectory_.summary.pathLength += (state.position - last_).norm();
  this->reach(state);
}

void Recorder::follow(const RockBody& body)
{
  this->follow(body.state);
  const double energy = body.mechanicalEnergy(gravity_) + body.springEnergy + body.energy.exchanged;
  leastEnergy_ = std::min(leastEnergy_, energy);
  double& gained = trajectory_.summary.gained;
  gained = std::max(gained, energy - leastEnergy_);
}

void Recorder::followFlight(const BlockState& from, const BlockState& to)
{
  trajectory_.summary.pathLength += flightLength(to.time - from.time, from.velocity, to.velocity);
  this->reach(to);
}

void Recorder::reach(const BlockState& state)
{
  TrajectorySummary& s = trajectory_.summary;
  last_ = state.position;
  s.maxSpeed = std::max(s.maxSpeed, state.velocity.norm());
  s.maxKineticEnergy = std::max(s.maxKineticEnergy, rigidKineticEnergy(block_, state));
}

void Recorder::end(const RockBody& body, bool contact)
{
  const BlockState& state = body.state;
  if (trajectory_.samples.size() > 1 && this->isAt(state.time) &&
    trajectory_.samples.back().kind == SampleKind::Even)
  {
    // The state itself: the way to the sample went over others, and rounded otherwise.
    this->dropLast();
  }
  // A path has two points at least, also of a rock that is caught at once.
  const bool atOnce = trajectory_.samples.size() == 1 && this->isAt(state.time);
  if (atOnce || !this->isAt(state.time))
  {
    this->add(this->makeSample(state, contact));
    trajectory_.samples.back().time += atOnce ? kInstant : 0.0;
  }
  trajectory_.samples.back().kind = SampleKind::End;
  this->audit(body, state);
  // Impacts are recorded as they end; of two that overlap the later one may have begun first.
  std::vector<ImpactEvent>& impacts = trajectory_.impacts;
  std::stable_sort(impacts.begin(), impacts.end(),
    [](const ImpactEvent& a, const ImpactEvent& b) { return a.time < b.time; });
  TrajectorySummary& summary = trajectory_.summary;
  summary.stop = state.position;
  summary.endTime = state.time;
  summary.runOut = (state.position - summary.start).head<2>().norm();
  summary.energy = this->auditAt(body, state);
}

} // namespace rockfall
