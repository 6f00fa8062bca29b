#pragma once

/// @file
/// One rock let go just before an impact, and what it has when it takes off again.

#include "run/ensemble.h"

namespace rockfall::calibration
{

/// Hops shorter than this are part of the impact: they are no flights that could be tracked, s.
constexpr double kShortestFlight = 0.1;
/// An impact that has not ended by then is cut off: the rock slides or rolls on, s.
constexpr double kLongestImpact = 0.4;

/// A rock before and after.
struct ImpactOutcome
{
  bool touched = false;
  bool tookOff = false;      ///< Else it was cut off, or rested.
  double energyBefore = 0.0; ///< ½ m v², J.
  double energyAfter = 0.0;
  double spinBefore = 0.0; ///< ½ ω·J ω, J.
  double spinAfter = 0.0;
  double rateBefore = 0.0; ///< |ω|, rad/s.
  double rateAfter = 0.0;
  Vec3 velocityAfter = Vec3::Zero(); ///< m/s
  double duration = 0.0;             ///< From the touch to the take-off, s.
  double way = 0.0;                  ///< Horizontal, of the centroid, in that time, m.
  double scarDepth = 0.0;            ///< Of the first impact, m.
  double scarLength = 0.0;           ///< m
};

/// A rock on its parabola before a place at which it would have a velocity: as far back as is
/// needed for a ball around it to be clear of the slope, or as it is farthest within half a second.
Rock heldBack(const Terrain& terrain, Rock rock, double gravity);

/// First impact of a rock on one realisation of the slope.
ImpactOutcome simulateImpact(
  const Terrain& terrain, const Rock& rock, const SimulationParameters& p, int iteration);

/// All of them, rock k on iteration k, on as many threads as `p` says.
std::vector<ImpactOutcome> simulateImpacts(
  const Terrain& terrain, const std::vector<Rock>& rocks, const SimulationParameters& p);

} // namespace rockfall::calibration
