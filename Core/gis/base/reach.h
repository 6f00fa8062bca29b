#pragma once

/// @file
/// Files that reach out: by which a reader would open network addresses or other files of the
/// machine. They are off unless they are asked for, because a file that came by mail could have a
/// password file read as heights, or tell its sender who opened it.

#include <optional>
#include <string>
#include <utility>
#include <vector>

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

/// While it lives, GDAL opens no address on this thread, whatever a file names (overviews of a
/// raster, say), and SQLite has no modules that read other files as tables. Does nothing where
/// references are allowed.
class StayLocal
{
public:
  StayLocal();
  ~StayLocal();
  StayLocal(const StayLocal&) = delete;
  StayLocal& operator=(const StayLocal&) = delete;

private:
  std::vector<std::pair<const char*, std::optional<std::string>>> before_; ///< Of GDAL's options.
};

/// Throws FileError, naming the file and what it names, if a name is an address, if the driver that
/// would read it is none of those that read one file and what lies beside it, and if a virtual
/// raster or layer, an HDF5 file (netCDF-4) or a link in a Zarr store names anything but files in
/// its own folder or below. Does nothing where references are allowed. `flags`: of GDAL, raster or
/// vector.
void refuseReferences(const std::string& fileName, unsigned flags);

} // namespace gis

} // namespace rockfall
