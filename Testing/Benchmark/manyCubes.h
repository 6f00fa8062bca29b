#pragma once

/// @file
/// The rocks of the benchmarks of mass falls: cubes of 0.6 m³ in columns with gaps of 0.15 m above
/// the slope of benchSlope.h; and how deep they overlap.

#include "benchSlope.h"
#include "contact/pairs.h"
#include "geometry/shapes.h"
#include "simulation/ensemble.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace rockfall
{

constexpr double kCubeVolume = 0.6; // m³
constexpr double kRockRestitution = 0.2, kRockFriction = 15.0;

/// Seconds of motion.
inline double fallTime(int count)
{
  return count <= 1000 ? 5.0 : 3.0;
}

inline std::vector<Rock> columns(int count)
{
  const Polyhedron cube = makeShape(Shape::Cube, kCubeVolume);
  const int nx = count <= 1000 ? 10 : 20, ny = count <= 1000 ? 10 : 25;
  const double spacing = std::cbrt(kCubeVolume) + 0.15;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<Rock> rocks(count);
  for (int k = 0; k < count; ++k)
  {
    const int a = k % nx, b = k / nx % ny, level = k / (nx * ny);
    Rock& rock = rocks[k];
    rock.blockId = k;
    rock.shape = cube;
    const double x = 8.0 + a * spacing + 0.02 * (u(random) - 0.5);
    const double y = 100.0 + (b - ny * 0.5) * spacing + 0.02 * (u(random) - 0.5);
    rock.position = Vec3(x, y, (100.0 - x) * std::tan(radians(30.0)) + 0.5 + 1.0 + level * spacing);
  }
  return rocks;
}

/// The deepest overlap of two of them, of their edge. `stateOf(i)` is where number i stands.
template <class StateOf>
double deepestOverlap(const Block& cube, int count, StateOf&& stateOf)
{
  std::vector<PlacedBlock> placed(count);
  std::vector<PairBody> bodies(count);
  std::vector<int> byX(count);
  for (int i = 0; i < count; ++i)
  {
    placed[i].place(cube, stateOf(i));
    bodies[i].update(placed[i]);
    byX[i] = i;
  }
  std::sort(byX.begin(), byX.end(),
    [&](int i, int j) { return bodies[i].position.x() < bodies[j].position.x(); });
  const double reach = 2.0 * cube.radius();
  double deepest = 0.0;
  for (int a = 0; a < count; ++a)
  {
    const PairBody& one = bodies[byX[a]];
    for (int b = a + 1; b < count; ++b)
    {
      const PairBody& other = bodies[byX[b]];
      const Vec3 apart = other.position - one.position;
      if (apart.x() > reach)
      {
        break;
      }
      if (apart.squaredNorm() < reach * reach)
      {
        deepest = std::max(deepest, -findAxis(one, other, {}, 0.0).distance);
      }
    }
  }
  return deepest / std::cbrt(kCubeVolume);
}

} // namespace rockfall
