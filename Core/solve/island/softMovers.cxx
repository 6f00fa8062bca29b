// The rocks of an island while they are solved for: where they start, how they turn, where they
// are.

#include "base/parallel.h"
#include "block/FreeRotation.h"
#include "block/cayley.h"
#include "block/flight.h"
#include "law/settings.h"
#include "solve/island/softSweep.h"

#include <cmath>

namespace rockfall
{

void SoftSolver::startMover(std::size_t i)
{
  const IslandBody& body = (*bodies_)[i];
  const Block& block = *body.block;
  Motion& motion = motions_[i];
  Mover& m = movers_[i];
  m.block = &block;
  m.orientation = body.state->orientation;
  m.start = body.state->position - origin_;
  m.displacement.setZero();
  m.turn.setZero();
  const bool isotropic = block.isotropic();
  const double inverseMoment = block.inverseInertia()(0, 0);
  const Mat3 R = m.orientation.toRotationMatrix();
  motion.velocity = body.state->velocity;
  motion.spin = R * body.state->spin;
  motion.inverseMass = 1.0 / block.mass();
  motion.inverseMoment = isotropic ? inverseMoment : 0.0;
  m.momentum = R * (block.inertia() * body.state->spin);
  m.inverseInertia = isotropic ? Mat3(inverseMoment * Mat3::Identity())
                               : Mat3(R * block.inverseInertia() * R.transpose());
  // The midpoint's turn is off by its cube over 24, and a needle's spin by as much times how much
  // easier it turns about itself.
  const double slender = block.inertia().trace() * block.inverseInertia().trace() / 9.0;
  m.smallTurn = std::cbrt(24.0 * kTurnExact / slender);
  m.weighedTurn = kWeighedTurn / std::sqrt(slender);
  m.turned = false;
  m.touched = m.carried = false;
  m.flies = true;
  m.noise = m.kinetic = 0.0;
}

void SoftSolver::startMovers()
{
  forEach(movers_.size(), kBodyGrain, [&](std::size_t i) { this->startMover(i); });
}

void SoftSolver::turn(std::size_t i)
{
  Motion& motion = motions_[i];
  Mover& m = movers_[i];
  if (motion.inverseMoment > 0.0)
  {
    const Vec3 by = h_ * motion.spin;
    m.orientation = cayley(by) * m.orientation;
    m.turn += by;
    return;
  }
  Vec3 by;
  if (h_ * h_ * motion.spin.squaredNorm() < m.smallTurn * m.smallTurn)
  {
    const Quat half = cayley(0.5 * h_ * motion.spin) * m.orientation;
    const Mat3 R = half.toRotationMatrix();
    by = h_ * (R * (m.block->inverseInertia() * (R.transpose() * m.momentum)));
    m.orientation = (cayley(by) * m.orientation).normalized();
  }
  else
  {
    const Quat from = m.orientation;
    const Vec3 spin = from.conjugate() * motion.spin;
    m.orientation = (from * FreeRotation(*m.block, spin).after(h_).turn).normalized();
    const Eigen::AngleAxisd turned(m.orientation * from.conjugate());
    by = turned.angle() * turned.axis();
  }
  const Mat3 now = m.orientation.toRotationMatrix();
  m.inverseInertia = now * m.block->inverseInertia() * now.transpose();
  motion.spin = m.inverseInertia * m.momentum;
  m.turn += by;
  m.turned = m.turned || m.turn.squaredNorm() > m.weighedTurn * m.weighedTurn;
}

double SoftSolver::kineticEnergy(std::size_t i) const
{
  const Motion& motion = motions_[i];
  const double turning = motion.inverseMoment > 0.0
    ? motion.spin.squaredNorm() / motion.inverseMoment
    : motion.spin.dot(movers_[i].momentum);
  return 0.5 * (motion.velocity.squaredNorm() / motion.inverseMass + turning);
}

void SoftSolver::holdEnergy(std::size_t i)
{
  Mover& m = movers_[i];
  if (!m.touched || m.carried)
  {
    return;
  }
  Motion& motion = motions_[i];
  const double now = this->kineticEnergy(i);
  const double still2 = kRestingSpeed * kRestingSpeed * gravity_ * m.block->radius();
  if (now > m.kinetic + 0.5 * still2 / motion.inverseMass)
  {
    const double share = std::sqrt(m.kinetic / now);
    motion.velocity *= share;
    motion.spin *= share;
    m.momentum *= share;
  }
}

void SoftSolver::noteDetection()
{
  for (Mover& m : movers_)
  {
    m.seenAt = m.displacement;
    m.seenTurn = m.turn;
    m.moved = false;
  }
}

BlockState SoftSolver::end(std::size_t i) const
{
  const Motion& motion = motions_[i];
  const Mover& m = movers_[i];
  BlockState state = *(*bodies_)[i].state;
  if (m.flies)
  {
    const double time = state.time;
    state = fly(*m.block, state, gravity_, duration_);
    state.time = time;
    return state;
  }
  state.position += m.displacement;
  state.velocity = motion.velocity;
  state.orientation = m.orientation.normalized();
  state.spin = state.orientation.conjugate() * motion.spin;
  return state;
}

} // namespace rockfall
