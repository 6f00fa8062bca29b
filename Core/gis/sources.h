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
  std::int64_t row = 0;          ///< Number in the file, from 1, for messages.
  Vec3 position = Vec3::Zero();  ///< World coordinates of the block's centre, m.
  std::optional<Shape> shape;
  std::optional<double> volume;                    ///< m³
  std::optional<double> density;                   ///< kg/m³
  std::optional<Vec3> velocity;                    ///< m/s
  std::optional<Vec3> angularVelocity;             ///< rad/s
  std::optional<Vec3> orientation;                 ///< Degrees, as the source's `Orientation`.
  std::optional<Vec3> lengths;                     ///< Box edges, m.
};

/// Reads the first layer of anything OGR opens. Columns, case-insensitive: x, y, z (for a table
/// without geometry), shape, volume, density, vx, vy, vz, wx, wy, wz (rad/s), rx, ry, rz (degrees),
/// lx, ly, lz (m).
/// Throws FileError / DataError naming file, row, field and value.
std::vector<SourceRow> readSources(const std::string& fileName);

} // namespace rockfall
