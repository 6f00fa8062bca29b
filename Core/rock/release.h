#pragma once

/// @file
/// The part of a release that is drawn in each iteration: place, attitude, volume (METHOD 7).

#include "base/VolumeDistribution.h"
#include "base/types.h"
#include "terrain/Terrain.h"

#include <cstdint>

namespace rockfall
{

struct Rock;

enum class AttitudeLaw
{
  AsGiven = 0,
  Random = 1,  ///< Uniform over all rotations.
  Deviate = 2, ///< Turned about a random axis, normally distributed.
};

/// How sure a rock's release is. All of it off by default.
struct ReleaseUncertainty
{
  /// Standard deviations of the place, m, ≥ 0: of x and of y each, and of the height over ground.
  double horizontalDeviation = 0.0;
  double verticalDeviation = 0.0;
  AttitudeLaw attitude = AttitudeLaw::AsGiven;
  /// Standard deviation of the angles about each of the three axes, rad, ≥ 0. For Deviate.
  double attitudeDeviation = 0.0;
  /// Volume to be drawn; Fixed keeps the rock's own.
  VolumeDistribution volume;

  bool any() const
  {
    return this->horizontalDeviation > 0.0 || this->verticalDeviation > 0.0 ||
      this->attitude != AttitudeLaw::AsGiven || this->volume.law != VolumeLaw::Fixed;
  }
  void validate() const; ///< Throws ParameterError naming field and value.
};

/// Of three uniform numbers, uniform over all rotations: Shoemake (1992), Uniform random rotations,
/// Graphics Gems III, 124–132.
Quat randomRotation(double u, double v, double w);

/// The rock as it is released in this iteration: a function of (seed, iteration, index) alone,
/// `index` being that of the rock in the run.
///
/// Height over ground goes with the rock: a rock that is moved, turned or grown is as far over the
/// slope (as surveyed) at its new place as the given one at its own, plus the deviation of the
/// height, and never inside the slope: where that would put it into the ground it stands on it. A
/// place outside of the slope is drawn again, so that the deviation is cut off at the edge. Throws
/// PlacementError if a thousand places are all outside.
Rock realise(
  const Terrain& terrain, const Rock& rock, std::uint64_t seed, int iteration, std::uint64_t index);

} // namespace rockfall
