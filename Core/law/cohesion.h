#pragma once

/// @file
/// How cohesion comes in with the normal force.

#include <cstddef>

namespace rockfall
{

/// Coulomb's limit is μ N + c from where N is c over this; below it c is replaced by this times N.
/// At the literal limit a contact that carries next to nothing holds by all of c and one that opens
/// by nothing: open–close goes round in circles between the two.
constexpr double kCohesionPerForce = 20.0;

/// Two faces have a point wherever corners and edges of one meet the other: four where edges are
/// parallel, eight where they are turned by what rounding turns them. More than this many share
/// what so many have.
constexpr int kCohesivePoints = 4;

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
