#pragma once

/// @file
/// A straight slope with a flat foot, as field surveys speak of: falls along +x.

#include "terrain/Terrain.h"
#include "terrain/presets.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace rockfall::testing
{

/// Everything that a slope has of its ground.
struct SlopeGround
{
  SurfaceMaterial material;
  Roughness roughness;
  DeviationPer deviationPer = DeviationPer::Iteration;

  static SlopeGround ofPreset(const char* name)
  {
    const GroundPreset& preset = groundPreset(name);
    return { preset.material(), preset.roughness, preset.deviationPer() };
  }
};

/// Nodes of 2 m, 120 m wide, of this angle (rad) down to x = foot, then level for `beyond` m, there
/// of the ground `lower`.
inline Terrain makeLongSlope(
  double angle, double foot, double beyond, const SlopeGround& upper, const SlopeGround& lower)
{
  GridGeometry grid;
  grid.cellSize = 2.0;
  grid.columns = int((foot + beyond) / grid.cellSize) + 1;
  grid.rows = 61;
  std::vector<double> heights;
  auto cells = std::make_shared<std::vector<std::uint8_t>>();
  for (int row = 0; row < grid.rows; ++row)
  {
    for (int column = 0; column < grid.columns; ++column)
    {
      const double x = grid.cellSize * column;
      heights.push_back(std::max(0.0, foot - x) * std::tan(angle));
      if (row + 1 < grid.rows && column + 1 < grid.columns)
      {
        cells->push_back(x >= foot ? 1 : 0);
      }
    }
  }
  Terrain terrain(grid, std::move(heights), upper.material, upper.roughness);
  MaterialClasses classes;
  classes.names = { "foot" };
  classes.materials = { lower.material };
  classes.materials.front().deviationPer = lower.deviationPer;
  classes.roughness = { lower.roughness };
  classes.cells = *cells;
  classes.owner = cells;
  terrain.setRestitutionClasses(classes);
  terrain.setJointClasses(classes);
  terrain.setDeviationPer(upper.deviationPer);
  return terrain;
}

} // namespace rockfall::testing
