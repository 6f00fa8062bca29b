#pragma once

/// @file
/// The lines of a contour file, before anything is made of them.

#include "gis/base/gdal.h"
#include "gis/layers/LayerFile.h"
#include "gis/raster/contours.h"
#include "gis/trust/heights.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rockfall::gis
{

struct Line
{
  std::size_t first = 0, count = 0; ///< Of its vertices.
};

/// The lines as they are in the file, in its CRS but with heights, and local coordinates, in
/// metres.
struct Contours
{
  std::vector<double> x, y, z;
  std::vector<Line> lines;
  std::int64_t features = 0, empty = 0;
  std::int64_t clamped = 0; ///< Features of a KML file whose altitude is said not to be used.
};

/// Where the heights are, and what they mean.
struct HeightField
{
  int column = -1; ///< −1: the lines' own z.
  std::string name;
  Heights heights;      ///< Meaning of its numbers.
  bool guessed = false; ///< By its name.
};

/// Lines with heights.
LayerWish contourWish(const std::string& fileName, const ContourOptions& options);

/// Throws DataError if `wanted` is no field of the layer.
HeightField heightFieldOf(OGRLayer& layer, const LayerHeights& heights, const std::string& wanted,
  const std::string& fileName);

/// Throws DataError naming row, field and value; see readContours.
Contours readLines(LayerFile& file, const LayerHeights& heights, const HeightField& field,
  const ContourOptions& options, const Messages& messages);

[[noreturn]] void refuseVertices(
  const std::string& fileName, double vertices, std::int64_t largest, const std::string& remedy);

} // namespace rockfall::gis
