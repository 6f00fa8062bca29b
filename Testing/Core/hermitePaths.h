#pragma once

/// @file
/// Paths for the tests of what is made of trajectories: bouncing parabolas with their knots, and
/// random curves.

#include "statistics/path.h"

#include <cmath>
#include <random>
#include <vector>

namespace rockfall::testing
{

constexpr double g = 9.81; // m/s²

inline RockPath rockPathOf(
  const std::vector<PathPoint>& points, int iteration, int rock, double mass)
{
  RockPath path;
  path.iteration = iteration;
  path.rock = rock;
  path.blockId = 100 + rock;
  path.mass = mass;
  path.points = points;
  return path;
}

/// A ball that hops over level ground at height 0, sampled every `interval` s and at every bounce,
/// where it has one point before and one after.
inline std::vector<PathPoint> hops(
  double interval, Vec3 place, Vec3 velocity, double mass, double spinEnergy, int bounces)
{
  std::vector<PathPoint> path;
  double start = 0.0;
  const auto add = [&](double t)
  {
    PathPoint p;
    p.time = start + t;
    p.position = place + t * velocity - Vec3(0, 0, 0.5 * g * t * t);
    p.velocity = velocity - Vec3(0, 0, g * t);
    p.rotationRate = Vec3(0, 3.0, 4.0);
    p.kineticEnergy = 0.5 * mass * p.velocity.squaredNorm() + spinEnergy;
    p.heightOverGround = p.position.z();
    path.push_back(p);
  };
  int next = 0; // multiple of the interval
  for (int k = 0; k <= bounces; ++k)
  {
    const double flight =
      (velocity.z() + std::sqrt(velocity.z() * velocity.z() + 2.0 * g * place.z())) / g;
    add(0.0);
    for (; next * interval < start + flight; ++next)
    {
      if (next * interval > start)
      {
        add(next * interval - start);
      }
    }
    add(flight);
    place = path.back().position;
    place.z() = 0.0;
    start += flight;
    velocity = Vec3(0.9 * velocity.x(), 0.9 * velocity.y(), 0.8 * (g * flight - velocity.z()));
  }
  return path;
}

/// A wild curve of which every number is drawn.
inline std::vector<PathPoint> wild(std::mt19937_64& random, int points, double extent)
{
  std::uniform_real_distribution<double> place(0.0, extent), speed(-30.0, 30.0), step(0.1, 1.5),
    height(0.0, 20.0);
  std::vector<PathPoint> path(static_cast<std::size_t>(points));
  double time = 0.0;
  for (PathPoint& p : path)
  {
    p.time = time += step(random);
    p.position = Vec3(place(random), place(random), 50.0 + height(random));
    p.velocity = Vec3(speed(random), speed(random), speed(random));
    p.rotationRate = Vec3(speed(random), speed(random), speed(random));
    p.kineticEnergy = 500.0 * p.velocity.squaredNorm() + 1000.0 * height(random);
    p.heightOverGround = height(random);
  }
  return path;
}

} // namespace rockfall::testing
