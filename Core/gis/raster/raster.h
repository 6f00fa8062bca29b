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
  // `geometry.crs` is WKT2:2019: the horizontal CRS, with a vertical part, in metres upwards, if
  // the file says what its heights refer to; empty for local metres.
  GridGeometry geometry;          ///< `crs`: see above.
  std::vector<double> heights;    ///< NaN where the file has nodata.
  bool contours = false;          ///< The file has contour lines.
  std::vector<std::string> notes; ///< One sentence per thing that was done to the data.
};

/// Reads any raster that GDAL opens. Pixel centres become nodes, row 0 is the northernmost. Scale,
/// offset, nodata, masks and alpha bands of the file are honoured; heights in feet become metres.
///
/// A raster is reprojected to the UTM zone (WGS 84) of its extent's centre, or to UPS near the
/// poles, if its CRS is geographic, if its unit is not the metre, or if its map metres are not
/// metres on the ground (Web Mercator). Rotated or non-square cells and a wanted cell size are
/// resampled in the file's own CRS. Heights between nodes are bilinear; a cell size of 1.5 file
/// cells or more takes the mean over the new cell instead. A new node that touches nodata or lies
/// outside the file's nodes is nodata: nothing bleeds and nothing is extrapolated, and empty
/// borders are kept. Each thing done adds a note.
///
/// Throws FileError (missing, a folder, not a raster, a vector layer, truncated), ParameterError
/// (cell size) or DataError (band, complex numbers, no CRS and an extent that looks geographic, all
/// nodata, NaN or infinite heights that are not nodata, heights beyond ±20 km, fewer than 2 rows or
/// columns, more nodes than memory holds), naming the file and the value. Rows, columns and bands
/// in messages count from 1 in the order of the file. Prints nothing; safe on several threads at
/// once.
RasterSurface readRaster(const std::string& fileName, const RasterOptions& options = {});

} // namespace rockfall
