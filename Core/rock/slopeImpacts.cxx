// Impacts of a rock on the slope as events.

#include "rock/SingleRock.h"

#include "law/settings.h"
#include "rock/restitution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

double SingleRock::impactDuration() const
{
  return std::numbers::pi * std::sqrt(body_.block.mass() / parameters_.normalPenalty);
}

bool SingleRock::isWorthAnEvent(const ImpactEvent& event) const
{
  return isImpact(event.approachSpeed, event.velocityBefore.norm(), body_.restingSpeed,
    parameters_.gravity, body_.block.radius());
}

bool SingleRock::resumeImpact(double time)
{
  if (!impulses_ || !(impact_.lastTouch > 0.0) || time > impact_.lastTouch + this->impactDuration())
  {
    return false;
  }
  if (!impact_.pending)
  {
    impact_.pending = true; // with the same deviates
    --impactsOver_;
    if (this->isWorthAnEvent(impact_.event))
    {
      forgetImpact(recorder_.trajectory(), impact_.event, parameters_.keepImpacts);
    }
  }
  impact_.lastTouch = time;
  return true;
}

void SingleRock::beginImpact(const BlockState& at, double frictionBefore, double restitutionBefore)
{
  impact_ = Impact();
  impact_.lastTouch = at.time;
  impact_.pending = true;
  impact_.frictionBefore = frictionBefore;
  impact_.restitutionBefore = restitutionBefore;
  impact_.yieldedBefore = body_.energy.scars + body_.energy.rolling;
  impact_.event.time = at.time;
  impact_.event.velocityBefore = at.velocity;
}

void SingleRock::followImpact(const BlockState& start, double h, const StepOutcome& outcome)
{
  const Vec3 spin = start.angularVelocity();
  for (std::size_t i = 0; i < body_.contacts.size(); ++i)
  {
    const Contact& now = body_.contacts[i];
    const Contact& was = body_.contactsBefore[i];
    if (now.normalForce <= 0.0)
    {
      continue;
    }
    if (!was.closed())
    {
      const double approach =
        -was.normal.dot(start.velocity + spin.cross(was.point - start.position));
      if (approach > body_.restingSpeed)
      {
        ImpactEvent& event = impact_.event;
        if (!this->resumeImpact(start.time) && !impact_.pending)
        {
          this->beginImpact(start, body_.energy.friction - outcome.frictionWork,
            body_.energy.restitution - outcome.dampedWork);
        }
        event.approachSpeed = std::max(event.approachSpeed, approach);
      }
    }
    if (impact_.pending)
    {
      impact_.normalImpulse += (h * now.normalForce) * now.normal;
      if (now.normalForce > impact_.largestForce)
      {
        impact_.largestForce = now.normalForce;
        impact_.event.cfe = now.cfe;
        impact_.event.position = was.point;
      }
    }
  }
}

void SingleRock::finishImpact(bool over, bool told)
{
  if (!impact_.pending)
  {
    return;
  }
  impact_.pending = false;
  ImpactEvent& event = impact_.event;
  const GroundTouch touch = this->touchAt(event.cfe, event.position);
  ++impactsOver_;
  if (!this->isWorthAnEvent(event))
  {
    return;
  }
  event.impulse = impact_.normalImpulse.norm();
  event.normal = event.impulse > 0.0 ? Vec3(impact_.normalImpulse / event.impulse) : event.normal;
  const int ground = surface_.restitutionClass(event.cfe);
  event.restitution = surface_.restitutionAt(touch);
  const double before = kineticEnergy(body_.block, body_.state);
  const bool down = comesDown(
    event.approachSpeed, event.velocityBefore.norm(), parameters_.gravity, body_.block.radius());
  const SurfaceMaterial& material = surface_.terrain().restitutionMaterial(ground);
  const Vec3 after = over && !impact_.slowed
    ? adjustVelocity(material, event, body_.state.velocity, down)
    : body_.state.velocity;
  impact_.slowed = impact_.slowed || after != body_.state.velocity;
  const bool jumps =
    !told && (after - body_.state.velocity).norm() > kSameVelocity * body_.state.velocity.norm();
  if (jumps)
  {
    recorder_.beforeJump(body_.state, true);
    this->auditSamples(body_.state);
  }
  body_.state.velocity = after;
  body_.energy.restitution += before - kineticEnergy(body_.block, body_.state);
  event.velocityAfter = body_.state.velocity;
  event.energyLoss = body_.energy.restitution - impact_.restitutionBefore + body_.energy.friction -
    impact_.frictionBefore + (body_.energy.scars + body_.energy.rolling - impact_.yieldedBefore);
  if (jumps)
  {
    recorder_.afterJump(body_.state, true);
    this->auditSamples(body_.state);
  }
  body_.acceleration.setZero();
  body_.spinAcceleration.setZero();
  noteImpact(recorder_.trajectory(), event, parameters_.keepImpacts);
}

} // namespace rockfall
