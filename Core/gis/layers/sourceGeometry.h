#pragma once

/// @file
/// Where the sources of a layer are. Internal to gis/: needs GDAL's headers.

#include "base/Tally.h"
#include "gis/base/FeatureRow.h"
#include "gis/base/crs.h"
#include "gis/layers/sources.h"
#include "gis/trust/heightReference.h"
#include "gis/trust/heights.h"
#include "gis/trust/unitDoubt.h"

namespace rockfall::gis
{

/// Brings the geometry of rows to the CRS of the terrain.
struct SourcePlacing
{
  CrsPtr from;
  CrsPtr to;
  CrsChange change;
  LayerHeights heights; ///< Meaning of the layer's numbers.
  /// WKT of what the heights are brought to; nothing: they are left as they are.
  std::optional<std::string> target;
  bool haveTerrain = false;
  std::vector<std::string> heightColumns = {}; ///< z, with whatever unit in its name.
  UnitDoubt doubt = {};

  /// Fills geometry, position, parts and height of `source`. Throws DataError.
  void place(const FeatureRow& row, SourceRow& source);
  /// Conversion of the heights, if there were any.
  void tell(const std::string& fileName, std::vector<std::string>& notes) const;

private:
  Vec3 world(const FeatureRow& row, double x, double y, double z);
  std::optional<double> column(const FeatureRow& row);
  double own(const FeatureRow& row, double x, double y, double z);
  double changed(const FeatureRow& row, double x, double y, double height);
  void requireTerrain(const FeatureRow& row) const;
  void lookBeside(const FeatureRow& row, const OGRPoint& point);
  void placePoint(const FeatureRow& row, const OGRPoint* point, SourceRow& source);
  void placeParts(const FeatureRow& row, const OGRGeometry& geometry, SourceRow& source);

  std::optional<HeightChange> heightChange_; ///< Made for the first height.
  std::vector<std::string> notes_;           ///< Of the heights.
  bool anyHeight_ = false;
  std::int64_t clamped_ = 0; ///< Rows of KML that have an altitude that is not to be used.
  Tally beside_;             ///< Rows whose columns x and y are not where their point is.
};

} // namespace rockfall::gis
