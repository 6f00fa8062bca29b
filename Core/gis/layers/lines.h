#pragma once

/// @file
/// Lines and rings of features, for every reader of them alike. Internal to gis/: needs GDAL's headers.

#include "gis/layers/FeatureRow.h"

#include <vector>

namespace rockfall::gis
{

/// The lines of a feature: parts of several lines and of collections, curves as short straight
/// pieces; without parts that are empty. The row owns them. Throws DataError naming file and row if
/// there is none, or something else. `outlines`, if given, lets polygons have their outer rings
/// taken, and gets how many there were.
std::vector<const OGRLineString*> linesIn(const FeatureRow& row, std::int64_t* outlines = nullptr);

/// The rings of a polygon or of several. The geometry owns them.
std::vector<const OGRLineString*> ringsIn(const OGRGeometry& geometry);

} // namespace rockfall::gis
