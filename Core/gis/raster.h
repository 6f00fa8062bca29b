#pragma once

/// @file
/// DEM rasters through GDAL, brought to square, north-up, metric nodes.

#include "terrain/Terrain.h"

#include <string>
#include <vector>

namespace rockfall
{

struct RasterOptions
{
  double cellSize = 0.0; ///< m; 0 keeps the file's (or the one that the reprojection suggests).
  int band = 1;
};

/// Node heights as read, before any material is put on them.
struct RasterSurface
{
  GridGeometry geometry;
  std::vector<double> heights;    ///< NaN where the file has nodata.
  std::vector<std::string> notes; ///< One sentence per thing that was done to the data.
};

/// Reads any raster that GDAL opens. Pixel centres become nodes. A geographic CRS is reprojected to
/// the UTM zone of the extent's centre, non-square or rotated cells are resampled to square north-up
/// ones, a wanted cell size is resampled to (bilinear; nodata never bleeds): each adds a note.
/// Throws FileError (missing, not a raster, a vector layer) or DataError (no CRS and an extent that
/// looks geographic, all nodata, NaN or infinite heights that are not nodata, fewer than 2 rows or
/// columns), naming the file and the value.
RasterSurface readRaster(const std::string& fileName, const RasterOptions& options = {});

} // namespace rockfall
