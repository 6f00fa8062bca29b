#pragma once

/// @file
/// Lines of a collector to look at: the walls that stand on them.

#include "statistics/crossings.h"
#include "terrain/Terrain.h"

#include <array>
#include <span>

class vtkPolyData;

namespace rockfall::filters
{

/// A strip of quadrilaterals for each line, from the ground up to the height of its barrier, with
/// what passed it as cell arrays. Without a `terrain` the ground is at `level`, m. `origin` leads
/// from the lines' frame to the world.
void writeWalls(std::span<const CollectorLine> lines, std::span<const LineSummary> summaries,
  const Terrain* terrain, double level, const Vec3& origin, vtkPolyData* output);

/// The line that is taken where none is given: across the middle of the paths, square to their mean
/// direction, as x, y, z of its two ends, in the world, on the ground.
std::array<double, 6> lineAcross(
  vtkPolyData* trajectories, const Terrain* terrain, const Vec3& origin);

} // namespace rockfall::filters
