#pragma once

/// @file
/// Place of a raster in the world, and whether its file holds what it promises: the same for heights
/// and for classes. Internal to gis/.

#include "gis/base/crs.h"
#include "gis/raster/textGrid.h"

#include <array>
#include <string>
#include <vector>

class GDALDataset;
class GDALRasterBand;

namespace rockfall::gis
{

/// Where a raster lies, in metres or in the units of its CRS.
struct RasterPlace
{
  std::array<double, 6> affine{}; ///< GDAL's order.
  CrsPtr crs;                     ///< The horizontal one; null if there is none or a local one.
  double metres = 1.0;            ///< Per unit of local coordinates, which `affine` has in metres.
  /// False for a picture without world coordinates, which is given cells of 1 m.
  bool georeferenced = true;
};

/// Throws for a file that is cut off, or whose text has words for numbers.
TextGrid checkContent(GDALDataset& dataset, const std::string& fileName);

/// By the geotransform, the header of a text grid, the axes of a netCDF variable or ground control
/// points; `notes` gets what is done to it. Throws DataError for a place that is none.
RasterPlace rasterPlace(GDALDataset& dataset, GDALRasterBand& band, const TextGrid& text,
  const std::string& fileName, std::vector<std::string>& notes);

/// Place of a raster of classes or densities, checked as a DEM's is, with its notes under its name.
RasterPlace placeOfCells(
  GDALDataset& dataset, const std::string& fileName, std::vector<std::string>& notes);

} // namespace rockfall::gis
