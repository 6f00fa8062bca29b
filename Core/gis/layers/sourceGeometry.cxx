#include "gis/layers/sourceGeometry.h"

#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "gis/base/gdal.h"
#include "gis/layers/LayerFile.h"
#include "gis/layers/lines.h"
#include "law/settings.h"

#include <ogr_spatialref.h>

#include <cmath>
#include <limits>

namespace rockfall::gis
{

namespace
{

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

} // namespace

Vec3 SourcePlacing::world(const FeatureRow& row, double x, double y, double z)
{
  doubt.place(row, x, y);
  Vec3 place(x * heights.plane, y * heights.plane, z);
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

/// Of the table's column of heights, m upwards.
std::optional<double> SourcePlacing::column(const FeatureRow& row)
{
  std::optional<double> height;
  std::string first;
  for (const std::string& name : heightColumns)
  {
    const auto number = row.number(nameKey(name).c_str());
    if (number && height)
    {
      row.failField(
        first, " and field \"" + name + "\" both say its height; leave out one of them");
    }
    if (number)
    {
      first = name;
      doubt.height(row, name, *number);
      height = heights.ofColumn(name).metres(*number);
      anyHeight_ = true;
    }
  }
  return height;
}

/// Height, m upwards over what the terrain's refer to, of a number at a place in the layer's CRS.
double SourcePlacing::own(const FeatureRow& row, double x, double y, double z)
{
  if (!std::isfinite(z))
  {
    row.fail("the point " + number(x) + ", " + number(y) + ", " + number(z) + " is not finite");
  }
  anyHeight_ = true;
  doubt.height(row, {}, z);
  return this->changed(row, x, y, heights.metres(z));
}

double SourcePlacing::changed(const FeatureRow& row, double x, double y, double height)
{
  if (!heightChange_)
  {
    heightChange_ = target
      ? HeightChange(row.fileName(), heights.reference, *target, heights.kml, notes_)
      : HeightChange();
  }
  return (*heightChange_)(x, y, height);
}

void SourcePlacing::tell(const std::string& fileName, std::vector<std::string>& notes) const
{
  if (anyHeight_)
  {
    heights.tell(notes);
  }
  doubt.tell(notes);
  notes.insert(notes.end(), notes_.begin(), notes_.end());
  beside_.tell(
    notes, "", " rows have an x and y other than their geometry, which counts, first ", "");
  if (clamped_ > 0)
  {
    notes.push_back(fileName + ": " + std::to_string(clamped_) +
      " rows have an altitude but are clamped to the ground by their altitudeMode, or by none; "
      "their rocks stand on the ground.");
  }
}

void SourcePlacing::placePoint(const FeatureRow& row, const OGRPoint* point, SourceRow& source)
{
  // Where the ground says the height, z may be missing.
  const auto elevation = [&]
  {
    const auto height = this->column(row);
    return height ? *height : haveTerrain ? unknown : row.needed("z");
  };
  if (!point)
  {
    const double x = row.needed("x"), y = row.needed("y");
    doubt.place(row, x, y);
    source.position = Vec3(x, y, elevation());
    return;
  }
  const double x = point->getX(), y = point->getY();
  this->lookBeside(row, *point);
  const Altitude over = point->Is3D() ? altitudeOf(heights, row) : Altitude::Datum;
  double z = unknown;
  if (point->Is3D() && over == Altitude::Datum)
  {
    z = this->own(row, x, y, point->getZ());
  }
  else if (over == Altitude::Ground && !source.height)
  {
    this->requireTerrain(row);
    if (!(point->getZ() >= 0.0))
    {
      row.fail(
        "its altitude over the ground is " + number(point->getZ()) + " m, it must be at least 0");
    }
    source.height = point->getZ();
  }
  else
  {
    if (over != Altitude::Datum)
    {
      this->requireTerrain(row);
      clamped_ += point->getZ() != 0.0;
    }
    z = elevation();
    z = std::isnan(z) ? z : this->changed(row, x, y, z);
  }
  source.position = this->world(row, x, y, z);
}

/// A point that was moved leaves what the columns say.
void SourcePlacing::lookBeside(const FeatureRow& row, const OGRPoint& point)
{
  const double far = from && from->IsGeographic() ? 1e-5 : 0.1;
  const auto said = [&row](const char* name)
  { return parsedNumber(row.text(name).value_or(std::string())); };
  const auto x = said("x"), y = said("y");
  beside_.look(x && y && std::hypot(*x - point.getX(), *y - point.getY()) > far,
    [&]
    {
      return row.where() + ": " + number(*x) + ", " + number(*y) + " and " + number(point.getX()) +
        ", " + number(point.getY());
    });
}

/// Of a KML feature without an altitude over a datum.
void SourcePlacing::requireTerrain(const FeatureRow& row) const
{
  if (!haveTerrain)
  {
    row.fail(
      "its altitude is over the ground by its altitudeMode, or by none: it needs the Terrain "
      "input to stand on");
  }
}

void SourcePlacing::placeParts(
  const FeatureRow& row, const OGRGeometry& geometry, SourceRow& source)
{
  const bool line = source.geometry == SourceGeometry::Line;
  const auto column = this->column(row);
  // A polygon's corners say nothing of the height within.
  bool own = line && geometry.Is3D();
  if (own)
  {
    const Altitude over = altitudeOf(heights, row);
    if (over == Altitude::Ground && !source.height)
    {
      row.fail("its altitudes are relative to the ground (altitudeMode); give its \"height\" over "
               "ground instead");
    }
    own = over == Altitude::Datum;
    clamped_ += !own;
  }
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
  if (!line)
  {
    requireValidPolygon(row);
  }
  for (const OGRLineString* curve : line ? linesIn(row) : ringsIn(geometry))
  {
    std::vector<Vec3>& part = source.parts.emplace_back();
    for (int k = 0; k < curve->getNumPoints(); ++k)
    {
      const double x = curve->getX(k), y = curve->getY(k);
      const double z = own ? this->own(row, x, y, curve->getZ(k))
        : column           ? this->changed(row, x, y, *column)
                           : unknown;
      part.push_back(this->world(row, x, y, z));
    }
  }
}

void SourcePlacing::place(const FeatureRow& row, SourceRow& source)
{
  source.height = row.ranged({ "height" }, 0.0, kHighestRelease, "0 to 500 m");
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
  if (kindOf(geometry) == kLines)
  {
    source.geometry = SourceGeometry::Line;
    this->placeParts(row, *geometry, source);
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
