#pragma once

/// @file
/// Coordinate reference systems: only their horizontal part, always in the order easting, northing
/// (or longitude, latitude), whatever the order of the CRS's own axes.

#include <memory>
#include <string>
#include <vector>

class OGRSpatialReference;

namespace rockfall::gis
{

/// Null for a local system.
using CrsPtr = std::shared_ptr<const OGRSpatialReference>;

/// Null for an undefined system, which formats without a word for "none" have in its place: a
/// GeoPackage "Undefined geographic SRS" (srs_id 0) and "Undefined Cartesian SRS" (−1). Else `crs`.
const OGRSpatialReference* definedCrs(const OGRSpatialReference* crs);
/// A copy without its vertical part; null for null and for an undefined system.
CrsPtr horizontalCrs(const OGRSpatialReference* crs);
CrsPtr crsFromEpsg(int code);
/// From WKT of either version, "EPSG:2056", a PROJ string. Throws DataError naming `text`.
CrsPtr crsFromText(const std::string& text);

/// "EPSG:32632 (WGS 84 / UTM zone 32N)", or the bare name if it has no code.
std::string crsLabel(const OGRSpatialReference& crs);
/// WKT2:2019 on one line.
std::string crsWkt(const OGRSpatialReference& crs);
/// "west and south": where a plane CRS counts to others than east and north, which no map shows as
/// the ground is; empty if it does not. About a pole both axes have one direction.
std::string backwardAxes(const OGRSpatialReference& crs);

/// The EPSG code of the WGS 84 UTM zone of a place (degrees), with the exceptions for Norway and
/// Svalbard; beyond 84° N and 80° S polar stereographic (UPS), where UTM is not defined.
int utmCode(double longitude, double latitude);

/// The way from one CRS to another and back; between equal or null ones it changes nothing.
class CrsChange
{
public:
  CrsChange() = default;
  /// `tolerance` > 0 allows points along a line to be interpolated with at most this error, in
  /// units of `from` (so it rules `back`). Throws DataError if there is no way.
  CrsChange(const CrsPtr& from, const CrsPtr& to, double tolerance = 0.0);

  /// In place; false if any point could not be changed, which then is not finite.
  bool forth(int count, double* x, double* y) const { return this->apply(false, count, x, y); }
  bool back(int count, double* x, double* y) const { return this->apply(true, count, x, y); }

private:
  bool apply(bool inverse, int count, double* x, double* y) const;

  std::shared_ptr<void> exact_;
  std::shared_ptr<void> interpolated_;
};

/// From a layer's CRS to another one, with a note if the way is rough (planAccuracy.h). Throws
/// DataError that names the file if there is no way.
CrsChange layerChange(const std::string& fileName, const CrsPtr& from, const CrsPtr& to,
  std::vector<std::string>& notes);

} // namespace rockfall::gis
