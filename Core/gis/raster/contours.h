#pragma once

/// @file
/// Contour lines to a raster of heights [paper 2.3.1].

#include "gis/raster/raster.h"

#include <cstdint>
#include <string>

namespace rockfall
{

struct ContourOptions
{
  /// m; 0 takes half the mean distance between contours, A / (2 Σl) of the extent's area A and the
  /// lines' length Σl (Hengl 2006, Computers & Geosciences 32(9), 1283–1298), at three digits.
  double cellSize = 0.0;
  /// Field with the contours' heights, not case-sensitive. Empty looks for the usual names (ELEV,
  /// elevation, z, height, contour, …), then takes the lines' own z.
  std::string elevationField = {};
  bool relaxFlats = true; ///< Else hilltops, ridges and valleys are terraces, as the TIN has them.
  /// By name (gis/layers/LayerFile.h); empty: the one that will do.
  std::string layer = {};
  std::int64_t largestVertices = 20'000'000; ///< More are refused.
};

/// Reads a line layer of anything OGR opens: vertices → TIN (Delaunay) → nodes of square
/// cells over the TIN's extent, the lower left one at (xmin, ymin); nodata outside the vertices'
/// convex hull. Between vertices that are farther apart than a cell, further ones are put on the
/// line. Heights in flat triangles are those of a thin plate (terrain/flats.h). CRS and units as
/// readRaster has them: lines in angles, in feet or in Web Mercator are brought to UTM; z in the
/// unit of the vertical CRS and fields that end with _ft become metres.
///
/// Throws FileError (missing, a folder, a raster), ParameterError (cell size) or DataError (no line
/// layer, no feature, no such field, a height that is missing, no number, not finite or beyond ±20
/// km, other geometries, no CRS and an extent that looks geographic, one height only, too many
/// vertices), naming file, row, field and value.
///
/// A closed rectangle at z 0 about all other lines is the frame of a drawing and left out with a
/// note. Other lines at exactly 0 that stand off from all other heights are an error.
RasterSurface readContours(const std::string& fileName, const ContourOptions& options = {});

/// Reads the raster or the contours of a file, whichever is in it. `layer`: the name of one of its
/// rasters or layers; empty: the one that will do (gis/layers/fileContent.h).
RasterSurface readSlope(const std::string& fileName, const std::string& layer,
  const RasterOptions& raster, const ContourOptions& contours);

} // namespace rockfall
