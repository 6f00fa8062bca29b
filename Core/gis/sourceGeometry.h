#pragma once

/// @file
/// Where the sources of a layer are. Internal to gis/: needs GDAL's headers.

#include "gis/FeatureRow.h"
#include "gis/crs.h"
#include "gis/sources.h"

namespace rockfall::gis
{

/// Brings the geometry of rows to the CRS of the terrain.
struct SourcePlacing
{
  CrsPtr from;
  CrsPtr to;
  CrsChange change;
  double heightUnit = 1.0; ///< Of the layer's z, m.
  bool haveTerrain = false;

  /// Fills geometry, position, parts and height of `source`. Throws DataError.
  void place(const FeatureRow& row, SourceRow& source) const;

private:
  Vec3 world(const FeatureRow& row, double x, double y, double z) const;
  void placePoint(const FeatureRow& row, const OGRPoint* point, SourceRow& source) const;
  void placeParts(const FeatureRow& row, const OGRGeometry& geometry, SourceRow& source) const;
};

} // namespace rockfall::gis
