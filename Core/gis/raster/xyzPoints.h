#pragma once

/// @file
/// A second look at grids that are written as points, one a line.

#include "gis/raster/textGrid.h"

namespace rockfall::gis
{

/// The nodes of an XYZ file that have no point are nodata. Throws DataError naming the line for a
/// word that is no number and for a point that is on no node, FileError if nearly all nodes have
/// none.
TextGrid checkXyzPoints(GDALDataset& dataset, const std::string& fileName);

} // namespace rockfall::gis
