#pragma once

/// @file
/// Rockfall sources from OGR point layers and CSV tables.

#include "base/types.h"
#include "geometry/shapes.h"

#include <optional>
#include <string>
#include <vector>

namespace rockfall
{

/// One row of a source layer. What the layer does not say stays empty; the caller has the defaults.
struct SourceRow
{
  std::int64_t row = 0;         ///< In the file, from 1 (not counting a header).
  Vec3 position = Vec3::Zero(); ///< World coordinates of the block's centre, m.
  std::optional<Shape> shape;
  std::optional<double> volume;        ///< m³
  std::optional<double> density;       ///< kg/m³
  std::optional<Vec3> velocity;        ///< m/s
  std::optional<Vec3> angularVelocity; ///< rad/s
  std::optional<Vec3> orientation;     ///< Degrees, as the source's `Orientation`.
  std::optional<Vec3> lengths;         ///< Box edges, m.
};

/// Reads the first layer of anything OGR opens. Columns, case-insensitive: x, y, z (for a table
/// without geometry; z also for 2D points), shape, volume, density, vx, vy, vz, wx, wy, wz (rad/s),
/// rx, ry, rz (degrees), lx, ly, lz (m). Of a vector with some components the others are 0; of
/// lengths all three are needed. Empty cells are as good as no column; other columns are ignored.
/// Where points have their own z, that is used.
///
/// Points of a layer with a CRS are brought to `targetCrs` (WKT or "EPSG:n") if that is given;
/// else, and in a table without geometry, the coordinates are taken as they are. z keeps its datum
/// and becomes metres. `crs`, if given, receives the WKT of the CRS in which the positions are:
/// `targetCrs` if there is one, else that of the layer if all rows have a point of their own, else
/// nothing.
///
/// Throws FileError (missing, a folder, a raster, unreadable) or DataError naming file, row, field
/// and value. Prints nothing; safe on several threads at once.
std::vector<SourceRow> readSources(
  const std::string& fileName, const std::string& targetCrs = {}, std::string* crs = nullptr);

/// WKT2:2019 on one line of a CRS given as "EPSG:n", WKT or PROJ string; empty for empty text.
/// Throws DataError naming the text. Prints nothing.
std::string wktOfCrs(const std::string& text);

} // namespace rockfall
