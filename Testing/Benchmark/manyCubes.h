#pragma once

/// @file
/// The rocks of the benchmarks of mass falls: cubes of 0.6 m³ in columns with gaps of 0.15 m above
/// the slope of benchSlope.h; and how deep they overlap.

#include "../overlap.h"
#include "benchSlope.h"
#include "geometry/shapes.h"
#include "run/ensemble.h"

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
  const auto blockOf = [&](int) -> const Block& { return cube; };
  return testing::deepestOverlap(count, blockOf, stateOf) / std::cbrt(kCubeVolume);
}

} // namespace rockfall
