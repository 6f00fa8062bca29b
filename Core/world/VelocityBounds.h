#pragma once

/// @file
/// Velocities that rocks may have within a step, alone and in an island, and how fast gaps close.

#include "world/WorldState.h"

#include <algorithm>
#include <vector>

namespace rockfall
{

/// Velocities that a rock may have in the step.
struct VelocityBounds
{
  double own = 0.0;  ///< The longest displacement if nothing strikes it, m.
  double mass = 0.0; ///< kg
  /// All velocities that points of it may have until it meets another rock are in a ball, m/s:
  /// about its velocity if it flies clear of the slope; else the slope may stop it or throw it
  /// back.
  Vec3 middle = Vec3::Zero();
  double spread = 0.0;
  Vec3 velocity = Vec3::Zero();        ///< m/s
  Quat orientation = Quat::Identity(); ///< The one for which `turned` stands.
  Vec6 strain = Vec6::Zero();
  /// Centre of the ball in which neighbours have been looked for, less the drift of all rocks
  /// since, m.
  Vec3 covered = Vec3::Zero();
  double cover = 0.0; ///< Radius of the ball, m.
  bool slept = true;  ///< Then: others that did were no neighbours.
};

/// Rocks that may touch within the step, or one alone.
struct IslandBounds
{
  Vec3 lower, upper; ///< Velocities of its points, m/s.
  double heaviest;   ///< kg
  int size;

  /// A light rock that a heavy one strikes goes on faster than it, by this factor. `bounciest`:
  /// the largest restitution of rocks on each other.
  double massRatioGain(double mass, double bounciest) const
  {
    return bounciest * heaviest > mass ? (1.0 + bounciest) * heaviest / (heaviest + mass) : 1.0;
  }
  /// Largest component along the normal of a velocity of one of its rocks, m/s.
  double most(const Vec3& normal, const VelocityBounds& velocities) const
  {
    return size > 1 ? normal.cwiseProduct(lower).cwiseMax(normal.cwiseProduct(upper)).sum()
                    : velocities.spread + normal.dot(velocities.middle);
  }
  void add(const IslandBounds& other)
  {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
    heaviest = std::max(heaviest, other.heaviest);
    size += other.size;
  }
};

/// Speed at which the gap of two rocks of these islands may close along a normal, m/s.
inline double closingSpeed(const IslandBounds& first, const VelocityBounds& firstVelocities,
  const IslandBounds& second, const VelocityBounds& secondVelocities, const Vec3& normal)
{
  return &first == &second
    ? normal.cwiseAbs().dot(first.upper - first.lower)
    : std::max(0.0, first.most(-normal, firstVelocities) + second.most(normal, secondVelocities));
}

} // namespace rockfall
