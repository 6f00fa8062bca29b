#include "solve/island/softMovers.h"

#include "base/parallel.h"
#include "block/FreeRotation.h"
#include "block/cayley.h"
#include "block/flight.h"
#include "law/settings.h"

#include <cmath>

namespace rockfall::soft
{

void Movers::start(std::size_t i)
{
  const IslandBody& body = (*step_.bodies)[i];
  const Block& block = *body.block;
  Motion& motion = motions[i];
  Mover& m = all[i];
  m.block = &block;
  m.orientation = body.state->orientation;
  m.start = body.state->position - step_.origin;
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
  m.touched = m.deep = false;
  m.flies = true;
  m.noise = 0.0;
}

void Movers::start()
{
  forEach(this->size(), kBodyGrain, [&](std::size_t i) { this->start(i); });
}

void Movers::begin()
{
  motions.resize(step_.bodies->size());
  all.resize(step_.bodies->size());
  this->start();
  for (Mover& m : all)
  {
    m.seenAt.setZero();
    m.seenTurn.setZero();
    m.moved = true;
  }
}

void Movers::noteDetection()
{
  for (Mover& m : all)
  {
    m.seenAt = m.displacement;
    m.seenTurn = m.turn;
    m.moved = false;
  }
}

void Movers::findMoved()
{
  const auto look = [&](std::size_t i)
  {
    Mover& m = all[i];
    const double near = kNoMotion * m.block->radius();
    m.moved = m.moved || (m.displacement - m.seenAt).cwiseAbs().maxCoeff() > near ||
      (m.turn - m.seenTurn).cwiseAbs().maxCoeff() > kNoMotion;
  };
  forEach(this->size(), kBodyGrain, look);
}

void Movers::fall()
{
  const Vec3 gravity(0.0, 0.0, -step_.gravity);
  const auto fall = [&](std::size_t i)
  {
    motions[i].velocity += step_.h * gravity;
    all[i].touched = false;
  };
  forEach(this->size(), kBodyGrain, fall);
}

void Movers::move()
{
  const Vec3 gravity(0.0, 0.0, -step_.gravity);
  const auto move = [&](std::size_t i)
  {
    Mover& m = all[i];
    // What nothing touches falls on its parabola.
    m.displacement += step_.h * motions[i].velocity;
    if (!m.touched)
    {
      m.displacement -= 0.5 * step_.h * step_.h * gravity;
    }
    this->turn(i);
  };
  forEach(this->size(), kBodyGrain, move);
}

void Movers::turn(std::size_t i)
{
  Motion& motion = motions[i];
  Mover& m = all[i];
  if (motion.inverseMoment > 0.0)
  {
    const Vec3 by = step_.h * motion.spin;
    m.orientation = cayley(by) * m.orientation;
    m.turn += by;
    return;
  }
  Vec3 by;
  if (step_.h * step_.h * motion.spin.squaredNorm() < m.smallTurn * m.smallTurn)
  {
    const Quat half = cayley(0.5 * step_.h * motion.spin) * m.orientation;
    const Mat3 R = half.toRotationMatrix();
    by = step_.h * (R * (m.block->inverseInertia() * (R.transpose() * m.momentum)));
    m.orientation = (cayley(by) * m.orientation).normalized();
  }
  else
  {
    const Quat from = m.orientation;
    const Vec3 spin = from.conjugate() * motion.spin;
    m.orientation = (from * FreeRotation(*m.block, spin).after(step_.h).turn).normalized();
    const Eigen::AngleAxisd turned(m.orientation * from.conjugate());
    by = turned.angle() * turned.axis();
  }
  const Mat3 now = m.orientation.toRotationMatrix();
  m.inverseInertia = now * m.block->inverseInertia() * now.transpose();
  motion.spin = m.inverseInertia * m.momentum;
  m.turn += by;
  m.turned = m.turned || m.turn.squaredNorm() > m.weighedTurn * m.weighedTurn;
}

void Movers::forgetDeep()
{
  forEach(this->size(), kBodyGrain, [this](std::size_t i) { all[i].deep = false; });
}

BlockState Movers::end(std::size_t i) const
{
  const Motion& motion = motions[i];
  const Mover& m = all[i];
  BlockState state = *(*step_.bodies)[i].state;
  if (m.flies)
  {
    const double time = state.time;
    state = fly(*m.block, state, step_.gravity, step_.duration);
    state.time = time;
    return state;
  }
  state.position += m.displacement;
  state.velocity = motion.velocity;
  state.orientation = m.orientation.normalized();
  state.spin = state.orientation.conjugate() * motion.spin;
  return state;
}

} // namespace rockfall::soft
