#pragma once

/// @file
/// A second look at ESRI ASCII grids. GDAL reads a word among the numbers as 0, the numbers missing
/// from the last row as 0, and ignores surplus ones: holes and steps in the slope without a
/// message.

#include <cstdint>
#include <string>

namespace rockfall::gis
{

/// Throws DataError for a word that is no number (naming row, column and word), FileError if the
/// file has not exactly columns × rows of them. Decimal points, commas, nan and inf are numbers.
void checkAsciiGrid(const std::string& fileName, std::int64_t columns, std::int64_t rows);

} // namespace rockfall::gis
