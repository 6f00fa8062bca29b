#pragma once

/// @file
/// Other files that an HDF5 file names, which its library reads as if they were part of it:
/// netCDF-4, BAG, KEA and S-100 are HDF5 as well.

#include <optional>
#include <string>
#include <vector>

namespace rockfall::gis
{

/// Whether a file is HDF5 by its first bytes; any path that GDAL opens.
bool isHdf5(const std::string& path);

/// Names as they are written in the file, of external links, of numbers that are stored elsewhere
/// and of the sources of virtual datasets. Nothing if the file cannot be looked into.
std::optional<std::vector<std::string>> hdf5References(const std::string& path);

} // namespace rockfall::gis
