#pragma once

/// @file
/// The metric CRS that a layer of any CRS is brought to.

#include "gis/base/crs.h"
#include "gis/raster/resample.h"

#include <array>
#include <string>

namespace rockfall::gis
{

/// An extent wider than this is no site for rockfall, and UTM is not made for it.
constexpr double largestExtent = 1e6; // m

struct Box
{
  double xMin, xMax, yMin, yMax;
};

Box extent(const SourceGrid& grid);
/// A grid of 2 × 2 nodes in the corners of a box.
SourceGrid gridOf(const Box& box);
/// Whether a box could be longitudes and latitudes in degrees.
bool fitsTheGlobe(const Box& box);
std::string boxText(const Box& box);

/// Without a CRS nothing says what the coordinates are; degrees taken as metres would make cliffs
/// of every slope. Throws DataError for an extent that fits the globe if the heights are this
/// `steep` (mean tangent) or neighbours this `near` each other: meant to catch those and to let
/// small local slopes pass.
void refuseUnlabelledDegrees(const Box& box, double near, double steep, const std::string& remedy,
  const std::string& fileName);

/// Lengths (target units) of one step along a row and one along a column at the raster's centre,
/// and the cosine of the angle between them.
std::array<double, 3> centreSteps(const SourceGrid& grid, const CrsChange& change);

/// Where the layer is to go, and why; no `target` if it can stay where it is.
struct Destination
{
  CrsPtr target;
  std::string reason;
  std::string doubt; ///< A note if its CRS is not made for where it is; empty: none.
};

/// The UTM zone (WGS 84) of the centre, or UPS, if the CRS is geographic, if its unit is not the
/// metre, if its axes point west or south, or if its map metres are not metres on the ground. Throws
/// DataError, beginning with `fileName`, if the extent is not on earth.
Destination destination(const SourceGrid& grid, const CrsPtr& crs, const std::string& fileName);

/// Rounded to three significant digits.
double threeDigits(double value);

} // namespace rockfall::gis
