#pragma once

/// @file
/// Calls of GDAL that can be given up (base/abort.h). Internal to gis/: needs GDAL's headers.

#include <gdal_priv.h>

namespace rockfall::gis
{

/// A GDALProgressFunc: false where the work at hand is no longer wanted, so that GDAL ends its call
/// with a failure. stayWanted() after the call then throws.
int CPL_STDCALL isWanted(double share, const char* text, void* unused);

/// Reads `count` whole rows from the row `first` on, as numbers of `type`; false if GDAL cannot.
/// Throws Aborted between rows if that is no longer wanted.
bool readRows(GDALRasterBand& band, int first, int count, GDALDataType type, void* values);

} // namespace rockfall::gis
