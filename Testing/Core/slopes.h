#pragma once

/// @file
/// Slopes and runs that several tests share.

#include "geometry/shapes.h"
#include "runEnsemble.h"

#include <cmath>
#include <functional>

namespace rockfall::testing
{

constexpr double kGravity = 9.81; // m/s²

/// A square slope of n × n nodes from a height function of local x, y.
inline Terrain makeSlope(int n, double cellSize, const std::function<double(double, double)>& z,
  SurfaceMaterial material = {}, Roughness roughness = {})
{
  GridGeometry g;
  g.columns = n;
  g.rows = n;
  g.cellSize = cellSize;
  std::vector<double> heights;
  for (int row = 0; row < n; ++row)
  {
    for (int column = 0; column < n; ++column)
    {
      heights.push_back(z(column * cellSize, (n - 1 - row) * cellSize));
    }
  }
  return Terrain(g, std::move(heights), material, roughness);
}

/// A plane through (size/2, size/2, 100 m) that falls by `angle` (rad) towards `azimuth` (rad).
inline Terrain makePlane(int n, double size, double angle, double azimuth,
  const SurfaceMaterial& material, const Roughness& roughness = {})
{
  const double fall = std::tan(angle);
  return makeSlope(
    n, size / (n - 1),
    [=](double x, double y)
    {
      return 100.0 -
        fall * ((x - 0.5 * size) * std::cos(azimuth) + (y - 0.5 * size) * std::sin(azimuth));
    },
    material, roughness);
}

/// The shortest turn that takes one direction (any length) to another. Eigen's FromTwoVectors
/// instantiates an SVD for opposite vectors, which doubles what a test takes to compile.
inline Quat turnBetween(const Vec3& from, const Vec3& to)
{
  const Vec3 a = from.normalized();
  const Vec3 b = to.normalized();
  const double cosine = a.dot(b);
  if (cosine < -1.0 + 1e-12)
  {
    const Vec3 across = a.cross(std::abs(a.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
    return Quat(0.0, across.x(), across.y(), across.z());
  }
  const Vec3 axis = a.cross(b);
  return Quat(1.0 + cosine, axis.x(), axis.y(), axis.z()).normalized();
}

inline SurfaceMaterial material(double restitution, double frictionDegrees)
{
  SurfaceMaterial m;
  m.restitution = restitution;
  m.frictionAngle = radians(frictionDegrees);
  return m;
}

/// Ground that yields and gives nothing back, without friction that grows with slip.
inline SurfaceMaterial softGround()
{
  SurfaceMaterial m;
  m.restitutionModel = RestitutionModel::NormalTangential;
  m.restitution = 0.0;
  m.yielding.modulus = 15e6;
  m.yielding.depthFactor = 0.125;
  m.yielding.compaction = 1.5;
  m.yielding.rollingResistance = 0.4;
  return m;
}

/// The samples at multiples of the output interval, and the end.
inline std::vector<Sample> evenSamples(const Trajectory& trajectory)
{
  std::vector<Sample> samples = trajectory.samples;
  std::erase_if(samples, [](const Sample& s) { return s.kind == SampleKind::Knot; });
  return samples;
}

/// One rock, one iteration.
inline Trajectory simulate(
  const Terrain& terrain, const Rock& rock, const SimulationParameters& parameters)
{
  TrajectoryStore store(1, 1);
  runEnsemble(terrain, std::span<const Rock>(&rock, 1), parameters, store);
  return store.trajectories().front();
}

/// A unit cube lying face down on the plane of makePlane, `up` the slope from the middle (m).
inline Rock cubeOnPlane(double size, double angle, double azimuth, double up)
{
  const Vec3 normal(
    std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle));
  const Vec3 downhill(
    std::cos(angle) * std::cos(azimuth), std::cos(angle) * std::sin(azimuth), -std::sin(angle));
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.orientation = turnBetween(Vec3::UnitZ(), normal);
  rock.position = Vec3(0.5 * size, 0.5 * size, 100.0) - up * downhill + 0.5 * normal;
  return rock;
}

} // namespace rockfall::testing
