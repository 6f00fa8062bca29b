#pragma once

/// @file
/// The units in which files have their heights, and what is none. Internal to gis/.

#include <optional>
#include <string>

class OGRSpatialReference;

namespace rockfall::gis
{

/// Higher than any mountain, even where a mine adds 10 km: what lies beyond is a forgotten nodata
/// value.
constexpr double kHighest = 20000.0; // m
/// Deeper than any land, as −9999 is.
constexpr double kDeepest = -1000.0; // m

/// Metres per unit of height by the unit's name; nothing for a name that is not known.
std::optional<double> metresPer(const std::string& unit);

/// Whether a map's coordinates are in some foot.
bool isInFeet(const OGRSpatialReference& crs);

} // namespace rockfall::gis
