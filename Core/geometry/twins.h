#pragma once

/// @file
/// Places that are there twice: points, lines, parts of lines and ground of polygons.

#include "base/types.h"

#include <functional>
#include <optional>
#include <vector>

namespace rockfall
{

/// Two places that differ by no more are the same one, m.
inline constexpr double kTwinDistance = 0.1;
/// No coordinate of a map is so large, m, not even in Gauss-Krüger zones with a number before them.
inline constexpr double kFarthest = 1e9;
/// Length that lines must share, m: lines that cross or meet at an end share less.
inline constexpr double kSharedLength = 2.0;
/// Share of the smaller one of two polygons: less is the width of a pen on a map.
inline constexpr double kSharedGround = 0.1;

using PlanLine = std::vector<Eigen::Vector2d>;
/// The parts of a line.
using PlanLines = std::vector<PlanLine>;

/// Of each place (a line: all of it, in whichever direction and by whichever corners) the first one
/// within `kTwinDistance`, −1 if there is none before it.
std::vector<int> earlierPoints(const std::vector<Eigen::Vector2d>& points);
std::vector<int> earlierLines(const PlanLines& lines);

/// The part of a line that lies within `kTwinDistance` of another one, and where it crosses itself.
struct SharedStretch
{
  int earlier = -1;    ///< The other line, of several the longest; the line's own number: itself.
  double length = 0.0; ///< m
  Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();
  /// End of the first loop that is as long as `kSharedLength`.
  std::optional<Eigen::Vector2d> crossing;
};

/// Whether two of a list, by their numbers, count as the same if they are at one place.
using Alike = std::function<bool(int, int)>;

/// Of each line the stretch, of `kSharedLength` at least, on one before it or on itself; none of
/// lines that are all on another one. Costs what lies nearby; of a crowd at one place only the first
/// ones are looked at.
std::vector<SharedStretch> sharedStretches(
  const std::vector<PlanLines>& lines, const Alike& alike = nullptr);

/// Ground of a polygon that lies in another one as well.
struct SharedGround
{
  int earlier = -1;  ///< The other area, the first of several.
  double area = 0.0; ///< m², to two digits.
};

/// Corners of rings, m; an odd number of them encloses.
using PlanRings = std::vector<std::vector<Vec3>>;

/// Of each polygon the ground that it has in common with one before it, `kSharedGround` of the
/// smaller one at least.
std::vector<SharedGround> sharedGround(
  const std::vector<PlanRings>& polygons, const Alike& alike = nullptr);

} // namespace rockfall
