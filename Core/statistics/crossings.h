#pragma once

/// @file
/// Where rocks pass a line, such as a road or a planned barrier, and what a barrier there would
/// catch.

#include "statistics/frequency.h"
#include "statistics/path.h"
#include "statistics/sample.h"

#include <limits>
#include <string>
#include <vector>

namespace rockfall
{

class Terrain;

/// A line in the x–y plane, in the frame of the paths.
struct CollectorLine
{
  std::vector<Eigen::Vector2d> points; ///< Two or more, m.
  std::string name;                    ///< For people.
  double barrierHeight = 0.0;          ///< m; infinite if height does not matter.
  double barrierCapacity = 0.0;        ///< J; infinite if energy does not matter.
  double offset = 0.0;                 ///< To the left of the line that it is a parallel of, m.
};

/// A passing: the path goes from one side of a segment's vertical plane to the other; at a vertex
/// of the line, from one side of the line to the other.
struct Crossing
{
  int line = 0;
  int iteration = 0;
  int rock = 0;
  std::int64_t blockId = 0;
  int piece = 0;     ///< Of the rock; 0: the whole rock.
  int number = 0;    ///< Of this rock's passings of this line, from 0 in time.
  double time = 0.0; ///< s
  Vec3 position = Vec3::Zero();
  double distance = 0.0; ///< Along the line from its first point, m.
  int direction = 0;     ///< 1 from the line's right to its left, −1 the other way.
  Vec3 velocity = Vec3::Zero();
  Vec3 rotationRate = Vec3::Zero(); ///< rad/s
  double kineticEnergy = 0.0;       ///< J
  double translationalEnergy = 0.0; ///< J, NaN without a mass.
  double heightOverGround = 0.0;    ///< m, NaN where there is no ground.
  /// Of the centroid over the ground straight under it, m; NaN without a terrain there.
  double centreOverGround = std::numeric_limits<double>::quiet_NaN();
  double top = std::numeric_limits<double>::quiet_NaN();       ///< topOverGround
  double frequency = std::numeric_limits<double>::quiet_NaN(); ///< Of the rock, 1/a, if known.
  /// Of this fall of the rock, 1/a: its frequency over the iterations that released it.
  double weight = std::numeric_limits<double>::quiet_NaN();
  /// Between the horizontal velocity and the line's normal on the side that the rock goes to, rad:
  /// 0 straight across, positive if it goes towards the line's end, ±π/2 along it.
  double horizontalAngle = 0.0;
  double verticalAngle = 0.0; ///< Of the velocity over the horizontal, rad; negative falling.
};

/// Height of the rock's highest point over the ground, m: as far above the centroid as the point
/// next to the ground is below it, which holds for bodies that are the same upside down. Without a
/// terrain that point is `width` (m) below the top. NaN if neither is known.
double topOverGround(const Crossing& crossing, double width);

/// Appends every passing of a path through a line, in the order of time. A path that touches the
/// line and goes back does not pass; one that begins on it has not passed it. `terrain`, if given,
/// is the ground between the points of the path, in the path's frame; else that is straight. Throws
/// DataError as checkPath.
void appendCrossings(const RockPath& path, const CollectorLine& line, int lineNumber,
  const Terrain* terrain, std::vector<Crossing>& crossings);

/// Passings of one line, and what a barrier of its height and capacity would catch.
struct LineSummary
{
  int rocks = 0;     ///< Rocks (iteration × rock) that passed.
  int crossings = 0; ///< Passings; a rock may come back.
  double share = 0.0;
  double shareError = 0.0; ///< binomialError over all released.
  int highestQuantile = 0; ///< Quantile that so many rocks can give, %.
  /// J; of all rocks, each as it passes for the first time; of pieces of a rock the largest values.
  SampleStatistics energy;
  SampleStatistics height;       ///< m
  SampleStatistics speed;        ///< m/s
  FrequencyRange frequencies;    ///< Weights of all rocks.
  int caught = 0;                ///< As outcomeOf has it, at the first passing.
  double caughtShare = 0.0;      ///< Of those that passed.
  double caughtShareError = 0.0; ///< binomialError.
  std::vector<double> energies;  ///< Ascending, J.
  std::vector<double> heights;   ///< Ascending, m; without those that have none.
};

/// `crossings`: those of all lines and paths, of which `lineNumber`'s count. `released`: rocks ×
/// iterations. Results do not depend on the order of `crossings`.
LineSummary summarizeLine(const CollectorLine& line, int lineNumber,
  std::span<const Crossing> crossings, std::int64_t released);

} // namespace rockfall
