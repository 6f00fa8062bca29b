#pragma once

/// @file
/// Places of a raster that are said twice: within the file, in an .aux.xml and in a world file
/// beside it, of which GDAL takes one. Internal to gis/.

#include "gis/base/crs.h"

#include <array>
#include <string>
#include <vector>

class GDALDataset;

namespace rockfall::gis
{

/// Adds a note for each statement of the place, or of the CRS, that is another than the one taken,
/// which is GDAL's. `affine`: the one taken, in the units of the file.
void noteOtherPlaces(GDALDataset& dataset, const std::array<double, 6>& affine, const CrsPtr& crs,
  std::vector<std::string>& notes);

} // namespace rockfall::gis
