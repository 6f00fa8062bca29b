#pragma once

/// @file
/// Slopes that are no mountain's: too steep, too flat, or all of it under the sea, as heights in
/// another unit or depths make them, and those that are surveyed coarsely.

#include "gis/raster/raster.h"

namespace rockfall::gis
{

/// Adds a note of each. `spacing`: between surveyed heights, m; 0 is not known.
void noteRelief(RasterSurface& surface, double spacing = 0.0);

} // namespace rockfall::gis
