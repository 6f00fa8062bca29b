#include "solve/island/PairSprings.h"

#include "law/settings.h"

#include <algorithm>

namespace rockfall
{

PairSprings::PairSprings(const PairStiffness& stiffness, double damping, const Block& first,
  const BlockState& firstState, const Block* second, const BlockState* secondState)
  : rigid_(stiffness.rigid)
  , dampings_(std::max(0.0, damping), kShearDamping)
{
  sides_[0] = { &first, firstState.orientation.toRotationMatrix(), firstState.position, {} };
  double mass = first.mass(), radius = first.radius();
  Vec3 velocity = firstState.velocity;
  if (second)
  {
    sides_[1] = { second, secondState->orientation.toRotationMatrix(), secondState->position, {} };
    mass = 1.0 / (1.0 / first.mass() + 1.0 / second->mass());
    radius = std::min(radius, second->radius());
    velocity -= secondState->velocity;
  }
  const double depth = kDeepestPairImpact * radius, speed = velocity.norm();
  const double penalty = std::max(stiffness.normalPenalty, mass * speed * speed / (depth * depth));
  penalties_ = { penalty, penalty * stiffness.shearRatio };
}

void PairSprings::set(Contact& c)
{
  const bool turned = c.normal != normal_;
  normal_ = c.normal;
  Two soft = Two::Zero(), mobile = Two::Zero();
  for (Side& side : sides_)
  {
    if (!side.block)
    {
      continue;
    }
    if (turned)
    {
      side.motions = twoDirections(
        side.turn.transpose() * normal_, side.turn.transpose() * normal_.unitOrthogonal());
    }
    const Vec3 x = side.turn.transpose() * (c.point - side.position);
    soft += rigid_ ? Two(Two::Zero()) : side.block->compliance(side.motions, x);
    mobile += side.block->mobility(side.motions, x);
  }
  const Two stiffnesses = penalties_ / (1.0 + penalties_ * soft);
  const Two dashpots = 2.0 * dampings_ * (stiffnesses / mobile).sqrt();
  c.stiffness = stiffnesses[0];
  c.shearStiffness = stiffnesses[1];
  c.frequency2 = c.stiffness * mobile[0];
  c.stopped = 1.0 / mobile[0];
  c.dashpot = dashpots[0];
  c.shearDashpot = dashpots[1];
}

} // namespace rockfall
