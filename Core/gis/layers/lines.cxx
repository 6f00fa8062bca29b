#include "gis/layers/lines.h"

#include "base/errors.h"
#include "gis/base/gdal.h"
#include "gis/layers/sources.h"

namespace rockfall
{

namespace
{

constexpr const char* kCrossed = " that is not valid: its outline crosses or touches itself";

} // namespace

void requireValidOutline(const std::vector<Vec3>& corners, const std::string& name)
{
  auto* ring = new OGRLinearRing; // the polygon's
  for (const Vec3& corner : corners)
  {
    ring->addPoint(corner.x(), corner.y());
  }
  ring->closeRings();
  OGRPolygon polygon;
  polygon.addRingDirectly(ring);
  const gis::Messages silent;
  if (!polygon.IsValid())
  {
    throw DataError(name + kCrossed);
  }
}

namespace gis
{

namespace
{

void gather(const FeatureRow& row, const OGRGeometry& geometry, std::int64_t* outlines,
  std::vector<const OGRLineString*>& lines)
{
  const auto type = wkbFlatten(geometry.getGeometryType());
  if (geometry.IsEmpty())
  {
    return;
  }
  if (type == wkbLineString)
  {
    lines.push_back(geometry.toLineString());
  }
  else if (type == wkbPolygon && outlines)
  {
    lines.push_back(geometry.toPolygon()->getExteriorRing());
    ++*outlines;
  }
  else if (type == wkbMultiLineString || type == wkbGeometryCollection ||
    (type == wkbMultiPolygon && outlines))
  {
    for (const OGRGeometry* part : *geometry.toGeometryCollection())
    {
      gather(row, *part, outlines, lines);
    }
  }
  else
  {
    row.fail(std::string("is a ") + geometry.getGeometryName() + ", a LINESTRING is needed");
  }
}

} // namespace

std::vector<const OGRLineString*> linesIn(const FeatureRow& row, std::int64_t* outlines)
{
  const OGRGeometry* geometry = row.geometry();
  if (!geometry)
  {
    row.fail("has no geometry, a line is needed");
  }
  std::vector<const OGRLineString*> lines;
  gather(row, *geometry, outlines, lines);
  return lines;
}

void CrossedOutlines::look(const OGRGeometry& polygon, std::int64_t row)
{
  ++all_;
  crossed_.look(!polygon.IsValid(), [row] { return std::to_string(row); });
}

void CrossedOutlines::tell(const std::string& fileName, std::vector<std::string>& notes) const
{
  crossed_.tell(notes, fileName + ": ",
    " of " + std::to_string(all_) +
      " polygons have an outline that crosses or touches itself, first row ",
    ". What it encloses twice is outside");
}

void requireValidPolygon(const FeatureRow& row)
{
  const OGRGeometry& geometry = *row.geometry();
  if (!geometry.IsValid())
  {
    row.fail(std::string("geometry is a ") + geometry.getGeometryName() + kCrossed);
  }
}

std::vector<const OGRLineString*> ringsIn(const OGRGeometry& geometry)
{
  std::vector<const OGRLineString*> rings;
  if (wkbFlatten(geometry.getGeometryType()) == wkbPolygon)
  {
    for (const OGRLinearRing* ring : *geometry.toPolygon())
    {
      rings.push_back(ring);
    }
    return rings;
  }
  for (const OGRGeometry* part : *geometry.toGeometryCollection())
  {
    const std::vector<const OGRLineString*> more = ringsIn(*part);
    rings.insert(rings.end(), more.begin(), more.end());
  }
  return rings;
}

} // namespace gis

} // namespace rockfall
