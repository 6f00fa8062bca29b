// Impacts of a rock on the slope as events.

#include "simulation/RockSimulator.h"

#include "law/settings.h"
#include "simulation/restitution.h"

#include <algorithm>

namespace rockfall
{

void RockSimulator::beginImpact(
  const BlockState& at, double frictionBefore, double restitutionBefore)
{
  impact_ = Impact();
  impact_.pending = true;
  impact_.frictionBefore = frictionBefore;
  impact_.restitutionBefore = restitutionBefore;
  impact_.yieldedBefore = energy_.scars + energy_.rolling;
  impact_.event.time = at.time;
  impact_.event.velocityBefore = at.velocity;
}

void RockSimulator::followImpact(const BlockState& start, double h, const StepOutcome& outcome)
{
  const Vec3 spin = start.angularVelocity();
  for (std::size_t i = 0; i < contacts_.size(); ++i)
  {
    const Contact& now = contacts_[i];
    const Contact& was = contactsBefore_[i];
    if (now.normalForce <= 0.0)
    {
      continue;
    }
    if (!was.closed())
    {
      const double approach =
        -was.normal.dot(start.velocity + spin.cross(was.point - start.position));
      if (approach > restingSpeed_)
      {
        ImpactEvent& event = impact_.event;
        if (!impact_.pending)
        {
          this->beginImpact(start, energy_.friction - outcome.frictionWork,
            energy_.restitution - outcome.dampedWork);
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

void RockSimulator::finishImpact(bool over)
{
  if (!impact_.pending)
  {
    return;
  }
  impact_.pending = false;
  ImpactEvent& event = impact_.event;
  const GroundTouch touch = this->touchAt(event.cfe, event.position);
  ++impactsOver_;
  if (!isImpact(event.approachSpeed, event.velocityBefore.norm(), restingSpeed_,
        parameters_.gravity, block_.radius()))
  {
    return;
  }
  event.impulse = impact_.normalImpulse.norm();
  event.normal = event.impulse > 0.0 ? Vec3(impact_.normalImpulse / event.impulse) : event.normal;
  const int ground = surface_.restitutionClass(event.cfe);
  event.restitution = surface_.restitutionAt(touch);
  const double before = kineticEnergy(block_, state_);
  const bool down = comesDown(
    event.approachSpeed, event.velocityBefore.norm(), parameters_.gravity, block_.radius());
  const SurfaceMaterial& material = surface_.terrain().restitutionMaterial(ground);
  const Vec3 after =
    over ? adjustVelocity(material, event, state_.velocity, down) : state_.velocity;
  const bool jumps = (after - state_.velocity).norm() > kSameVelocity * state_.velocity.norm();
  if (jumps)
  {
    recorder_.beforeJump(state_, true);
    this->auditSamples(state_);
  }
  state_.velocity = after;
  energy_.restitution += before - kineticEnergy(block_, state_);
  event.velocityAfter = state_.velocity;
  event.energyLoss = energy_.restitution - impact_.restitutionBefore + energy_.friction -
    impact_.frictionBefore + (energy_.scars + energy_.rolling - impact_.yieldedBefore);
  if (jumps)
  {
    recorder_.afterJump(state_, true);
    this->auditSamples(state_);
  }
  acceleration_.setZero();
  spinAcceleration_.setZero();
  Trajectory& trajectory = recorder_.trajectory();
  trajectory.impacts.push_back(event);
  ++trajectory.summary.impacts;
}

} // namespace rockfall
