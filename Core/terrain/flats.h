#pragma once

/// @file
/// The known flaw of rasters made from contour lines: where the nearest contours are all of one
/// height (hilltops, ridges, valleys, saddles) a TIN has flat triangles and the slope becomes a
/// flight of steps.

#include <cstdint>
#include <span>

namespace rockfall
{

/// Gives the nodes marked `flat` the heights of the thin plate of least bending energy
/// ∫ z_xx² + 2 z_xy² + z_yy² that joins, with their inclination, the heights around them, which
/// stay as they are: minimum curvature (Briggs 1974, Geophysics 39(1), 39–48; the contours' heights
/// kept as in Hutchinson 1989, Journal of Hydrology 106, 211–232). No node goes beyond the contour
/// level above or below its own, or there would be a contour.
///
/// `heights`: rows × columns, m, NaN for nodata; `levels`: the contours' heights, ascending, m.
/// Areas of many nodes are solved on every second, fourth … node and refined. Returns the number of
/// nodes that were given another height.
std::int64_t relaxFlats(int columns, int rows, std::span<double> heights,
  std::span<const std::uint8_t> flat, std::span<const double> levels);

} // namespace rockfall
