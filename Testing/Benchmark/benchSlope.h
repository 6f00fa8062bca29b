#pragma once

/// @file
/// The slope of the benchmarks: 201 × 201 nodes and 1 m cells, 30° down along x for 100 m, then
/// flat; Gaussian roughness of 0.1 m on each node; hard with φ 15°, or of another material.

#include "terrain/Terrain.h"

#include <cmath>
#include <random>

namespace rockfall
{

constexpr int kNodes = 201;

inline Terrain benchSlope(const SurfaceMaterial& material)
{
  GridGeometry g;
  g.columns = g.rows = kNodes;
  g.cellSize = 1.0;
  std::mt19937_64 random(20240101);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> heights(std::size_t(g.nodeCount()));
  for (int row = 0; row < kNodes; ++row)
  {
    for (int column = 0; column < kNodes; ++column)
    {
      const double x = column;
      const double z = x < 100.0 ? (100.0 - x) * std::tan(radians(30.0)) : 0.0;
      heights[std::size_t(row) * kNodes + column] = z + 0.1 * normal(random);
    }
  }
  return Terrain(g, std::move(heights), material);
}

inline Terrain benchSlope(double restitution, RestitutionModel model)
{
  SurfaceMaterial m;
  m.restitution = restitution;
  m.restitutionModel = model;
  m.frictionAngle = radians(15.0);
  return benchSlope(m);
}

} // namespace rockfall
