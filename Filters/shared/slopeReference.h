#pragma once

/// @file
/// Reference to a slope, in the place of its arrays: what rocks and results carry along. Within a
/// process it leads to the arrays themselves, which it keeps alive; a file keeps its name alone, and
/// under paths the heights in tiles of 8 × 8 nodes.
///
/// | array               | what                                                                  |
/// |---------------------|-----------------------------------------------------------------------|
/// | TerrainKey          | number of the slope's content, 16 hexadecimal digits                  |
/// | TerrainCellDiagonal | number of the cut of its cells                                        |
/// | TerrainTiles        | numbers of the tiles, row by row of tiles from the north              |
/// | TerrainTileHeights  | per tile the heights of its nodes, north row first, NaN for nodata, m |

#include "terrain/Terrain.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <optional>

class vtkFieldData;
class vtkPolyData;

namespace rockfall::filters
{

inline constexpr char kHeightsArray[] = "TerrainHeights";
inline constexpr char kGridArray[] = "TerrainGrid";

/// The cut of a slope's cells, in an array of its own: a file of before there was a choice has none.
void writeDiagonal(CellDiagonal diagonal, vtkFieldData* data);
/// Throws ParameterError for a number that is none.
CellDiagonal readDiagonal(vtkFieldData* data);

/// Whether an array belongs to a slope or its structures, by its name.
bool isOfSlope(const char* name);

/// Puts a reference to the slope of `from`, or the one that is there, into `to`, with the slope's
/// grid, its CRS and its origin. Nothing if there is neither.
void referToSlope(vtkFieldData* from, vtkFieldData* to);

/// Field data with all arrays of the slope: `data`, or what it refers to. Null if it has no slope,
/// or refers to one that is not in this process.
vtkSmartPointer<vtkFieldData> slopeOf(vtkFieldData* data);

/// Number of the slope's content that a reference gives; nothing without one.
std::optional<std::uint64_t> slopeKey(vtkFieldData* data);

/// Puts the tiles under and beside the lines of `paths` into its field data; nothing if its slope is
/// not at hand.
void writeTiles(vtkPolyData* paths);

/// Whether there are tiles.
bool hasTiles(vtkFieldData* data);

/// Tiles of `from` that `to` lacks.
void addTiles(vtkFieldData* from, vtkFieldData* to);

/// The slope that the tiles tell of, with nodata elsewhere. Throws DataError if a point of the paths
/// is over none of them, or if the arrays do not belong together.
Terrain readTiles(vtkPolyData* paths, const GridGeometry& grid);

} // namespace rockfall::filters
