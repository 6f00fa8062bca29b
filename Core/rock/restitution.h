#pragma once

/// @file
/// Impacts: which touches are one, and restitution (METHOD 4; paper 3.1).
///
/// The paper's way, (Vx, Vy, Vz) ← Rv (Vx, Vy, Vz) after an impact that was elastic, is kept for
/// what comes down on the slope. Whatever glances, rolls or rattles has Rv on the normal velocity
/// at the contact only: a dashpot beside the contact's spring. So have all touches in the other
/// models.

#include "law/restitution.h"
#include "law/settings.h"
#include "rock/results.h"
#include "terrain/Terrain.h"

namespace rockfall
{

/// Speeds in m/s, gravity in m/s², radius of the rock in m.
inline bool comesDown(double approachSpeed, double speed, double gravity, double radius)
{
  return approachSpeed > kComesDown * speed ||
    approachSpeed * approachSpeed > 2.0 * gravity * kFallsDown * radius;
}

/// Whether a touch is worth an event: the contact point came in faster than `restingSpeed` and
/// either as fast as from a drop of 5 % of the rock's radius or at more than 11.5° (one fifth of
/// the rock's speed).
inline bool isImpact(
  double approachSpeed, double speed, double restingSpeed, double gravity, double radius)
{
  const bool fast = approachSpeed * approachSpeed > 2.0 * gravity * kDropOfTouch * radius;
  const bool steep = approachSpeed > kSteepTouch * speed;
  return approachSpeed > restingSpeed && (fast || steep);
}

/// Coefficient of restitution of a point that touches. `usual`: of its ground.
inline double contactRestitution(
  const SurfaceMaterial& material, double usual, double approachSpeed, bool down)
{
  switch (material.restitutionModel)
  {
    case RestitutionModel::Velocity:
      return down ? 1.0 : usual;
    case RestitutionModel::NormalTangential:
      return usual;
    case RestitutionModel::SpeedDependent:
      return restitutionAtSpeed(usual, approachSpeed, material.restitutionSpeed);
  }
  return usual;
}

/// The velocity of the centroid after an impact, whose `normal` is the mean direction of its
/// impulse, unit, out of the slope. Never gains energy.
inline Vec3 adjustVelocity(
  const SurfaceMaterial& material, const ImpactEvent& event, const Vec3& velocity, bool down)
{
  if (material.restitutionModel == RestitutionModel::Velocity)
  {
    return down ? Vec3(event.restitution * velocity) : velocity;
  }
  const Vec3 away = velocity.dot(event.normal) * event.normal;
  return away + material.tangentialRestitution * (velocity - away);
}

} // namespace rockfall
