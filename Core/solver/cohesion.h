#pragma once

/// @file
/// How cohesion comes in with the normal force.

namespace rockfall
{

/// Coulomb's limit is μ N + c from where N is c over this; below it c is replaced by this times N.
/// At the literal limit a contact that carries next to nothing holds by all of c and one that opens
/// by nothing: open–close goes round in circles between the two.
constexpr double kCohesionPerForce = 20.0;

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
