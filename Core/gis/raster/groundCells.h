#pragma once

/// @file
/// Classes of a layer, brought to the cells of a terrain.

#include "gis/base/crs.h"
#include "gis/base/gdal.h"
#include "gis/raster/ground.h"
#include "gis/raster/groundTable.h"
#include "gis/raster/metric.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rockfall::gis
{

struct LayerWish;

/// The terrain's cells as a raster.
struct Cells
{
  const Terrain& terrain;
  int columns, rows;
  Box box;
  CrsPtr crs; ///< Null for a local terrain.

  explicit Cells(const Terrain& slope)
    : terrain(slope)
    , columns(slope.geometry().columns - 1)
    , rows(slope.geometry().rows - 1)
  {
    const GridGeometry& g = slope.geometry();
    box = { g.xOrigin, g.xOrigin + slope.width(), g.yOrigin, g.yOrigin + slope.height() };
    crs = g.crs.empty() ? nullptr : crsFromText(g.crs);
  }

  bool hasGround(std::int64_t cell) const
  {
    return terrain.hasCfe(2 * cell + 1) || terrain.hasCfe(2 * cell + 2);
  }
  std::string place(std::int64_t cell) const
  {
    const double size = terrain.geometry().cellSize;
    return number(box.xMin + (double(cell % columns) + 0.5) * size) + ", " +
      number(box.yMax - (double(cell / columns) + 0.5) * size);
  }
};

/// "does not overlap the slope", with both extents.
[[noreturn]] void failOverlap(
  const std::string& fileName, const std::string& extent, const Cells& cells);
/// `what` "has no row in" the table.
[[noreturn]] void failClass(const std::string& layer, const std::string& what,
  const std::string& table, const GroundTable& rows);

/// Says what was taken for granted where a CRS is missing.
void noteCrs(const CrsPtr& from, const Cells& cells, const std::string& fileName,
  std::vector<std::string>& notes);

/// Where a layer's box is in the terrain's CRS, for the message that it is elsewhere.
std::string extentText(Box box, const CrsPtr& from, const Cells& cells);

/// A raster of classes, nearest value at the centre of every cell. `raster`: the name under which
/// GDAL opens it.
std::vector<std::uint8_t> fromRaster(const GroundFiles& files, const std::string& raster,
  const GroundTable& table, const Cells& cells, std::vector<std::string>& notes);

/// Polygons with a field that may have their class.
LayerWish polygonWish(GroundKind kind, const GroundFiles& files);

/// Polygons with their class in a field; of those that overlap the last one counts.
std::vector<std::uint8_t> fromPolygons(GroundKind kind, const GroundFiles& files,
  const GroundTable& table, const Cells& cells, std::vector<std::string>& notes);

} // namespace rockfall::gis
