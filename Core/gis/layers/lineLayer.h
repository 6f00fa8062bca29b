#pragma once

/// @file
/// Roads, planned barriers and other lines from OGR layers.

#include "base/types.h"
#include "terrain/Terrain.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace rockfall
{

/// A line of a layer; a feature of several parts gives several.
struct LayerLine
{
  std::int64_t feature = 0; ///< Number of the feature in the file, from 1.
  std::string layer;        ///< Of the file.
  std::vector<Eigen::Vector2d> points;
  std::string name;               ///< Of the column "name"; else empty.
  std::optional<double> height;   ///< Of the column "height", m.
  std::optional<double> capacity; ///< Of the column "capacity", kJ.
};

/// Reads the lines of a layer, and of polygons the outer rings, of anything OGR opens
/// (gis/layers/LayerFile.h has which one; `layer`: by name), curves as short straight pieces and
/// without empty parts, brought to `targetCrs` (WKT) if that is given and the layer has a CRS.
/// Column names without regard to case; empty cells are as good as no column. `notes`, if given,
/// gets what was done to the data, and a doubt about coordinates without a CRS if the `slope`'s file
/// had other ones than metres.
///
/// Throws FileError (missing, a folder, a raster, unreadable) or DataError naming file, feature,
/// field and value: a geometry that is neither, a line of one place, no feature, a number that is
/// none, negative or not finite, a place that has none in the other CRS. Prints nothing.
std::vector<LayerLine> readLineLayer(const std::string& fileName, const std::string& targetCrs = {},
  const std::string& layer = {}, std::vector<std::string>* notes = nullptr,
  const FileUnits& slope = {});

} // namespace rockfall
