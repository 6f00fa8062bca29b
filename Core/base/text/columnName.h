#pragma once

/// @file
/// The unit in the name of a column of a table.

#include <string>
#include <vector>

namespace rockfall
{

/// "Elevation (ft)", "elev_ft", "Elev ft", "elevFt", "elevation in feet" and "ELEV_FT_NAVD88" have
/// a unit of length in their name: in brackets, or as a word of its own that is not the first.
/// Words end at blanks, at signs and before a capital that follows a small letter.
struct ColumnName
{
  explicit ColumnName(const std::string& written);

  std::string name;               ///< The part before the unit, as nameKey has it.
  std::vector<std::string> words; ///< Words of the name up to a bracket, each as nameKey has it.
  /// In small letters: what is in the brackets, or a unit of base/text/lengthUnit.h, with "us" or
  /// "survey" beside it. Empty: none.
  std::string unit;
};

} // namespace rockfall
