#include "gis/sourceGeometry.h"

#include "base/errors.h"
#include "gis/gdal.h"

#include <ogr_spatialref.h>

#include <cmath>
#include <limits>

namespace rockfall::gis
{

namespace
{

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Corners of the lines in a geometry, of the rings in its polygons.
void gatherCurves(const OGRGeometry& geometry, std::vector<const OGRLineString*>& curves)
{
  switch (wkbFlatten(geometry.getGeometryType()))
  {
    case wkbLineString:
      curves.push_back(geometry.toLineString());
      break;
    case wkbPolygon:
      for (const OGRLinearRing* ring : *geometry.toPolygon())
      {
        curves.push_back(ring);
      }
      break;
    default:
      for (const OGRGeometry* part : *geometry.toGeometryCollection())
      {
        gatherCurves(*part, curves);
      }
  }
}

} // namespace

Vec3 SourcePlacing::world(const FeatureRow& row, double x, double y, double z) const
{
  Vec3 place(x, y, z);
  if (!std::isfinite(x) || !std::isfinite(y) || std::isinf(z))
  {
    row.fail("the point " + number(x) + ", " + number(y) + ", " + number(z) + " is not finite");
  }
  if (!change.forth(1, &place.x(), &place.y()))
  {
    row.fail("the point " + number(x) + ", " + number(y) + " cannot be brought from " +
      crsLabel(*from) + " to " + crsLabel(*to));
  }
  return place;
}

void SourcePlacing::placePoint(
  const FeatureRow& row, const OGRPoint* point, SourceRow& source) const
{
  // Where the ground says the height, z may be missing.
  const auto elevation = [&]
  { return haveTerrain ? row.number("z").value_or(unknown) : row.needed("z"); };
  if (!point)
  {
    const double x = row.needed("x"), y = row.needed("y");
    source.position = Vec3(x, y, elevation());
    return;
  }
  const bool own = point->Is3D();
  if (own && !std::isfinite(point->getZ()))
  {
    row.fail("the point " + number(point->getX()) + ", " + number(point->getY()) + ", " +
      number(point->getZ()) + " is not finite");
  }
  source.position =
    this->world(row, point->getX(), point->getY(), own ? point->getZ() * heightUnit : elevation());
}

void SourcePlacing::placeParts(
  const FeatureRow& row, const OGRGeometry& geometry, SourceRow& source) const
{
  const bool line = source.geometry == SourceGeometry::Line;
  const auto column = row.number("z");
  // A polygon's corners say nothing of the height within.
  const bool own = line && geometry.Is3D();
  if (!haveTerrain && !own && !column)
  {
    row.fail(std::string("rocks of a ") + geometry.getGeometryName() +
      " need the Terrain input to stand on, or a field \"z\"");
  }
  const CrsPtr& placed = to ? to : from;
  if (placed && placed->IsGeographic())
  {
    row.fail(std::string("geometry is a ") + geometry.getGeometryName() + " in degrees (" +
      crsLabel(*placed) + "); it needs the Terrain input, or a TargetCRS in metres");
  }
  if (!line && !geometry.IsValid())
  {
    row.fail(std::string("geometry is a ") + geometry.getGeometryName() +
      " that is not valid: its outline crosses or touches itself");
  }
  std::vector<const OGRLineString*> curves;
  gatherCurves(geometry, curves);
  for (const OGRLineString* curve : curves)
  {
    std::vector<Vec3>& part = source.parts.emplace_back();
    for (int k = 0; k < curve->getNumPoints(); ++k)
    {
      const double z = own ? curve->getZ(k) * heightUnit : column.value_or(unknown);
      part.push_back(this->world(row, curve->getX(k), curve->getY(k), z));
    }
  }
}

void SourcePlacing::place(const FeatureRow& row, SourceRow& source) const
{
  source.height = row.notNegative("height");
  if (source.height && !haveTerrain)
  {
    row.failField("height", " is over ground: it needs the Terrain input");
  }
  const OGRGeometry* geometry = row.geometry();
  if (!geometry)
  {
    this->placePoint(row, nullptr, source);
    return;
  }
  switch (wkbFlatten(geometry->getGeometryType()))
  {
    case wkbPoint:
      this->placePoint(row, geometry->toPoint(), source);
      break;
    case wkbMultiPoint:
    {
      // Some programs write nothing else.
      const OGRMultiPoint& points = *geometry->toMultiPoint();
      if (points.getNumGeometries() != 1)
      {
        row.fail("geometry is a MULTIPOINT of " + std::to_string(points.getNumGeometries()) +
          " points, one point is needed");
      }
      this->placePoint(row, points.getGeometryRef(0), source);
      break;
    }
    case wkbLineString:
    case wkbMultiLineString:
      source.geometry = SourceGeometry::Line;
      this->placeParts(row, *geometry, source);
      break;
    case wkbPolygon:
    case wkbMultiPolygon:
      source.geometry = SourceGeometry::Polygon;
      this->placeParts(row, *geometry, source);
      break;
    default:
      row.fail(std::string("geometry is a ") + geometry->getGeometryName() +
        ", a POINT, LINESTRING or POLYGON is needed");
  }
}

} // namespace rockfall::gis
