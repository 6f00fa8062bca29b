#include "gis/layers/layerWriter.h"

#include "base/errors.h"
#include "base/version.h"
#include "gis/base/crs.h"
#include "gis/base/gdal.h"
#include "gis/base/outputFile.h"

#include <cpl_string.h>
#include <ogrsf_frmts.h>

#include <array>
#include <cmath>
#include <utility>

namespace rockfall
{

using namespace gis;

namespace
{

OGRFieldType typeOf(FieldType type)
{
  switch (type)
  {
    case FieldType::Integer:
      return OFTInteger64;
    case FieldType::Text:
      return OFTString;
    case FieldType::Real:
      break;
  }
  return OFTReal;
}

std::vector<std::string> companionsOf(const std::string& extension)
{
  return extension == "csv" ? std::vector<std::string>{ "csvt", "prj" }
                            : std::vector<std::string>{};
}

} // namespace

struct LayerWriter::State
{
  State(const std::string& name, const std::string& extension)
    : fileName(name)
    , csv(extension == "csv")
    , file(name, companionsOf(extension))
  {
  }

  [[noreturn]] void fail() const
  {
    throw FileError(fileName + ": cannot be written" +
      (messages.failure().empty() ? "" : ": " + messages.failure()));
  }

  std::string fileName;
  bool csv;
  Messages messages;
  OutputFile file;
  CrsPtr crs;
  DatasetPtr dataset;
  OGRLayer* layer = nullptr;
  Geometry geometry = Geometry::Point;
  std::vector<std::array<std::string, 3>> styles; ///< Layer, its column of geometry, QML.

  /// The table by which QGIS knows how layers are to look.
  void writeStyles()
  {
    OGRLayer* table = dataset->CreateLayer("layer_styles", nullptr, wkbNone, nullptr);
    const std::pair<const char*, OGRFieldType> fields[] = { { "f_table_catalog", OFTString },
      { "f_table_schema", OFTString }, { "f_table_name", OFTString },
      { "f_geometry_column", OFTString }, { "styleName", OFTString }, { "styleQML", OFTString },
      { "styleSLD", OFTString }, { "useAsDefault", OFTInteger }, { "description", OFTString },
      { "owner", OFTString }, { "ui", OFTString }, { "update_time", OFTDateTime } };
    for (const auto& [name, type] : fields)
    {
      OGRFieldDefn field(name, type);
      field.SetSubType(type == OFTInteger ? OFSTBoolean : OFSTNone);
      if (!table || table->CreateField(&field) != OGRERR_NONE)
      {
        fail();
      }
    }
    for (const auto& [name, column, qml] : styles)
    {
      OGRFeature row(table->GetLayerDefn());
      for (const char* empty :
        { "f_table_catalog", "f_table_schema", "styleSLD", "description", "owner" })
      {
        row.SetField(empty, "");
      }
      row.SetField("f_table_name", name.c_str());
      row.SetField("f_geometry_column", column.c_str());
      row.SetField("styleName", name.c_str());
      row.SetField("styleQML", qml.c_str());
      row.SetField("useAsDefault", 1);
      if (table->CreateFeature(&row) != OGRERR_NONE)
      {
        fail();
      }
    }
  }
};

LayerWriter::LayerWriter(const std::string& fileName, const std::string& crs)
{
  const std::string extension = extensionOf(fileName);
  if (!fileName.empty() && extension != "gpkg" && extension != "csv")
  {
    throw FileError(fileName + ": cannot be written: the extension \"" + extension +
      "\" is neither gpkg nor csv");
  }
  state_ = std::make_unique<State>(fileName, extension);
  state_->crs = crs.empty() ? nullptr : crsFromText(crs);
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(state_->csv ? "CSV" : "GPKG");
  if (!driver)
  {
    throw FileError(fileName + ": cannot be written: this GDAL has no driver for it");
  }
  state_->dataset.reset(
    driver->Create(state_->file.temporary().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!state_->dataset)
  {
    state_->fail();
  }
  if (!state_->csv)
  {
    state_->dataset->SetMetadataItem("SOFTWARE", versionText().c_str());
  }
}

LayerWriter::~LayerWriter()
{
  if (state_)
  {
    state_->dataset.reset(); // before its file is removed
  }
}

bool LayerWriter::manyLayers() const
{
  return !state_->csv;
}

void LayerWriter::beginLayer(
  const std::string& name, Geometry geometry, const std::vector<LayerField>& fields)
{
  State& state = *state_;
  if (state.layer && state.csv)
  {
    throw FileError(state.fileName + ": a CSV file holds one layer only");
  }
  if (state.layer && state.dataset->CommitTransaction() != OGRERR_NONE)
  {
    state.fail();
  }
  CPLStringList options;
  if (state.csv)
  {
    options.SetNameValue("GEOMETRY", "AS_WKT");
    options.SetNameValue("CREATE_CSVT", "YES");
  }
  // The interface takes a CRS that it could change, and copies it.
  auto* crs = const_cast<OGRSpatialReference*>(state.crs.get());
  state.geometry = geometry;
  state.layer = state.dataset->CreateLayer(
    name.c_str(), crs, geometry == Geometry::Point ? wkbPoint25D : wkbLineStringZM, options.List());
  if (!state.layer)
  {
    state.fail();
  }
  for (const LayerField& field : fields)
  {
    OGRFieldDefn definition(field.name.c_str(), typeOf(field.type));
    if (state.layer->CreateField(&definition) != OGRERR_NONE)
    {
      state.fail();
    }
  }
  if (!state.csv && state.dataset->StartTransaction() != OGRERR_NONE)
  {
    state.fail();
  }
}

void LayerWriter::setStyle(const std::string& qml)
{
  if (state_->layer && !state_->csv)
  {
    state_->styles.push_back({ state_->layer->GetName(), state_->layer->GetGeometryColumn(), qml });
  }
}

void LayerWriter::add(std::span<const Vec3> places, std::span<const double> measures,
  std::span<const FieldValue> values)
{
  State& state = *state_;
  OGRFeature feature(state.layer->GetLayerDefn());
  for (std::size_t k = 0; k < values.size(); ++k)
  {
    const int field = int(k);
    if (const auto* whole = std::get_if<std::int64_t>(&values[k]))
    {
      feature.SetField(field, GIntBig(*whole));
    }
    else if (const auto* real = std::get_if<double>(&values[k]))
    {
      if (!std::isnan(*real))
      {
        feature.SetField(field, *real);
      }
    }
    else
    {
      feature.SetField(field, std::get<std::string>(values[k]).c_str());
    }
  }
  if (state.geometry == Geometry::Point)
  {
    OGRPoint point(places[0].x(), places[0].y(), places[0].z());
    feature.SetGeometry(&point);
  }
  else
  {
    OGRLineString line;
    line.setNumPoints(int(places.size()), FALSE);
    for (std::size_t k = 0; k < places.size(); ++k)
    {
      line.setPoint(int(k), places[k].x(), places[k].y(), places[k].z(), measures[k]);
    }
    feature.SetGeometry(&line);
  }
  if (state.layer->CreateFeature(&feature) != OGRERR_NONE)
  {
    state.fail();
  }
}

void LayerWriter::commit()
{
  State& state = *state_;
  if (state.layer && !state.csv && state.dataset->CommitTransaction() != OGRERR_NONE)
  {
    state.fail();
  }
  if (!state.styles.empty())
  {
    state.writeStyles();
  }
  state.messages.clear();
  state.dataset.reset();
  if (!state.messages.failure().empty())
  {
    state.fail();
  }
  state.file.commit();
}

} // namespace rockfall
