#include "rock/parts/SlopeImpact.h"

#include "law/settings.h"
#include "rock/restitution.h"
#include "terrain/Obstacles.h"

#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

constexpr std::uint64_t kNextHit = 0x9e3779b97f4a7c15ull; ///< To the key of the next one's draws.

} // namespace

double SlopeImpact::duration(const RockBody& body) const
{
  return std::numbers::pi *
    std::sqrt(body.block.mass() / parameters_.penaltyFor(body.block.mass()));
}

bool SlopeImpact::isWorthAnEvent(const RockBody& body) const
{
  return isImpact(event_.approachSpeed, event_.velocityBefore.norm(), body.restingSpeed,
    parameters_.gravity, body.block.radius());
}

void SlopeImpact::Hit::add(const Vec3& by, double force, std::int64_t on)
{
  this->impulse += by;
  if (force > this->largestForce)
  {
    this->largestForce = force;
    this->cfe = on;
  }
}

void SlopeImpact::beginHit(const BlockState& at)
{
  if (!hit_.underWay)
  {
    hit_ = Hit();
    hit_.underWay = true;
    hit_.velocity = at.velocity;
  }
}

Vec3 SlopeImpact::hitNormal() const
{
  const double size = hit_.impulse.norm();
  return size > 0.0 ? Vec3(hit_.impulse / size) : event_.normal;
}

bool SlopeImpact::breaks(const RockBody& body) const
{
  const Fragmentation& law = parameters_.fragmentation;
  if (!law.on || !hit_.underWay)
  {
    return false;
  }
  const double normal = this->hitNormal().dot(hit_.velocity);
  const double density = body.block.mass() / body.block.volume();
  const Obstacles* obstacles = surface_.terrain().obstacles();
  const std::int64_t cfe = hit_.largestForce > 0.0 ? hit_.cfe : event_.cfe;
  const bool onGround = !obstacles || cfe < obstacles->firstCfe();
  const std::uint64_t number = std::uint64_t(number_) << 32 | (impactsOver_ + 1);
  return onGround && body.block.volume() > law.leastVolume &&
    0.5 * density * normal * normal >= law.energy &&
    !(surface_.drawTwo(Draw::Survival, number ^ hitsOver_ * kNextHit)[0] < law.survival);
}

bool SlopeImpact::resume(const RockBody& body, double time, Recorder& recorder)
{
  if (!impulses_ || !(lastTouch_ > 0.0) || time > lastTouch_ + this->duration(body))
  {
    return false;
  }
  if (!pending_)
  {
    pending_ = true; // with the same deviates
    --impactsOver_;
    if (this->isWorthAnEvent(body))
    {
      forgetImpact(recorder.trajectory(), event_, parameters_.kept.impacts);
    }
  }
  lastTouch_ = time;
  return true;
}

void SlopeImpact::begin(
  const RockBody& body, const BlockState& at, double frictionBefore, double restitutionBefore)
{
  pending_ = true;
  slowed_ = false;
  lastTouch_ = at.time;
  event_ = ImpactEvent();
  event_.time = at.time;
  event_.velocityBefore = at.velocity;
  hit_.underWay = false;
  hitsOver_ = 0;
  this->beginHit(at);
  normalImpulse_.setZero();
  largestForce_ = 0.0;
  frictionBefore_ = frictionBefore;
  restitutionBefore_ = restitutionBefore;
  yieldedBefore_ = body.energy.scars + body.energy.rolling;
}

void SlopeImpact::follow(const RockBody& body, const BlockState& start, double h,
  const StepOutcome& outcome, Recorder& recorder)
{
  const Vec3 spin = start.angularVelocity();
  for (std::size_t i = 0; i < body.contacts.size(); ++i)
  {
    const Contact& now = body.contacts[i];
    const Contact& was = body.contactsBefore[i];
    if (now.normalForce <= 0.0)
    {
      continue;
    }
    if (!was.closed())
    {
      const double approach = approachOf(start, spin, was.point, was.normal);
      if (approach > body.restingSpeed)
      {
        if (!this->resume(body, start.time, recorder) && !pending_)
        {
          this->begin(body, start, body.energy.friction - outcome.frictionWork,
            body.energy.restitution - outcome.dampedWork);
        }
        this->beginHit(start);
        this->noteApproach(approach);
      }
    }
    if (pending_)
    {
      this->addImpulse((h * now.normalForce) * now.normal, now.normalForce, now.cfe, was.point);
    }
  }
}

void SlopeImpact::addImpulse(const Vec3& impulse, double force, std::int64_t cfe, const Vec3& place)
{
  normalImpulse_ += impulse;
  hit_.add(impulse, force, cfe);
  if (force > largestForce_)
  {
    largestForce_ = force;
    event_.cfe = cfe;
    event_.position = place;
  }
}

void SlopeImpact::noteScar(double depth, double length)
{
  event_.scarDepth = depth;
  event_.scarLength = length;
}

void SlopeImpact::noteSink(const RockBody& body, const Contact& under)
{
  // Before the rock comes to Λ, soil takes of its speed and the next corner of a landing sinks: the hit
  // began with the first one. A graze before a counter slope is another hit.
  const auto into = [&](const Vec3& velocity) { return -under.normal.dot(velocity); };
  const bool touched = hit_.underWay && hit_.largestForce > 0.0;
  hit_.underWay = touched || (hit_.underWay && into(hit_.velocity) >= into(body.state.velocity));
  this->beginHit(body.state);
  if (largestForce_ == 0.0)
  {
    event_.cfe = under.cfe;
    event_.position = under.point;
    event_.normal = under.normal;
  }
}

void SlopeImpact::takeOff(RockBody& body, Recorder& recorder)
{
  if (!pending_ || !hit_.underWay || !(hit_.largestForce > 0.0))
  {
    return;
  }
  if (this->isWorthAnEvent(body) && this->breaks(body))
  {
    this->finish(body, recorder);
    return;
  }
  hit_.underWay = false;
  ++hitsOver_;
}

void SlopeImpact::finish(RockBody& body, Recorder& recorder, bool over, bool told)
{
  if (!pending_)
  {
    return;
  }
  pending_ = false;
  const bool broken = over && this->breaks(body);
  const Vec3 normal = this->hitNormal();
  const GroundTouch touch = this->touchAt(event_.cfe, event_.position);
  ++impactsOver_;
  if (!this->isWorthAnEvent(body))
  {
    return;
  }
  event_.impulse = normalImpulse_.norm();
  event_.normal = broken   ? normal
    : event_.impulse > 0.0 ? Vec3(normalImpulse_ / event_.impulse)
                           : event_.normal;
  const int ground = surface_.restitutionClass(event_.cfe);
  event_.restitution = surface_.restitutionAt(touch);
  const double before = kineticEnergy(body.block, body.state);
  const bool down = comesDown(
    event_.approachSpeed, event_.velocityBefore.norm(), parameters_.gravity, body.block.radius());
  const SurfaceMaterial& material = surface_.terrain().restitutionMaterial(ground);
  const Vec3 after = over && !slowed_ ? adjustVelocity(material, event_, body.state.velocity, down)
                                      : body.state.velocity;
  slowed_ = slowed_ || after != body.state.velocity;
  const double kept = broken ? std::sqrt(1.0 - parameters_.fragmentation.loss) : 1.0;
  const bool jumps = !told &&
    (kept * after - body.state.velocity).norm() > kSameVelocity * body.state.velocity.norm();
  if (jumps)
  {
    recorder.beforeJump(body, true);
  }
  body.state.velocity = after;
  body.energy.restitution += before - kineticEnergy(body.block, body.state);
  event_.velocityAfter = body.state.velocity;
  event_.energyLoss = body.energy.restitution - restitutionBefore_ + body.energy.friction -
    frictionBefore_ + (body.energy.scars + body.energy.rolling - yieldedBefore_);
  if (broken)
  {
    body.energy.vibration += relaxStrain(body.block, body.state);
    const double whole = kineticEnergy(body.block, body.state);
    body.state.velocity *= kept;
    body.state.spin *= kept;
    body.energy.breaking += whole - kineticEnergy(body.block, body.state) + body.springEnergy;
    body.springEnergy = 0.0;
    body.contacts.clear();
    recorder.trajectory().summary.fate = Fate::Broken;
    body.done = true;
  }
  if (jumps)
  {
    recorder.afterJump(body, true);
  }
  body.acceleration.setZero();
  body.spinAcceleration.setZero();
  noteImpact(recorder.trajectory(), event_, parameters_.kept.impacts);
}

} // namespace rockfall
