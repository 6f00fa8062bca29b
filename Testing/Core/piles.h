#pragma once

/// @file
/// Piles of rocks, for the tests of mass falls.

#include "../overlap.h"
#include "slopes.h"
#include "world/World.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

namespace rockfall::testing
{

/// A lasting step of so many seconds, under so much gravity (m/s²).
inline StepRequest lastingStep(double duration, double gravity, int maxOpenClose = 50)
{
  StepRequest request;
  request.duration = duration;
  request.kind = StepKind::Lasting;
  request.gravity = gravity;
  request.maxOpenClose = maxOpenClose;
  return request;
}

inline std::vector<Block> blocksOf(const std::vector<Rock>& rocks)
{
  std::vector<Block> blocks;
  for (const Rock& r : rocks)
  {
    blocks.emplace_back(r.shape, r.density, r.youngModulus, r.poissonRatio);
  }
  return blocks;
}

/// Cubes of some volume (m³) over a level floor, turned at random, in levels of `across`² about
/// (50, 50). No level stands over the other one: cubes that turn until they lie on each other would
/// make columns.
inline std::vector<Rock> levelsOfCubes(int count, int across, double volume, std::uint64_t seed)
{
  const double edge = std::cbrt(volume), spacing = 1.75 * edge; // room to be turned in
  const Polyhedron cube = makeShape(Shape::Cube, volume);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  std::vector<Rock> rocks;
  Vec3 shift = Vec3::Zero();
  for (int k = 0; k < count; ++k)
  {
    Rock rock;
    rock.blockId = k;
    rock.shape = cube;
    const int place = k % (across * across), level = k / (across * across);
    shift = place == 0 ? Vec3(edge * u(random), edge * u(random), 0.0) : shift;
    rock.position = shift +
      Vec3(50.0 + spacing * (place % across - 0.5 * (across - 1)),
        50.0 + spacing * (place / across - 0.5 * (across - 1)), edge + spacing * level);
    rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
    rocks.push_back(rock);
  }
  return rocks;
}

/// Adds what was released and where it went.
inline void add(EnergyAudit& sum, const EnergyAudit& e)
{
  sum.released += e.released;
  sum.friction += e.friction;
  sum.restitution += e.restitution;
  sum.exchanged += e.exchanged;
  sum.damping += e.damping;
  sum.numerical += e.numerical;
}

/// Rocks on a slope, run together.
struct Pile
{
  Terrain ground;
  std::vector<Rock> rocks;
  std::vector<Block> blocks;
  SimulationParameters parameters;
  std::unique_ptr<Surface> surface;
  std::unique_ptr<World> fall;
  bool awake = true; ///< Nothing sleeps.

  /// Up to the release: for whoever runs the fall to its end (World::run).
  void make()
  {
    blocks = blocksOf(rocks);
    parameters.rockRockContact = true;
    surface = std::make_unique<Surface>(ground, parameters.seed, 0);
    fall = std::make_unique<World>(*surface, rocks, blocks, parameters, 0, !awake);
  }
  void start()
  {
    this->make();
    fall->release();
  }
  /// Over a duration, s; returns the time reached.
  double run(double duration)
  {
    const double end = fall->time() + duration;
    while (fall->time() < end - 1e-9 && fall->advance())
    {
    }
    return fall->time();
  }
  std::vector<Vec3> places() const
  {
    std::vector<Vec3> all;
    for (int i = 0; i < fall->rocks(); ++i)
    {
      all.push_back(fall->state(i).position);
    }
    return all;
  }
  /// The longest way of a rock from where it was, m.
  double drift(const std::vector<Vec3>& from) const
  {
    double most = 0.0;
    for (int i = 0; i < fall->rocks(); ++i)
    {
      most = std::max(most, (fall->state(i).position - from[i]).norm());
    }
    return most;
  }
  double fastest() const
  {
    double most = 0.0;
    for (int i = 0; i < fall->rocks(); ++i)
    {
      most = std::max(most, fall->state(i).velocity.norm());
    }
    return most;
  }
  /// The deepest overlap of two rocks as they stand, m.
  double overlap() const
  {
    return deepestOverlap(
      fall->rocks(), [&](int i) -> const Block& { return blocks[std::size_t(i)]; },
      [&](int i) -> const BlockState& { return fall->state(i); });
  }
  /// Rocks of the largest group that may touch each other.
  int largestIsland() const
  {
    std::vector<int> parent(std::size_t(fall->rocks()));
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int i)
    {
      while (parent[std::size_t(i)] != i)
      {
        i = parent[std::size_t(i)];
      }
      return i;
    };
    for (const RockPair* pair : fall->pairs())
    {
      if (pair->linked)
      {
        parent[std::size_t(root(pair->first))] = root(pair->second);
      }
    }
    std::vector<int> size(parent.size(), 0);
    for (int i = 0; i < fall->rocks(); ++i)
    {
      ++size[std::size_t(root(i))];
    }
    return *std::max_element(size.begin(), size.end());
  }
  /// Sum of the slope's forces over the weight.
  double carried() const
  {
    double force = 0.0, weight = 0.0;
    for (int i = 0; i < fall->rocks(); ++i)
    {
      weight += blocks[i].mass() * parameters.gravity;
      for (const Contact& c : fall->rock(i).body().contacts)
      {
        force += c.normalForce * c.normal.z();
      }
    }
    return force / weight;
  }
};

/// Far below, so that nothing touches it.
inline Terrain abyss()
{
  return makeSlope(
    5, 100.0, [](double, double) { return -1000.0; }, material(1.0, 0.0));
}

inline Terrain floorSlope(double friction = 35.0)
{
  return makeSlope(
    9, 5.0, [](double, double) { return 0.0; }, material(0.3, friction));
}

inline Rock brick(const Vec3& size, const Vec3& center, std::int64_t id)
{
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
  {
    corners.emplace_back((k & 1 ? 0.5 : -0.5) * size.x(), (k & 2 ? 0.5 : -0.5) * size.y(),
      (k & 4 ? 0.5 : -0.5) * size.z());
  }
  Rock rock;
  rock.blockId = id;
  rock.shape = Polyhedron::convexHull(corners);
  rock.position = center;
  return rock;
}

/// Eleven voussoirs of a semicircle of 2 m inside and 3 m outside, standing on the floor.
inline std::vector<Rock> arch()
{
  std::vector<Rock> rocks;
  constexpr int stones = 11;
  for (int k = 0; k < stones; ++k)
  {
    std::vector<Vec3> corners;
    for (int s = 0; s < 2; ++s)
    {
      const double a = std::numbers::pi * (k + s) / stones;
      for (double r : { 2.0, 3.0 })
      {
        for (double y : { -0.5, 0.5 })
        {
          corners.emplace_back(20.0 + r * std::cos(a), 20.0 + y, r * std::sin(a));
        }
      }
    }
    const Polyhedron hull = Polyhedron::convexHull(corners);
    Rock rock;
    rock.blockId = k;
    rock.position = hull.integrals().centroid;
    rock.shape = hull.centred();
    rocks.push_back(rock);
  }
  return rocks;
}

/// Cubes of 1 m on each other.
inline std::vector<Rock> column(int height)
{
  std::vector<Rock> rocks;
  for (int i = 0; i < height; ++i)
  {
    rocks.push_back(brick(Vec3(1, 1, 1), Vec3(20.0, 20.0, 0.5 + i), i));
  }
  return rocks;
}

/// Bricks of 1 × 0.5 × 0.5 m in running bond, every second row a quarter of a brick on.
inline std::vector<Rock> wall(int rows, int bricks)
{
  std::vector<Rock> rocks;
  for (int row = 0; row < rows; ++row)
  {
    for (int k = 0; k < bricks; ++k)
    {
      rocks.push_back(brick(Vec3(1.0, 0.5, 0.5),
        Vec3(18.0 + k + 0.25 * (row % 2), 20.0, 0.25 + 0.5 * row), bricks * row + k));
    }
  }
  return rocks;
}

} // namespace rockfall::testing
