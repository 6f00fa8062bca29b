#include "gis/raster/contourLines.h"

#include "base/errors.h"
#include "base/text/columnName.h"
#include "base/text/nameKey.h"
#include "geometry/twins.h"
#include "gis/base/FeatureRow.h"
#include "gis/base/crs.h"
#include "gis/layers/lines.h"
#include "gis/trust/heightUnit.h"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <map>

namespace rockfall::gis
{

namespace
{

/// A line's z and its field may differ by so much, m: one of them may be rounded.
constexpr double sameHeight = 1.0;

/// Names under which contour files have their heights, but for units; most telling first.
constexpr const char* usualHeightNames[] = { "elev", "elevation", "contour", "z", "height", "ele",
  "altitude", "alt", "level", "z_value", "contourele", "contourelevation", "contour_elevation",
  "hoehe", "höhe", "kote", "cote", "quota", "cota" };

void addLine(const OGRLineString& line, double height, double plane, const HeightField& field,
  const FeatureRow& fields, Contours& contours)
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
    if (std::abs(line.getX(i) * plane) > kFarthest || std::abs(line.getY(i) * plane) > kFarthest)
    {
      fields.fail("the vertex " + number(line.getX(i)) + ", " + number(line.getY(i)) +
        " is no place on earth");
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

LayerWish contourWish(const std::string& fileName, const ContourOptions& options)
{
  LayerWish wish{ fileName, options.layer };
  wish.what = "layer of lines";
  wish.kinds = kLines;
  wish.heights = true;
  wish.columns = { options.elevationField.empty()
      ? ColumnChoice(std::begin(usualHeightNames), std::end(usualHeightNames))
      : ColumnChoice{ options.elevationField } };
  return wish;
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
    const auto column = columns.find(nameKey(wanted));
    if (column == columns.end())
    {
      throw DataError(fileName + ": layer \"" + layer.GetName() + "\" has no field \"" + wanted +
        "\" (ElevationField); its fields are " + fieldList(definition));
    }
    take(*column);
    return field;
  }
  // Names without their units, each with its columns in order.
  std::multimap<std::string, Columns::value_type> named;
  for (const Columns::value_type& column : columns)
  {
    named.emplace(ColumnName(definition.GetFieldDefn(column.second)->GetNameRef()).name, column);
  }
  for (const char* name : usualHeightNames)
  {
    const auto [first, last] = named.equal_range(name);
    for (auto found = first; found != last; ++found)
    {
      const Columns::value_type& column = found->second;
      if (field.column >= 0)
      {
        throw DataError(fileName + ": layer \"" + layer.GetName() +
          "\" has two fields that may be heights, \"" + field.name + "\" and \"" +
          definition.GetFieldDefn(column.second)->GetNameRef() + "\"; say which in ElevationField");
      }
      take(column);
      field.guessed = true;
    }
  }
  return field;
}

Contours readLines(LayerFile& file, const LayerHeights& heights, const HeightField& field,
  const ContourOptions& options, const Messages& messages)
{
  const std::string& fileName = file.fileName();
  const Columns columns = columnsOf(file.definition());
  Contours contours;
  while (const OGRFeatureUniquePtr feature = file.next())
  {
    const FeatureRow row(fileName, columns, *feature, file.number());
    row.refuseLostText(messages);
    ++contours.features;
    const OGRGeometry* geometry = row.geometry();
    if (!geometry)
    {
      ++contours.empty;
      continue;
    }
    const std::vector<const OGRLineString*> lines = linesIn(row);
    double height = 0.0;
    if (field.column >= 0)
    {
      const auto value = row.numberAt(field.column);
      if (!value)
      {
        row.failField(field.name, " is empty, it must be the contour's height");
      }
      height = field.heights.metres(*value);
    }
    else if (!geometry->Is3D())
    {
      row.fail("the line has no z, and the layer no field with a usual name for its height (" +
        fieldList(file.definition()) + "); say which field it is in ElevationField");
    }
    else if (const Altitude over = altitudeOf(heights, row); over == Altitude::Ground)
    {
      row.fail("its altitudeMode is relativeToGround, so its altitudes are no heights of the "
               "ground");
    }
    else
    {
      contours.clamped += over == Altitude::None;
    }
    for (const OGRLineString* line : lines)
    {
      addLine(*line, height, heights.plane, field, row, contours);
    }
    if (std::int64_t(contours.x.size()) > options.largestVertices)
    {
      refuseVertices(fileName, double(contours.x.size()), options.largestVertices,
        "cut out the slope or simplify the lines first, e.g. with ogr2ogr -clipsrc or -simplify");
    }
  }
  if (contours.x.empty())
  {
    throw DataError(
      fileName + ": layer \"" + file.layer().GetName() + "\" has no line with vertices");
  }
  return contours;
}

} // namespace rockfall::gis
