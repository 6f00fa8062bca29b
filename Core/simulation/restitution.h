#pragma once

/// @file
/// What an impact is, and what it takes (METHOD 4; paper 3.1).

#include "terrain/Terrain.h"

#include <cmath>

namespace rockfall
{

/// Whether a touch is an impact, to be slowed by Rv, or part of sliding, rolling and lying, which
/// are not: it is one if the contact point came in faster than `restingSpeed` and either as fast as
/// from a drop of 5 % of the rock's radius or at more than 11.5° (one fifth of the rock's speed). A
/// sphere-like polyhedron with 1280 faces that rolls sets its next vertex down at 0.14 of its
/// speed.
inline bool isImpact(
  double approachSpeed, double speed, double restingSpeed, double gravity, double radius)
{
  const bool fast = approachSpeed * approachSpeed > 2.0 * gravity * 0.05 * radius;
  const bool steep = approachSpeed > 0.2 * speed;
  return approachSpeed > restingSpeed && (fast || steep);
}

/// The velocity after an impact that was elastic so far. `normal`: mean direction of the impact's
/// impulse, unit, out of the slope. Never gains energy.
inline Vec3 applyRestitution(
  RestitutionModel model, double coefficient, const Vec3& velocity, const Vec3& normal)
{
  if (model == RestitutionModel::Velocity)
  {
    return coefficient * velocity;
  }
  const double away = velocity.dot(normal);
  if (away <= 0.0)
  {
    return velocity;
  }
  return velocity - ((1.0 - coefficient) * away) * normal;
}

} // namespace rockfall
