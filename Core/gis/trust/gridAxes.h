#pragma once

/// @file
/// The axes of netCDF grids, of which GDAL's rasters keep a first place and a step. Internal to
/// gis/.

#include <array>
#include <optional>
#include <string>
#include <vector>

class GDALDataset;
class GDALRasterBand;

namespace rockfall::gis
{

/// Place that the axes give where GDAL finds none for the raster, as of GMT's Cartesian grids.
struct AxesPlace
{
  std::array<double, 6> affine{}; ///< GDAL's order.
  bool inDegrees = false;
};

/// Statements of the axes of a raster.
struct GridAxes
{
  std::optional<AxesPlace> place; ///< In metres or degrees; nothing where GDAL has a place.
  double metres = 1.0;            ///< Per unit that both axes declare; 1 for degrees and for none.
  std::string unit;               ///< The unit as written; empty for degrees and for none.
};

/// Throws DataError for an axis that is not evenly spaced, for axes of two units, and for a
/// variable whose rows run along x; a note says which places of further axes a band stands for.
/// Does nothing for other formats. `placed`: GDAL has a place for the raster.
GridAxes checkAxes(GDALDataset& dataset, GDALRasterBand& band, bool placed,
  const std::string& fileName, std::vector<std::string>& notes);

} // namespace rockfall::gis
