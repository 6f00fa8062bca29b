#pragma once

/// @file
/// Files that reach out: by which a reader would open network addresses or other files of the
/// machine. They are off unless they are asked for, because a file that came by mail could have a
/// password file read as heights, or tell its sender who opened it.

#include <string>

class GDALDataset;

namespace rockfall
{

/// While it lives, the readers of this thread follow what files name, if `allow`.
class AllowReferences
{
public:
  explicit AllowReferences(bool allow);
  ~AllowReferences();
  AllowReferences(const AllowReferences&) = delete;
  AllowReferences& operator=(const AllowReferences&) = delete;

private:
  bool before_;
};

namespace gis
{

/// Drivers of GDAL that may open a file, as GDAL wants them; null: all.
const char* const* openingDrivers();

/// Throws FileError, naming the file and what it names, if a name is an address, if the driver that
/// would read it is none of those that read one file and what lies beside it, and if any value of a
/// virtual raster or layer or of an .aux.xml, an HDF5 file (netCDF-4) or a link in a Zarr store
/// names anything but files in its own folder or below; if a virtual layer has SQL, and if a table
/// of MapInfo is made of others. Does nothing where references are allowed. `flags`: of GDAL,
/// raster or vector.
void refuseReferences(const std::string& fileName, unsigned flags);

/// The same of files that an open dataset names: overviews and places of its nodes. Call it before
/// any use that may look for them.
void refuseNamedFiles(GDALDataset& dataset, const std::string& fileName);

/// The end of a refusal: where such files are read all the same.
std::string whereAllowed();

} // namespace gis

} // namespace rockfall
