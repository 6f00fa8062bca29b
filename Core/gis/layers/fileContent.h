#pragma once

/// @file
/// Content of a file: rasters, vector layers, or both. Internal to gis/.

#include <string>
#include <vector>

namespace rockfall::gis
{

struct LayerWish;

/// Content that is read of a file.
struct FileContent
{
  bool vector = false;
  std::string raster; ///< The name under which GDAL opens it.
};

/// The raster or the vector layer that `wish.layer` names; without a name the one that will do: a
/// raster that is no picture in colours, or a layer as LayerFile has it. Of several rasters in one
/// file (netCDF, GeoPackage) it must be one. `notes` gets which was taken of several.
///
/// Throws FileError or DataError naming the file and what is in it.
FileContent contentOf(const LayerWish& wish, std::vector<std::string>& notes);

} // namespace rockfall::gis
