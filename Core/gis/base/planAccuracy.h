#pragma once

/// @file
/// Accuracy of the way from one CRS to another in plan. Where the grid of the best way is not
/// installed PROJ takes a rougher one, and says nothing. Internal to gis/.

#include "gis/base/crs.h"

#include <string>
#include <vector>

namespace rockfall::gis
{

/// Adds a note if PROJ's best way between two CRSs needs a grid that is not installed, and those
/// without it are rougher: by less than twice as much is none. `fileName` begins the note.
void noteRoughWay(const std::string& fileName, const CrsPtr& from, const CrsPtr& to,
  std::vector<std::string>& notes);

} // namespace rockfall::gis
