#pragma once

/// @file
/// The cut of a raster's cell into two triangles, its CFEs (METHOD 5). All that knows heights within
/// a cell asks here, so that rocks, meshes, maps and their files agree.
///
///     upper left ─── upper right        upper left ─── upper right
///          │ ╲  upper │                      │ upper  ╱ │
///          │   ╲      │                      │      ╱   │
///          │ lower ╲  │                      │ ╱  lower │
///     lower left ─── lower right        lower left ─── lower right
///            falling                           rising
///
/// One diagonal for all cells is the paper's. On rough ground it lines up ridges and grooves, which
/// lead rocks aside. The shorter fold of the two has no such direction of its own: a raster that is
/// turned by a right angle is cut as before.

#include <cmath>

namespace rockfall
{

/// Which diagonal a cell is cut along.
enum class CellDiagonal
{
  ShorterFold = 0,   ///< The one whose ends differ less in height; of two alike the falling one.
  FromUpperLeft = 1, ///< The falling one: the paper's.
};

/// By its number. Throws ParameterError if it is none.
CellDiagonal cellDiagonalFrom(double number);

/// Folds that differ by less are alike, m: above the rounding of node heights of a plane.
inline constexpr double kEqualFolds = 1e-9;

/// Whether the cut of a cell with these node heights (m) rises, from its lower left to its upper
/// right node. Not beside nodata (NaN).
inline bool isCutRising(
  CellDiagonal rule, double upperLeft, double upperRight, double lowerLeft, double lowerRight)
{
  return rule == CellDiagonal::ShorterFold &&
    std::abs(upperRight - lowerLeft) + kEqualFolds < std::abs(lowerRight - upperLeft);
}

/// Whether a place is in the lower triangle of a cell: `east`, `south` of its upper left node, in
/// cells.
inline bool isInLower(bool rising, double east, double south)
{
  return rising ? east + south >= 1.0 : south >= east;
}

} // namespace rockfall
