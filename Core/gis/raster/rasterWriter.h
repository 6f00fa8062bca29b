#pragma once

/// @file
/// Maps as GeoTIFF.

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace rockfall
{

/// A layer of a map.
struct MapBand
{
  std::string name; ///< Description in the file.
  std::string unit; ///< Empty if it has none.
  /// Fills in the values of a row, counted from the south; NaN for nodata.
  std::function<void(int row, std::span<float> values)> fill;
};

/// A north-up map of square cells.
struct MapImage
{
  int columns = 0;
  int rows = 0;
  double cellSize = 0.0; ///< m
  double west = 0.0;     ///< Outer corner of the south-western cell, m.
  double south = 0.0;
  std::string crs; ///< WKT; empty for a local system.
  std::vector<MapBand> bands;
  std::vector<std::pair<std::string, std::string>> metadata; ///< Of the file, as name and text.
};

/// Writes 32-bit floats with nodata NaN, deflated: a cloud optimized GeoTIFF (COG) where GDAL has
/// that driver, else a tiled one. The file is written beside and renamed when it is whole. Returns
/// the name of the driver. Throws FileError that names the file, ParameterError for a map without
/// cells or bands, DataError for a CRS that PROJ does not know.
std::string writeGeoTiff(const std::string& fileName, const MapImage& map);

} // namespace rockfall
