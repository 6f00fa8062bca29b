#pragma once

/// @file
/// Scale and offset that a band declares for its numbers, of heights, stands and classes alike.
/// Internal to gis/.

#include <string>

class GDALRasterBand;

namespace rockfall::gis
{

/// Value = number · scale + offset.
struct BandScale
{
  double scale = 1.0, offset = 0.0;

  bool changes() const { return scale != 1.0 || offset != 0.0; }
  double of(double number) const { return number * scale + offset; }
  /// "scale 0.1 and offset 0"
  std::string text() const;
};

/// Throws DataError naming file, band and numbers for a scale of 0 and numbers that are not finite.
BandScale bandScale(GDALRasterBand& band, const std::string& fileName);

} // namespace rockfall::gis
