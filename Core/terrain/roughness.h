#pragma once

/// @file
/// Roughness of the ground beyond its survey: random heights, drawn per iteration (METHOD 7).
///
/// With a length of 0 every node of the raster gets a height of its own, the paper's way: what
/// rocks feel of it depends on the distance of the nodes. With a length it is a field over the map,
/// h(x, y) = mean + σ F(x/ℓ, y/ℓ) + O(x/ℓ, y/ℓ), of which F is Gaussian and O are obstacles, one in
/// each square of side ℓ. The field is the same whatever the nodes: cells that are too wide for it
/// are cut, as rocks meet them, into finer ones (Surface), of which nothing is stored.

#include "base/random.h"

#include <array>
#include <cstdint>

namespace rockfall
{

/// Random height over the surveyed slope.
struct Roughness
{
  double mean = 0.0;      ///< m
  double deviation = 0.0; ///< σ, m, ≥ 0.
  /// ℓ: where the correlation of two places has come down to 1/e, and between obstacles, m. 0:
  /// nodes are drawn independently.
  double length = 0.0;
  /// Heights of 70, 20 and 10 % of the obstacles, m, ≥ 0: those that a field survey for Rockyfor3D
  /// writes down (rg70, rg20, rg10).
  std::array<double, 3> obstacles = { 0.0, 0.0, 0.0 };

  bool hasObstacles() const { return this->highestObstacle() > 0.0; }
  bool any() const { return this->mean != 0.0 || this->deviation != 0.0 || this->hasObstacles(); }
  bool varies() const { return this->deviation > 0.0 || this->hasObstacles(); }
  bool isField() const { return this->length > 0.0 && this->any(); }
  /// Widest distance of nodes that shows the field, m; 0: there is none.
  double resolvedBy() const;
  /// The same with the heights of a field's nodes, so far apart (m), raised to what gives the ground
  /// between them its σ on the average over the map. Straight from node to node it has less.
  Roughness onNodes(double spacing) const;
  double highest() const; ///< No height is above, m, ≥ 0.
  double deepest() const; ///< No height is further below the survey, m, ≥ 0.
  double highestObstacle() const;

  void validate() const; ///< Throws ParameterError naming field and value.
  bool operator==(const Roughness&) const = default;
};

/// Fields over the map: functions of seed, iteration and place (easting, northing, m), for ever.
struct RoughField
{
  std::uint64_t seed;
  std::uint32_t iteration;

  /// F: mean 0, variance 1, correlation exp(−(r/ℓ)²) within 0.011; within ±kMostDeviates. Another
  /// one for each purpose.
  double gaussian(
    double easting, double northing, double length, Draw purpose = Draw::RoughField) const;
  /// O: a cap h (1 − (r/w)²)² about a random place of every square, h by chance one of the three, w
  /// = ℓ/2; where caps overlap the highest, m.
  double obstacles(double easting, double northing, const Roughness& roughness) const;
  /// Both and the mean, m.
  double height(double easting, double northing, const Roughness& roughness) const;
};

/// Largest magnitude of a field's deviate: one in 150,000 places has more, and is cut off there.
constexpr double kMostDeviates = 4.5;

} // namespace rockfall
