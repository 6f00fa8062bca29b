#pragma once

/// @file
/// What sweeps over soft rows do with each of them, inline.

#include "law/settings.h"
#include "solve/island/SoftSolver.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

inline Vec3 SoftSolver::speedOfA(const ContactRow& r, const std::vector<Motion>& motions)
{
  const Motion& a = motions[std::size_t(r.a)];
  return a.velocity + a.spin.cross(r.lever);
}

inline Vec3 SoftSolver::speedOf(const ContactRow& r, const std::vector<Motion>& motions)
{
  Vec3 u = speedOfA(r, motions);
  if (r.b >= 0)
  {
    const Motion& b = motions[std::size_t(r.b)];
    u -= b.velocity + b.spin.cross(r.leverB);
  }
  return u;
}

inline double SoftSolver::mobility(int i) const
{
  const double moment = motions_[std::size_t(i)].inverseMoment;
  return moment > 0.0 ? moment : movers_[std::size_t(i)].inverseInertia.trace();
}

inline void SoftSolver::limitTo(Vec3& T, double most)
{
  const double size2 = T.squaredNorm();
  if (size2 > most * most)
  {
    T *= most / std::sqrt(size2);
  }
}

inline void SoftSolver::push(int i, const Vec3& J, const Vec3& lever)
{
  Motion& m = motions_[std::size_t(i)];
  m.velocity += m.inverseMass * J;
  this->twist(i, lever.cross(J));
}

inline void SoftSolver::twist(int i, const Vec3& moment)
{
  Motion& m = motions_[std::size_t(i)];
  if (m.inverseMoment > 0.0)
  {
    m.spin += m.inverseMoment * moment;
    return;
  }
  Mover& mover = movers_[std::size_t(i)];
  mover.momentum += moment;
  m.spin += mover.inverseInertia * moment;
}

inline void SoftSolver::push(const ContactRow& r, const Vec3& J)
{
  if (r.b >= 0)
  {
    this->push(r.b, -J, r.leverB);
  }
  this->push(r.a, J, r.lever);
}

inline void SoftSolver::twist(const ContactRow& r, const Vec3& moment)
{
  this->twist(r.b, -moment);
  this->twist(r.a, moment);
}

inline double SoftSolver::frictionLimit(const ContactRow& r, double P)
{
  return r.friction * P + std::min(r.cohesion, kCohesionPerForce * P);
}

inline Vec3 SoftSolver::solveFriction(ContactRow& r, double P, const Vec3& across)
{
  Vec3 T = r.T - r.shearMass * across;
  T -= T.dot(r.normal) * r.normal;
  limitTo(T, frictionLimit(r, P));
  const Vec3 dT = T - r.T;
  r.T = T;
  return dT;
}

} // namespace rockfall
