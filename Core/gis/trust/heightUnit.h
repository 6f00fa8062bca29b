#pragma once

/// @file
/// The units in which files have their heights, and what is none. Internal to gis/.

#include "base/text/lengthUnit.h"

#include <optional>
#include <string>

namespace rockfall::gis
{

/// Higher than any mountain, even where a mine adds 10 km: what lies beyond is a forgotten nodata
/// value.
constexpr double kHighest = 20000.0; // m
/// Deeper than any land, as −9999 is.
constexpr double kDeepest = -1000.0; // m

/// Metres per unit of height by the unit's name, which may have a number before it ("0.1 m") and
/// what it is over behind it ("m a.s.l."); nothing for a name that is not known.
std::optional<double> metresPer(const std::string& unit);

/// Whether a unit says nothing: empty, "unknown", "unspecified", "none", "undefined".
bool isNoUnit(const std::string& unit);

/// Whether so many metres are some foot.
bool isFoot(double metres);

/// "feet", "units of 0.01 m".
std::string unitsText(double metres);

} // namespace rockfall::gis
