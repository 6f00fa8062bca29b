#pragma once

/// @file
/// One exception type per cause. Every message names the file or block, the field and the value, so
/// that a filter can show it to the user as it stands.

#include <stdexcept>
#include <string>

namespace rockfall
{

/// Base of everything that the Core throws on bad input.
class Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// A file that is missing, unreadable or not of the kind asked for.
class FileError : public Error
{
public:
  using Error::Error;
};

/// A raster or layer whose content cannot be used: CRS, extent, nodata, NaN, too small.
class DataError : public Error
{
public:
  using Error::Error;
};

/// A number out of its range: time step, density, penalty, volume, coefficient.
class ParameterError : public Error
{
public:
  using Error::Error;
};

/// A polyhedron that is open, inverted, not convex, not planar, or degenerate.
class GeometryError : public Error
{
public:
  using Error::Error;
};

/// A rock that starts outside the slope or inside it.
class PlacementError : public Error
{
public:
  using Error::Error;
};

} // namespace rockfall
