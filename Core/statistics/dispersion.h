#pragma once

/// @file
/// The dispersion angle θ = arctan(W / 2L) (METHOD 9.3; paper 3.3).

#include "base/types.h"

#include <limits>
#include <span>
#include <vector>

namespace rockfall
{

/// The dispersion of one group of trajectories.
struct Dispersion
{
  int trajectories = 0; ///< How many counted.
  double length = 0.0;  ///< L, falling length along the cross-section, m.
  double width = 0.0;   ///< W, m.
  double angle = std::numeric_limits<double>::quiet_NaN(); ///< θ, rad; none where L is 0.
  double lateralMin = 0.0; ///< Extreme lateral deviations: W = lateralMax − lateralMin, m.
  double lateralMax = 0.0;
  double lateralDeviation = 0.0; ///< Standard deviation of the lateral stop/exit positions, m.
  Vec3 apex = Vec3::Zero();      ///< Mean start, where the wedge begins.
};

/// `paths`: one polyline per trajectory (world or local points, m). `azimuth`: direction of the
/// cross-section in the x–y plane from +x counter-clockwise, rad. `length`: L, m; 0 = up to the
/// farthest that any path of the group got. Lateral deviation is measured across the direction from
/// each rock's own start if `fromOwnStart`, else from the mean start; only points with a run of at
/// most L count (paths are cut at L exactly). `rockOf`, for rocks that broke: of each path the number
/// of that which its rock began with; a rock counts once, with all of its pieces' points, and ends
/// with the piece that got farthest. Throws ParameterError for a negative or non-finite length.
Dispersion measureDispersion(std::span<const std::vector<Vec3>> paths, double azimuth,
  double length = 0.0, bool fromOwnStart = true, std::span<const std::size_t> rockOf = {});

/// Start and end of each rock: of one that broke the end of the piece that got farthest.
std::vector<std::vector<Vec3>> endsOfRocks(
  std::span<const std::vector<Vec3>> paths, std::span<const std::size_t> rockOf);

/// Mean horizontal direction from start to end of the paths, rad; 0 if they go nowhere.
double meanAzimuth(std::span<const std::vector<Vec3>> paths);

} // namespace rockfall
