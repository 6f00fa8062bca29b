#include "block/flight.h"

#include <cmath>

namespace rockfall
{

namespace
{

Quat rotationBy(const Vec3& vector)
{
  const double angle = vector.norm();
  if (angle < 1e-300)
  {
    return Quat::Identity();
  }
  return Quat(Eigen::AngleAxisd(angle, vector / angle));
}

/// q̇ = ½ q ∘ (0, W) with W = I⁻¹ Rᵀ L: the only unknown of torque-free rotation, as L is constant.
void rotateFreely(const Block& block, BlockState& state, double duration)
{
  const Vec3 momentum = state.orientation * (block.inertia() * state.spin);
  const auto spinOf = [&](const Quat& q) -> Vec3
  { return block.inverseInertia() * (q.conjugate() * momentum); };
  const auto rate = [&](const Eigen::Vector4d& coefficients) -> Eigen::Vector4d
  {
    Quat q;
    q.coeffs() = coefficients;
    const Vec3 w = spinOf(q.normalized());
    return 0.5 * (q * Quat(0.0, w.x(), w.y(), w.z())).coeffs();
  };
  const double fastest = block.largestSpin(state.spin).norm();
  const int steps = std::max(1, int(std::ceil(fastest * duration / 0.02)));
  const double h = duration / steps;
  Eigen::Vector4d q = state.orientation.coeffs();
  for (int step = 0; step < steps; ++step)
  {
    const Eigen::Vector4d k1 = rate(q);
    const Eigen::Vector4d k2 = rate(q + 0.5 * h * k1);
    const Eigen::Vector4d k3 = rate(q + 0.5 * h * k2);
    const Eigen::Vector4d k4 = rate(q + h * k3);
    q = (q + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)).normalized();
  }
  state.orientation.coeffs() = q;
  state.spin = spinOf(state.orientation);
}

} // namespace

BlockState fly(const Block& block, const BlockState& state, double gravity, double duration)
{
  BlockState next = state;
  next.time = state.time + duration;
  next.position += duration * state.velocity;
  next.position.z() -= 0.5 * gravity * duration * duration;
  next.velocity.z() -= gravity * duration;
  if (block.isotropic())
  {
    next.orientation = (state.orientation * rotationBy(duration * state.spin)).normalized();
  }
  else if (state.spin.squaredNorm() > 0.0)
  {
    rotateFreely(block, next, duration);
  }
  return next;
}

} // namespace rockfall
