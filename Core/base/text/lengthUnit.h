#pragma once

/// @file
/// Units of length by their names.

#include <optional>
#include <string_view>

namespace rockfall
{

inline constexpr double kFoot = 0.3048;                // m, international
inline constexpr double kSurveyFoot = 1200.0 / 3937.0; // m, United States

/// Metres of a unit by its name in small letters, blanks between its words; nothing for another
/// word.
std::optional<double> lengthUnit(std::string_view name);

} // namespace rockfall
