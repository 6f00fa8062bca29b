#pragma once

/// @file
/// Rocks that are in each other when they are released: found, kept from it, or pushed apart.

#include "rock/Rock.h"
#include "terrain/Terrain.h"

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace rockfall
{

/// Two rocks that overlap.
struct RockOverlap
{
  int first = -1;              ///< Index of a rock.
  int second = -1;             ///< Larger.
  double depth = 0.0;          ///< m, > 0.
  Vec3 normal = Vec3::UnitZ(); ///< The shortest way out for the first rock, unit.
};

/// All pairs that are in each other by more than rounding (1e-6 of the smaller radius), in
/// ascending order. Blocks of one cut mass touch, and do not overlap.
std::vector<RockOverlap> findOverlaps(std::span<const Rock> rocks);

/// Throws PlacementError, naming both blocks, if one rock is given twice: of the same vertices at
/// the same place, within 1e-6 of the radius. `origin` is what positions are about, m.
void requireEachOnce(std::span<const Rock> rocks, const Vec3& origin);

/// Throws PlacementError if rocks overlap, naming the two that do it the deepest. `when` goes
/// before the advice, as " in iteration 3".
void requireNoOverlap(std::span<const Rock> rocks, const Vec3& origin, const std::string& when);

/// Result of pushing rocks apart before they fall: the most of any iteration.
struct PushedApart
{
  std::int64_t rocks = 0; ///< How many were moved.
  double farthest = 0.0;  ///< The longest way of one, m.
  int passes = 0;
  std::int64_t iterations = 0; ///< In how many any were moved.

  void add(const PushedApart& others); ///< Of other iterations.
};

/// Moves rocks that overlap apart until none do. In each pass every pair gives way along its
/// shortest way out, the lighter rock the more, each rock by the mean of what its pairs ask for;
/// what that brings into the slope as surveyed is raised onto it. After 100 passes masses do not
/// count any more, and of two that lie on each other the upper one gives way. Nothing depends on
/// threads.
/// Throws PlacementError if a rock leaves the slope or 5000 passes don't do.
PushedApart pushApart(const Terrain& terrain, std::span<Rock> rocks);

/// Rocks that are placed one after the other, none in another.
class ApartPlacer
{
public:
  /// `largest`: of the rocks' radii, m.
  explicit ApartPlacer(double largest)
    : cell_(2.0 * largest)
  {
  }

  /// Whether the rock overlaps none of those that were added. Where the attitude of either is drawn
  /// in each iteration, their bounding spheres must not overlap.
  bool fits(const Rock& rock) const;
  void add(const Rock& rock);

private:
  std::array<std::int64_t, 2> cellOf(const Vec3& place) const;

  double cell_;
  std::vector<Rock> rocks_;
  std::map<std::array<std::int64_t, 2>, std::vector<std::size_t>> cells_;
};

} // namespace rockfall
