#pragma once

/// @file
/// Contours of different heights that cross between their vertices. Internal to gis/.

#include "gis/raster/contourLines.h"

#include <string>

namespace rockfall::gis
{

/// How many places there are, and the first along the lines, as a note; empty if there is none.
/// Meetings at a vertex of both are none, nor is what differs by less than the lines fall there.
/// Costs n log n, and what lies beside each other.
std::string crossingsNote(const Contours& contours);

} // namespace rockfall::gis
