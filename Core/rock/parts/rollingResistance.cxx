#include "rock/parts/rollingResistance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

double energyOf(const Block& block, const Vec3& velocity, const Vec3& spin)
{
  return 0.5 * block.mass() * velocity.squaredNorm() + 0.5 * spin.dot(block.inertia() * spin);
}

} // namespace

void Support::add(double part, bool slides, const Vec3& at)
{
  this->force += part;
  this->sliding += slides ? part : 0.0;
  this->moment += part * at;
}

Support supportOf(const std::vector<Contact>& contacts)
{
  Support support;
  for (const Contact& c : contacts)
  {
    if (c.normalForce > 0.0)
    {
      support.add(c.normalForce, c.state == ContactState::Sliding, c.point);
    }
  }
  return support;
}

double rollingArm(const Block& block)
{
  const double round = block.shape().layout().inside / block.radius();
  return round * std::cbrt(0.75 * block.volume() / std::numbers::pi);
}

double resistRolling(
  const Block& block, const Support& support, double coefficient, double h, BlockState& state)
{
  if (!(support.force > 0.0) || state.spin.isZero(0.0))
  {
    return 0.0;
  }
  const double impulse = coefficient * rollingArm(block) * support.force * h; // N m s
  const double before = energyOf(block, state.velocity, state.spin);
  const Vec3 turning = block.inertia() * state.spin; // body axes
  const Vec3 lever = state.orientation.conjugate() * (state.position - support.point());
  if (support.sliding < 0.5 * support.force)
  {
    // About the support: Θ ω = I ω + m r × (ω × r).
    const Vec3 carried = state.spin.cross(lever);
    const Vec3 about = turning + block.mass() * lever.cross(carried);
    const double share = std::min(1.0, impulse / about.norm());
    const Vec3 velocity = state.velocity - share * (state.orientation * carried);
    const Vec3 spin = (1.0 - share) * state.spin;
    const double lost = before - energyOf(block, velocity, spin);
    if (lost >= 0.0)
    {
      state.velocity = velocity;
      state.spin = spin;
      return lost;
    }
  }
  const double share = std::min(1.0, impulse / turning.norm());
  state.spin *= 1.0 - share;
  return before - energyOf(block, state.velocity, state.spin);
}

} // namespace rockfall
