#pragma once

/// @file
/// Sources of rock blocks between the steps that find them, place their rocks and make these.
/// Internal to vtkRockBlockSource.

#include "vtkRockBlockSource.h"

#include "gis/layers/sources.h"
#include "run/releasePlaces.h"
#include "sources/rockMaker.h"
#include "terrain/Terrain.h"

#include <optional>
#include <string>
#include <vector>

/// Rocks and where they are released.
struct vtkRockBlockSource::Sources
{
  std::optional<rockfall::Terrain> terrain;
  rockfall::ReleaseDefaults defaults;
  std::vector<rockfall::SourceRow> rows;
  std::vector<rockfall::ReleasePlace> places;
  std::string crs; ///< WKT of the places, empty if it is not known.
  std::optional<rockfall::filters::RockMaker> maker;
  std::vector<rockfall::filters::ReleasedRock> rocks; ///< A rock for each place.
  std::vector<std::string> notes;

  const rockfall::Terrain* ground() const { return terrain ? &*terrain : nullptr; }
};
