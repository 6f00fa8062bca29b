#pragma once

/// @file
/// Sources of rocks that a user draws on the slope, and where they are before anything is drawn.

#include "gis/layers/sources.h"
#include "terrain/Terrain.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace rockfall::filters
{

/// The points, the line or the area through drawn points, in world coordinates. With a terrain all
/// stand on the ground, whatever their z. Throws ParameterError for too few points, or if one of
/// them is not on the terrain.
std::vector<SourceRow> drawnRows(SourceGeometry geometry,
  const std::vector<std::array<double, 3>>& points, const Terrain* terrain);

/// A level line across the highest of the steep places that have slope below and beside them, as
/// x, y, z of its two ends, in the world, on the ground.
std::array<double, 6> steepLine(const Terrain& terrain);

/// Centre of what nobody has placed: over the test slope, m.
inline constexpr std::array<double, 3> kDefaultCenter = { 5.0, 50.0, 58.0 };
/// Where what still has that centre stands on a slope without ground there, m, z unknown: at the
/// highest of the steep places, which a note says of `what`. Nothing for other centres and slopes.
std::optional<Vec3> placeByDefault(const Terrain& terrain, const double* center,
  const std::string& what, std::vector<std::string>& notes);

/// The same through the middle of the slope, square to its mean gradient.
std::array<double, 6> middleLine(const Terrain& terrain);

} // namespace rockfall::filters
