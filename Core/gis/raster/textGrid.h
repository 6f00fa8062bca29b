#pragma once

/// @file
/// A second look at grids written as text: ESRI's, GRASS's, ISG's, XYZ and GXF. GDAL reads a word
/// among the numbers as 0, so it does the numbers missing from the last row, and ignores surplus
/// ones: holes and steps in the slope without a message.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

class GDALDataset;

namespace rockfall::gis
{

/// Statements of a grid of text that GDAL does not pass on.
struct TextGrid
{
  /// Whether `nulls` says what is nodata, and the band does not: where the file has a word for it.
  bool ownNulls = false;
  std::vector<std::uint8_t> nulls; ///< Per cell, in the order of the file; empty: none is.
  /// The lower left corner, x and y, of a grid whose header gives it by a corner along one axis and
  /// by a centre along the other: GDAL drops both.
  std::optional<std::array<double, 2>> corner;
};

/// Throws DataError for a header that gives a place along one axis only, for a word that is neither
/// a number nor the header's for no data (naming the place and the word), FileError if the file has
/// not exactly as many numbers as it promises, or far fewer points than a grid of them would have
/// nodes. Decimal points, commas, nan and inf are numbers. Does nothing for other formats.
TextGrid checkTextGrid(GDALDataset& dataset, const std::string& fileName);

/// The same of an XYZ file (xyzPoints.cxx), whose nodes without a point are nodata. Throws
/// DataError naming the line for a word that is no number and for a point that is on no node,
/// FileError if nearly all nodes have none.
TextGrid checkXyzPoints(GDALDataset& dataset, const std::string& fileName);

} // namespace rockfall::gis
