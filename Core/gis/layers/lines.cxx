#include "gis/layers/lines.h"

namespace rockfall::gis
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

} // namespace rockfall::gis
