#pragma once

/// @file
/// Signs of no data in a band: all values that its file declares, however it writes them,
/// and values that look as if they did. Internal to gis/.

#include "gis/trust/heights.h"

#include <string>
#include <utility>
#include <vector>

namespace rockfall::gis
{

/// Met in raw values, before unit and scale.
class Nodata
{
public:
  /// The band's own value, netCDF's `_FillValue`, all of its `missing_value`s, `valid_min`,
  /// `valid_max` and `valid_range`, the range of a SAGA header.
  Nodata(GDALDataset& dataset, GDALRasterBand& band, const Heights& heights);

  bool operator()(double raw) const;

private:
  bool matches(double raw, double declared) const;

  bool single_;
  Heights heights_;
  std::vector<double> values_;
  std::vector<std::pair<double, double>> ranges_; ///< From, to, both of them nodata.
  double least_, most_;                           ///< Limits of valid heights.
};

/// Adds one note for all heights (m, NaN for nodata) that stand off from all others by more than
/// these span, or are one of the usual marks (−999, 9999, …) and nothing is within 10 m of them.
/// `what`: "nodes of band 1"; `remedy` makes the end of the note of the mark's raw number.
void noteMarks(const std::vector<double>& heights, const Heights& meaning, const std::string& what,
  const std::string& remedy, std::vector<std::string>& notes);

} // namespace rockfall::gis
