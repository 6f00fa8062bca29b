#pragma once

/// @file
/// The way of a rock between its samples: from one point of a trajectory to the next the centroid
/// follows the cubic Hermite curve of their positions and velocities, which in flight is the
/// parabola itself. What is made of trajectories asks this curve, so that it does not depend on how
/// often they were sampled. Velocities are linear in time between the points, as they are in
/// flight: they never exceed those of the points, whatever an impact does to the curve.

#include "base/types.h"

#include <array>
#include <limits>
#include <span>

namespace rockfall
{

/// A point of a trajectory.
struct PathPoint
{
  double time = 0.0;                ///< s
  Vec3 position = Vec3::Zero();     ///< Centroid, m.
  Vec3 velocity = Vec3::Zero();     ///< m/s
  Vec3 rotationRate = Vec3::Zero(); ///< rad/s
  double kineticEnergy = 0.0;       ///< Translation and rotation, J.
  double heightOverGround = 0.0;    ///< m, NaN where there is no ground.
};

/// The path of one rock in one iteration.
struct RockPath
{
  int iteration = 0;
  int rock = 0;
  std::int64_t blockId = 0;
  /// Of a rock that broke, which counts once whatever the number of its pieces; 0: the whole rock.
  int piece = 0;
  /// kg. NaN if it is not known: then energy between two points is interpolated in time.
  double mass = std::numeric_limits<double>::quiet_NaN();
  /// m; a map's cells that are narrower are touched if they are under it. 0: it
  /// is a point; NaN: as a point, but how high its top is is not known.
  double width = 0.0;
  bool rested = false;               ///< Ends at rest, so that its end is a stopping point.
  std::span<const PathPoint> points; ///< Times never descend.
};

/// c[0] + c[1] s + c[2] s² + c[3] s³
struct Cubic
{
  std::array<double, 4> c{};
  double operator()(double s) const { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }
};

/// Places in [from, to] where a polynomial changes its sign, ascending; 0 counts as positive.
struct Roots
{
  int count = 0;
  std::array<double, 3> at{};
};
Roots signChanges(const Cubic& polynomial, double from, double to);

/// Places strictly inside (from, to) where it has its extremes, ascending.
Roots extremes(const Cubic& polynomial, double from, double to);

/// The curve between two points, s from 0 to 1.
class PathPiece
{
public:
  /// Needs b.time > a.time.
  PathPiece(const PathPoint& a, const PathPoint& b, double mass);

  /// Coordinate 0, 1 or 2 (x, y, z), m.
  const Cubic& along(int axis) const { return place_[std::size_t(axis)]; }
  /// Bounds of a coordinate, not always the least: those of the Bézier points.
  std::array<double, 2> bounds(int axis) const;
  double time(double s) const { return a_.time + s * duration_; }
  Vec3 position(double s) const { return { place_[0](s), place_[1](s), place_[2](s) }; }
  Vec3 velocity(double s) const { return (1.0 - s) * a_.velocity + s * b_.velocity; }
  /// Linear between the points, as nothing is known of the attitude there.
  Vec3 rotationRate(double s) const { return (1.0 - s) * a_.rotationRate + s * b_.rotationRate; }
  /// ½ m v², J; NaN without a mass.
  double translationalEnergy(double s) const;
  /// J. The rotational share is linear between the points; in flight it is constant.
  double kineticEnergy(double s) const;
  /// Height over a ground of elevation 0 that lies under the rock as `below` has it, as a cubic:
  /// z − (what lies between the centroid and height 0 at the points, linear in between), m.
  /// Without a ground `groundA` and `groundB` are 0, and the ground is a straight line between the
  /// points; with a terrain they are its elevations there and its elevation at s is to be
  /// subtracted. Where only one point has a height, its offset holds at the other as well; NaN
  /// where none has.
  Cubic height(double groundA = 0.0, double groundB = 0.0) const;

  /// Largest values between two places of the piece.
  double maxSpeed(double from, double to) const;
  double maxKineticEnergy(double from, double to) const;
  double maxRotationRate(double from, double to) const;

private:
  const PathPoint& a_;
  const PathPoint& b_;
  double mass_;
  double duration_;
  std::array<Cubic, 3> place_;
};

/// Throws DataError that names iteration, rock and time if a number is not finite (heights may be
/// NaN) or times descend.
void checkPath(const RockPath& path);

} // namespace rockfall
