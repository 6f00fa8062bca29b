#pragma once

/// @file
/// A rock as it is released.

#include "block/Block.h"
#include "geometry/Polyhedron.h"
#include "rock/release.h"

#include <cstdint>
#include <string>

namespace rockfall
{

struct Rock
{
  std::int64_t blockId = 0;
  Polyhedron shape;             ///< Centroid at the origin, body axes = world axes at release
                                ///< when `orientation` is the identity, m.
  Vec3 position = Vec3::Zero(); ///< Centroid in the terrain's local frame, m.
  Quat orientation = Quat::Identity(); ///< Body to world.
  Vec3 velocity = Vec3::Zero();        ///< m/s
  Vec3 angularVelocity = Vec3::Zero(); ///< World axes, rad/s.
  double density = 2500.0;             ///< kg/m³, > 0.
  double youngModulus = 1e10;          ///< Pa, > 0.
  double poissonRatio = 0.1;           ///< Dimensionless, 0 … 0.49.
  std::string material;                ///< Name, for contacts of rocks; empty: none.
  ReleaseUncertainty uncertainty;      ///< Drawn in each iteration.

  /// Throws ParameterError naming block, field and value, also for values beyond any rock's: more
  /// than 1000 m/s or 10,000 rad/s.
  void validate() const;
};

/// The block of a rock, unstrained.
Block blockOf(const Rock& rock);

} // namespace rockfall
