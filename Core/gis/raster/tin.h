#pragma once

/// @file
/// From points to a raster by a triangulated irregular network (TIN) [paper 2.3.1].

#include "terrain/Terrain.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rockfall::gis
{

/// Points, x and y about an origin near them (m, so that no digits are lost), z their height (m).
struct TinPoints
{
  std::vector<double> x, y, z;
};

/// Nodes of a raster as a TIN makes them, in the order of Terrain.
struct TinNodes
{
  std::vector<double> heights; ///< m; NaN outside the points' convex hull.
  /// 1: only triangles with a chord, an edge of one height across a valley or a ridge; most have
  /// all three vertices at that height and are flat.
  std::vector<std::uint8_t> flat;
};

/// The Delaunay triangulation of the points (GDAL's, by Qhull), linear within each triangle. Of the
/// target `cellSize`, `columns` and `rows` are used; its lower left node stands at (west, south).
/// Neighbours on a contour are taken to be a cell apart at most. No two points may stand at the
/// same place. Throws DataError, beginning with `fileName`, if they have no triangulation.
TinNodes interpolateTin(TinPoints points, const GridGeometry& target, double west, double south,
  const std::string& fileName);

} // namespace rockfall::gis
