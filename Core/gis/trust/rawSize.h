#pragma once

/// @file
/// Whether a raster has the bytes that its header promises, above all one of raw numbers. Of most
/// formats GDAL reports what is missing; of ENVI files and of raw bands in a VRT it reads it as
/// zeros.

#include <string>

class GDALDataset;

namespace rockfall::gis
{

/// Throws FileError, naming the file of the numbers, the bytes needed and the bytes there, if a raw
/// band of the dataset, or of a raster that a VRT is made of, is cut off. Does nothing for formats
/// that are not raw, nor for compressed files. `fileName` is the raster as its user knows it.
void checkRawSize(GDALDataset& dataset, const std::string& fileName);

/// Throws DataError if a raster would take much memory, and its files are far too small to fill it:
/// one that is empty, or nearly so, or that only says that it is large.
void requireSubstance(GDALDataset& dataset, const std::string& fileName);

} // namespace rockfall::gis
