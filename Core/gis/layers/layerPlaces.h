#pragma once

/// @file
/// Places of a layer's features in the CRS of another one. Internal to gis/: needs GDAL's headers.

#include "base/types.h"
#include "gis/base/FeatureRow.h"
#include "gis/base/crs.h"
#include "gis/trust/heights.h"
#include "gis/trust/unitDoubt.h"

#include <string>
#include <vector>

namespace rockfall::gis
{

class LayerPlaces
{
public:
  /// `targetCrs` (WKT) is that of `of`, as messages name it ("the terrain"); without a CRS on either
  /// side the coordinates are taken as they are. Keeps `heights`.
  LayerPlaces(const std::string& fileName, const LayerHeights& heights,
    const std::string& targetCrs, const FileUnits& slope, const char* of,
    std::vector<std::string>& notes);

  Eigen::Vector2d at(const FeatureRow& row, double x, double y);
  /// Corners of a line but those no further from the one before than `apart`, m. Throws DataError
  /// if one is left.
  std::vector<Eigen::Vector2d> line(
    const FeatureRow& row, const OGRLineString& part, double apart = 0.0);

  UnitDoubt doubt;
  Eigen::AlignedBox2d box; ///< Of all places so far.

private:
  const LayerHeights& heights_;
  CrsPtr target_; ///< Null if there is none.
  const char* of_;
  CrsChange change_;
};

} // namespace rockfall::gis
