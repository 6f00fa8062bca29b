#pragma once

/// @file
/// How cohesion comes in with the normal force.

#include "law/settings.h"

#include <cstddef>

namespace rockfall
{

/// Cohesion of one of `points` contact points of the same two, N.
inline double sharedCohesion(double cohesion, std::ptrdiff_t points)
{
  return points > kCohesivePoints ? cohesion * kCohesivePoints / double(points) : cohesion;
}

struct CoulombLimit
{
  double force; ///< N
  double slope; ///< ∂force/∂N
};

inline CoulombLimit coulombLimit(double friction, double cohesion, double normalForce)
{
  const bool weak = kCohesionPerForce * normalForce < cohesion;
  const double slope = friction + (weak ? kCohesionPerForce : 0.0);
  return { slope * normalForce + (weak ? 0.0 : cohesion), slope };
}

} // namespace rockfall
