#pragma once

/// @file
/// From a raster of any cell shape, rotation and CRS to square north-up nodes. GDAL says where a
/// target node lies in the source; the heights are taken here and not by GDAL's warper, whose
/// kernel spreads the weights of missing nodes over the others (so heights grow into nodata) and
/// extrapolates over the outer half cell.

#include "gis/base/crs.h"
#include "terrain/Terrain.h"

#include <array>
#include <vector>

namespace rockfall::gis
{

/// A raster as it is in the file: node (row, column) at
/// x = a₀ + (column + ½) a₁ + (row + ½) a₂,  y = a₃ + (column + ½) a₄ + (row + ½) a₅ (GDAL's
/// order).
struct SourceGrid
{
  int columns = 0;
  int rows = 0;
  std::array<double, 6> affine{};
  std::vector<double> heights; ///< m, row by row; NaN for nodata.
  double period = 0.0; ///< Longitudes that differ by this are one; 0 if x is not a longitude.

  double columnStep() const; ///< Distance between neighbours in a row, units of the CRS, > 0.
  double rowStep() const;
  std::array<double, 2> place(double row, double column) const;
  /// To within 1/100 of a cell over the whole raster: such nodes are used as they are.
  bool isNorthUp() const;
  bool isSquare() const;
};

/// How the target's nodes take their heights.
struct Resampling
{
  double cellSize = 0.0; ///< Of the target, m.
  /// Each node is the mean of samples² bilinear heights spread evenly over its cell. 1 is plain
  /// bilinear. Coarsening needs more: one sample per cell would pick up single boulders or miss
  /// them (aliasing). `cellSize`/`samples` is about the source's cell, and equals it when the
  /// target's is a whole multiple: then the node is the mean of the source nodes in its cell.
  int samples = 1;
  /// Nodes stand at whole multiples of the cell size; else the first one is put at the lower left
  /// of the source's nodes, as near as the samples of its cell allow.
  bool snap = false;
};

/// The largest target whose samples lie within the source's bounding box. Throws DataError,
/// beginning with `fileName`, if the source cannot be brought there, or the target has fewer than 2
/// rows or columns, or more nodes than memory holds.
GridGeometry layOut(const SourceGrid& source, const CrsChange& change, const Resampling& how,
  const std::string& fileName);

/// Heights in the order of Terrain. A node with a sample outside the source's nodes, or whose
/// bilinear neighbourhood (with a weight above 0) has nodata in it, is NaN.
std::vector<double> resample(const SourceGrid& source, const CrsChange& change,
  const Resampling& how, const GridGeometry& target);

/// Sets how many nodes a grid has. Throws DataError if they are fewer than 2 rows or columns, or more
/// than memory holds beside `others`.
void setNodes(
  GridGeometry& grid, double columns, double rows, std::size_t others, const std::string& fileName);

/// Throws DataError if so many doubles do not fit in this machine's memory.
void requireMemory(double nodes, const std::string& fileName);

} // namespace rockfall::gis
