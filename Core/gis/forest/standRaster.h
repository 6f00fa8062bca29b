#pragma once

/// @file
/// Stands of a raster, as offices have forests beside polygons: each cell is one.

#include "terrain/stand.h"

#include <string>
#include <vector>

namespace rockfall
{

class Terrain;

/// Stands of the cells over a terrain, by their bands in this order: stems per hectare and mean
/// diameter (cm); then height (m), deviation of the diameter (cm) and conifers (%), which may be
/// missing. Scale and offset of a band are applied. The feature of a stand is the number of its
/// cell, from 1, row by row. Nothing stands where a cell has no data or 0 stems. Empty for a file
/// that is no raster: its reader knows better what it is.
///
/// Throws FileError or DataError that names file, row, column and band: numbers of no forest, too
/// many or too few bands, a band by the name or in the unit of another one, no overlap with the
/// terrain, no stem there, or too many.
std::vector<Stand> readStandRaster(
  const std::string& fileName, const Terrain& terrain, std::vector<std::string>& notes);

} // namespace rockfall
