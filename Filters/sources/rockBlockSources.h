#pragma once

/// @file
/// Sources of rock blocks between the steps that find them, place their rocks and make these.
/// Internal to vtkRockBlockSource.

#include "vtkRockBlockSource.h"

#include "base/errors.h"
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

namespace rockfall::filters
{

inline Vec3 vec3(const double v[3])
{
  return { v[0], v[1], v[2] };
}

[[noreturn]] inline void refuseProperty(const char* name, int value, const char* rule)
{
  throw ParameterError(std::string(name) + " is " + std::to_string(value) + ", it must be " + rule);
}

} // namespace rockfall::filters
