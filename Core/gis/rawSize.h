#pragma once

/// @file
/// Whether a raster of raw numbers has all the bytes that its header promises. Of most formats GDAL
/// reports what is missing; of ENVI files and of raw bands in a VRT it reads it as zeros.

#include <string>

class GDALDataset;

namespace rockfall::gis
{

/// Throws FileError, naming the file of the numbers, the bytes needed and the bytes there, if a raw
/// band of the dataset, or of a raster that a VRT is made of, is cut off. Does nothing for formats
/// that are not raw, nor for compressed files. `fileName` is the raster as its user knows it.
void checkRawSize(GDALDataset& dataset, const std::string& fileName);

} // namespace rockfall::gis
