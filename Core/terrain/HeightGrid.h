#pragma once

/// @file
/// Node heights of a north-up raster of square cells. Its triangles, the contact face elements
/// (CFEs), are arithmetic, never a list (METHOD 5; paper 2.3.1).
///
/// Local frame: x east and y north from the lower left (south-west) node, z the elevation. Storage
/// is the raster's: row 0 is the northernmost, so node (row, column) stands at x = column ·
/// cellSize, y = (rows − 1 − row) · cellSize.
///
/// CFEs are numbered from 1: in cell (row, column) the lower triangle has number
/// 2 (row (columns−1) + column) + 1, the upper one the next. Numbers of CFEs that touch nodata are
/// left out, not reused.

#include "base/types.h"
#include "terrain/cellDiagonal.h"

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace rockfall
{

/// m per unit that a slope's file declares of its numbers, which were multiplied by it; 1 for metres
/// and where nothing is declared. Files beside it may be in the same units and say nothing.
struct FileUnits
{
  double heights = 1.0;
  double plan = 1.0; ///< Of coordinates that have no CRS; else 1.
};

/// Where a raster stands in the world.
struct GridGeometry
{
  int columns = 0;                                   ///< Nodes from west to east, ≥ 2.
  int rows = 0;                                      ///< Nodes from north to south, ≥ 2.
  double cellSize = 0.0;                             ///< m
  double xOrigin = 0.0;                              ///< Real easting of the lower left node, m.
  double yOrigin = 0.0;                              ///< Real northing of the lower left node, m.
  std::string crs;                                   ///< WKT; empty for a local system.
  FileUnits fileUnits{};                             ///< Of the file that was read.
  CellDiagonal diagonal = CellDiagonal::ShorterFold; ///< Of the cells between the nodes.

  std::int64_t nodeCount() const { return std::int64_t(columns) * rows; }
  std::int64_t cellCount() const { return std::int64_t(columns - 1) * (rows - 1); }
  /// The local origin: world = local + origin().
  Vec3 origin() const { return { xOrigin, yOrigin, 0.0 }; }
};

/// A triangle, as looked up by its number.
struct Cfe
{
  std::array<Vec3, 3> nodes; ///< Counter-clockwise seen from above, local frame.
  Vec3 normal;               ///< Unit, upward.
};

/// The slope's surface as surveyed. Heights are shared, never copied.
class HeightGrid
{
public:
  HeightGrid() = default;
  /// `heights`: rows × columns in storage order, NaN for nodata. `owner` keeps them alive. Throws
  /// DataError for fewer than 2 rows or columns, a non-positive cell, infinite heights or no CFE at
  /// all.
  HeightGrid(
    GridGeometry geometry, std::span<const double> heights, std::shared_ptr<const void> owner);

  const GridGeometry& geometry() const { return geometry_; }
  std::span<const double> heights() const { return heights_; }
  double width() const { return (geometry_.columns - 1) * geometry_.cellSize; } ///< Extent in x, m.
  double height() const { return (geometry_.rows - 1) * geometry_.cellSize; }   ///< Extent in y, m.

  /// Cut of the cells. To be called before the grid is used.
  void setDiagonal(CellDiagonal diagonal) { geometry_.diagonal = diagonal; }
  /// Whether a cell's cut rises.
  bool isRising(int row, int column) const
  {
    const double* upper = &heights_[std::size_t(row) * geometry_.columns + column];
    const double* lower = upper + geometry_.columns;
    return isCutRising(geometry_.diagonal, upper[0], upper[1], lower[0], lower[1]);
  }
  double nodeHeight(int row, int column) const
  {
    return heights_[std::size_t(row) * geometry_.columns + column];
  }
  Vec3 node(int row, int column) const
  {
    return { column * geometry_.cellSize, (geometry_.rows - 1 - row) * geometry_.cellSize,
      this->nodeHeight(row, column) };
  }

  std::int64_t cfeCapacity() const { return 2 * geometry_.cellCount(); }
  bool hasCfe(std::int64_t id) const;
  /// Node indices (row · columns + column), counter-clockwise seen from above.
  std::array<std::int64_t, 3> cfeNodes(std::int64_t id) const;
  Cfe cfe(std::int64_t id) const;
  /// The CFE above or below a place in the local frame, 0 if there is none.
  std::int64_t cfeAt(double x, double y) const;
  /// Whether there is no CFE at a place, but ground on two opposite sides of it: a pond, a seam
  /// between two tiles. Nodata without ground behind, as the corners of a turned raster, is the
  /// slope's edge.
  bool isHole(double x, double y) const;
  /// Elevation, NaN outside, m.
  double elevation(double x, double y) const;

  /// Upper bound of the node heights of all cells that a box in x–y touches, from a max-pyramid; −∞
  /// if it touches none, m. Cost independent of the box.
  double maxHeight(double xMin, double xMax, double yMin, double yMax) const;
  double lowest() const { return lowest_; } ///< Node height, m.

private:
  void buildPyramid();

  GridGeometry geometry_;
  std::span<const double> heights_;
  std::shared_ptr<const void> owner_;
  /// Largest node heights of blocks of cells, coarser from level to level.
  struct Level
  {
    int columns = 0, rows = 0;
    std::vector<float> maximum; ///< Rounded up.
  };
  std::shared_ptr<const std::vector<Level>> pyramid_;
  double lowest_ = 0.0;
};

/// Length of a line over which there is no ground, looked at every half of a cell, m.
double lengthWithoutGround(const HeightGrid& grid, std::span<const Eigen::Vector2d> line);

} // namespace rockfall
