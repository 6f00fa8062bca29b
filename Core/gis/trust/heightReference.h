#pragma once

/// @file
/// The reference of heights, a vertical datum or an ellipsoid, as the CRS of a file says it, and
/// the way from one reference to another. Internal to gis/.

#include "gis/base/crs.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rockfall::gis
{

/// The third axis of a CRS: of its vertical part, or its own.
struct VerticalAxis
{
  double metres = 1.0; ///< Per unit, > 0.
  bool down = false;   ///< Depths.
};
/// Nothing if the CRS is null or has two axes, or is geocentric.
std::optional<VerticalAxis> verticalAxis(const OGRSpatialReference* crs);

/// The CRS with its vertical part, in the order easting, northing; null if it does not say what
/// heights refer to ("unknown", an engineering system, two axes).
CrsPtr heightCrs(const OGRSpatialReference* crs);

/// The same of a text that PROJ knows; null for other ones.
CrsPtr heightCrsFromText(const std::string& text);

/// "NAVD88 height (EPSG:5703)", "the ellipsoid of ETRS89".
std::string referenceLabel(const OGRSpatialReference& heightCrs);

/// Whether the heights of two refer to the same, whatever their units and directions.
bool sameReference(const OGRSpatialReference& one, const OGRSpatialReference& other);

/// WKT2:2019 on one line of `horizontal` with the vertical part of `heights`, metres upwards;
/// without one if that is null.
std::string crsWkt(const CrsPtr& horizontal, const CrsPtr& heights);

/// Brings heights of a layer to those that the terrain's refer to.
class HeightChange
{
public:
  /// Changes nothing.
  HeightChange() = default;
  /// `from`: of the layer, or null; `to`: WKT or "EPSG:n" of the terrain, with its vertical part if
  /// that is known. Throws DataError naming the file and both if they differ and PROJ has no way,
  /// as when a grid is missing. Where the layer alone says what its heights refer to, a note says
  /// that they were taken as the terrain's.
  /// `implied`: no file says what the layer's refer to but its format does, which few heed: without
  /// a way they stay as they are, with a note.
  HeightChange(const std::string& fileName, const CrsPtr& from, const std::string& to, bool implied,
    std::vector<std::string>& notes);

  /// Whether the change is none.
  bool empty() const { return !way_; }
  /// Of a place in the layer's CRS, both in metres upwards. Throws DataError as above.
  double operator()(double x, double y, double height) const;

private:
  struct Way;
  std::shared_ptr<const Way> way_;
};

} // namespace rockfall::gis
