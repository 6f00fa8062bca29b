#include "gis/contourLines.h"

#include "base/errors.h"
#include "gis/crs.h"
#include "gis/fields.h"
#include "gis/heightUnit.h"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <memory>

namespace rockfall::gis
{

namespace
{

/// A line's z and its field may differ by so much, m: one of them may be rounded.
constexpr double sameHeight = 1.0;

/// Names under which contour files have their heights, most telling first.
constexpr const char* usualNames[] = { "elev", "elevation", "contour", "z", "height", "ele",
  "altitude", "alt", "level", "z_value", "elev_m", "elevation_m", "contour_m", "height_m",
  "contourele", "hoehe", "kote", "cote", "quota", "cota", "elev_ft", "elevation_ft", "contour_ft",
  "height_ft" };

bool isLineType(OGRwkbGeometryType type)
{
  switch (wkbFlatten(type))
  {
    case wkbLineString:
    case wkbMultiLineString:
    case wkbCircularString:
    case wkbCompoundCurve:
    case wkbMultiCurve:
      return true;
    default:
      return false;
  }
}

void addLine(const OGRLineString& line, double height, double plane, const HeightField& field,
  const Fields& fields, Contours& contours)
{
  if (field.column < 0 && !line.Is3D())
  {
    return;
  }
  Line added{ contours.x.size(), 0 };
  for (int i = 0; i < line.getNumPoints(); ++i)
  {
    const double z = field.column < 0 ? field.heights.metres(line.getZ(i)) : height;
    if (field.guessed && line.Is3D() && line.getZ(i) != 0.0 &&
      std::abs(field.heights.metres(line.getZ(i)) - height) > sameHeight)
    {
      fields.fail("the line's z is " + number(line.getZ(i)) + ", its field \"" + field.name +
        "\" " + number(height / field.heights.scale) +
        "; say in ElevationField that it is this field, or leave the field out of the file");
    }
    if (!std::isfinite(line.getX(i)) || !std::isfinite(line.getY(i)) || !std::isfinite(z))
    {
      fields.fail("the vertex " + number(line.getX(i)) + ", " + number(line.getY(i)) + ", " +
        number(z) + " is not finite");
    }
    if (z < kDeepest || z > kHighest)
    {
      fields.fail("the height " + number(z) + " m is none: a mark for no data, or another unit?");
    }
    contours.x.push_back(line.getX(i) * plane);
    contours.y.push_back(line.getY(i) * plane);
    contours.z.push_back(z);
    ++added.count;
  }
  if (added.count > 0)
  {
    contours.lines.push_back(added);
  }
}

} // namespace

void refuseVertices(
  const std::string& fileName, double vertices, std::int64_t largest, const std::string& remedy)
{
  throw DataError(fileName + ": has more than " + number(double(largest)) + " vertices (" +
    number(std::floor(vertices)) + "), a TIN of them does not fit in memory; " + remedy);
}

OGRLayer& lineLayerOf(GDALDataset& dataset, const std::string& fileName)
{
  OGRLayer* open = nullptr; // of any geometry
  std::string others;
  for (int i = 0; i < dataset.GetLayerCount(); ++i)
  {
    OGRLayer* layer = dataset.GetLayer(i);
    if (isLineType(layer->GetGeomType()))
    {
      return *layer;
    }
    const auto type = wkbFlatten(layer->GetGeomType());
    open = !open && (type == wkbUnknown || type == wkbGeometryCollection) ? layer : open;
    others += (i ? ", \"" : "\"") + std::string(layer->GetName()) + "\" (" +
      OGRGeometryTypeToName(layer->GetGeomType()) + ")";
  }
  if (!open)
  {
    throw DataError(fileName + ": has no layer of lines" +
      (others.empty() ? "" : ", only " + others) + "; contours are lines, a DEM is a raster");
  }
  return *open;
}

HeightField heightFieldOf(OGRLayer& layer, const LayerHeights& heights, const std::string& wanted,
  const std::string& fileName)
{
  const OGRFeatureDefn& definition = *layer.GetLayerDefn();
  const Columns columns = columnsOf(definition);
  HeightField field;
  field.heights = heights;
  const auto take = [&](const Columns::value_type& column)
  {
    field.column = column.second;
    field.name = definition.GetFieldDefn(column.second)->GetNameRef();
    refuseTwin(definition, fileName, column.second);
    field.heights = heights.ofColumn(field.name);
  };
  if (!wanted.empty())
  {
    const auto column = columns.find(lowered(trimmed(wanted)));
    if (column == columns.end())
    {
      throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has no field \"" + wanted +
        "\" (ElevationField); its fields are " + fieldList(definition));
    }
    take(*column);
    return field;
  }
  for (const char* name : usualNames)
  {
    const auto column = columns.find(name);
    if (column == columns.end())
    {
      continue;
    }
    if (field.column >= 0)
    {
      throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has two fields that may be " +
        "heights, \"" + field.name + "\" and \"" +
        definition.GetFieldDefn(column->second)->GetNameRef() + "\"; say which in ElevationField");
    }
    take(*column);
    field.guessed = true;
  }
  return field;
}

Contours readLines(OGRLayer& layer, const LayerHeights& heights, const HeightField& field,
  const ContourOptions& options, const std::string& fileName, Messages& messages)
{
  const Columns columns = columnsOf(*layer.GetLayerDefn());
  Contours contours;
  messages.clear();
  while (const OGRFeatureUniquePtr feature{ layer.GetNextFeature() })
  {
    const Fields fields(fileName, columns, *feature, ++contours.features);
    const OGRGeometry* geometry = feature->GetGeometryRef();
    if (!geometry || geometry->IsEmpty())
    {
      ++contours.empty;
      continue;
    }
    if (!isLineType(geometry->getGeometryType()))
    {
      fields.fail(
        std::string("geometry is a ") + geometry->getGeometryName() + ", contours are lines");
    }
    double height = 0.0;
    if (field.column >= 0)
    {
      const auto value = fields.numberAt(field.column);
      if (!value)
      {
        fields.fail("field \"" + field.name + "\" is empty, it must be the contour's height");
      }
      height = field.heights.metres(*value);
    }
    else if (!geometry->Is3D())
    {
      fields.fail("the line has no z, and the layer no field with a usual name for its height (" +
        fieldList(*layer.GetLayerDefn()) + "); say which field it is in ElevationField");
    }
    else if (const Altitude over = altitudeOf(heights, fields); over == Altitude::Ground)
    {
      fields.fail("its altitudeMode is relativeToGround, so its altitudes are no heights of the "
                  "ground");
    }
    else
    {
      contours.clamped += over == Altitude::None;
    }
    const std::unique_ptr<OGRGeometry> straight(geometry->getLinearGeometry());
    if (wkbFlatten(straight->getGeometryType()) == wkbMultiLineString)
    {
      for (const OGRLineString* line : *straight->toMultiLineString())
      {
        addLine(*line, height, heights.plane, field, fields, contours);
      }
    }
    else
    {
      addLine(*straight->toLineString(), height, heights.plane, field, fields, contours);
    }
    if (std::int64_t(contours.x.size()) > options.largestVertices)
    {
      refuseVertices(fileName, double(contours.x.size()), options.largestVertices,
        "cut out the slope or simplify the lines first, e.g. with ogr2ogr -clipsrc or -simplify");
    }
  }
  if (!messages.failure().empty())
  {
    throw FileError(fileName + ": row " + std::to_string(contours.features + 1) +
      " cannot be read: " + messages.failure());
  }
  if (contours.x.empty())
  {
    throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has no line with vertices");
  }
  return contours;
}

} // namespace rockfall::gis
