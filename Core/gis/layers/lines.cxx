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

void CrossedOutlines::look(const OGRGeometry& polygon, std::int64_t row)
{
  ++all_;
  if (!polygon.IsValid() && ++count_ == 1)
  {
    first_ = row;
  }
}

void CrossedOutlines::tell(const std::string& fileName, std::vector<std::string>& notes) const
{
  if (count_ > 0)
  {
    notes.push_back(fileName + ": " + std::to_string(count_) + " of " + std::to_string(all_) +
      " polygons have an outline that crosses or touches itself, first row " +
      std::to_string(first_) + ". What it encloses twice is outside");
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

} // namespace rockfall::gis
