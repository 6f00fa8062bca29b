#pragma once

/// @file
/// Figures of rocks on a straight slope with a flat foot, as field surveys give them.

#include "GroundSettings.h"

#include "geometry/shapes.h"
#include "rock/results.h"

#include <span>
#include <vector>

namespace rockfall::calibration
{

/// Of many rocks: lengths in m, angles in degrees from release to stop.
struct SlopeFigures
{
  double speed = 0.0, jump = 0.0;          ///< The greatest of a rock, 95 %; m/s, m over ground.
  double usualJump = 0.0;                  ///< The same jump, median.
  double runOut = 0.0;                     ///< Median.
  double reach = 0.0, reachFarthest = 0.0; ///< Median, the farthest 1 %.
  double longest = 0.0;                    ///< Until the last one is at its end, s.
};
SlopeFigures figuresOf(std::span<const TrajectorySummary> rocks);

/// A fall down this angle (degrees) and drop (m), let go 2 m over the ground, or by as much more as its
/// size asks for, at 1.5 m/s with attitudes drawn. The foot is of the same ground, or of meadow.
struct SlopeFall
{
  double angle = 35.0, drop = 258.0, volume = 1.0; ///< degrees, m, m³
  bool meadow = false;
};
/// Each of the shapes in as many iterations as the settings have.
SlopeFigures measure(
  const GroundSettings& settings, const SlopeFall& fall, const std::vector<Polyhedron>& shapes);

/// EOTA 111, cube and a box of 2 : 1 : 1 of this volume, m³.
std::vector<Polyhedron> mixedShapes(double volume);

} // namespace rockfall::calibration
