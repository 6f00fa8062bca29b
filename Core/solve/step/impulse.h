#pragma once

/// @file
/// An impact of one rigid body as an event: its velocities jump, its place stays.
///
/// Each touched point is a spring without way. What its normal impulse takes from the motion is
/// stored there; from the stored energy E comes its part of the next impulse,
///
///     dP = √(2 k E) dτ,    dE = −w dP in compression (w < 0), −w dP / e² in restitution (w ≥ 0),
///
/// with w the speed of the point along its normal: energetic restitution (Stronge 1990) at several
/// points at once (Liu, Zhao & Brogliato 2008). It gives back e² of what it took, whatever friction
/// does meanwhile, and ends when nothing comes in and nothing is stored. Friction is Coulomb's at
/// each part of the impulse (Routh 1905), so that slip may stop, turn or begin within the impact.
/// In each part velocities are linear in the impulse: its works are exact, and the energy lost is
/// to the last digit the sum of both losses.

#include "base/types.h"

#include <span>

namespace rockfall
{

/// A point of the body that touches: given, and what the impact did there.
struct ImpulsePoint
{
  Vec3 normal;              ///< Of the ground, world, unit.
  Vec3 lever;               ///< From the centroid, world, m.
  double friction = 0.0;    ///< tan φ
  double restitution = 0.0; ///< e, 0 … 1.
  double stiffness = 1.0;   ///< k; only ratios count.

  double impulse = 0.0;         ///< Normal, N s.
  double restitutionLoss = 0.0; ///< J
  double frictionLoss = 0.0;    ///< J
};

/// A rigid body for the time of an impact, world axes.
struct ImpulseBody
{
  double inverseMass;   ///< 1/kg
  Mat3 inverseInertia;  ///< 1/(kg m²)
  Vec3 velocity;        ///< m/s
  Vec3 angularVelocity; ///< rad/s
};

/// Most points of one impact; further ones come in by themselves.
inline constexpr std::size_t kMostImpulsePoints = 16;

/// Resolves the impact at these points. A point that comes in no faster than `quiet` (m/s) is left
/// as it is.
void resolveImpulse(ImpulseBody& body, std::span<ImpulsePoint> points, double quiet);

} // namespace rockfall
