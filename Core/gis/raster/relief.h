#pragma once

/// @file
/// Slopes that are no mountain's: too steep, too flat, or all of it under the sea, as heights in
/// another unit or depths make them.

#include "gis/raster/raster.h"

namespace rockfall::gis
{

/// Adds a note of each.
void noteRelief(RasterSurface& surface);

} // namespace rockfall::gis
