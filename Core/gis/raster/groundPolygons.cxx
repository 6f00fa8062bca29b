// Polygons with classes.
#include "gis/raster/groundCells.h"

#include "base/Tally.h"
#include "base/abort.h"
#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/numberText.h"
#include "gis/base/FeatureRow.h"
#include "gis/base/gdal.h"
#include "gis/base/planAccuracy.h"
#include "gis/base/progress.h"
#include "gis/layers/LayerFile.h"
#include "gis/layers/lines.h"
#include "gis/trust/heights.h"
#include "gis/trust/unitDoubt.h"

#include <cpl_string.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <memory>

namespace rockfall::gis
{

namespace
{

/// Polygons are burnt in portions of about so many vertices: each takes a walk over all cells.
constexpr std::int64_t verticesAtOnce = 2'000'000;

/// Under which maps have their classes, most telling first.
const ColumnChoice usualNames = { "class", "name", "code", "type", "unit", "material", "ground" };

int classField(OGRLayer& layer, const GroundFiles& files)
{
  const Columns columns = columnsOf(*layer.GetLayerDefn());
  const auto take = [&](const std::string& name)
  {
    const auto found = columns.find(nameKey(name));
    return found == columns.end() ? -1 : found->second;
  };
  if (!files.field.empty())
  {
    const int column = take(files.field);
    if (column < 0)
    {
      throw DataError(files.layer + ": layer \"" + layer.GetName() + "\" has no field \"" +
        files.field + "\"; its fields are " + fieldList(*layer.GetLayerDefn()));
    }
    refuseTwin(*layer.GetLayerDefn(), files.layer, column);
    return column;
  }
  for (const std::string& name : usualNames)
  {
    if (const int column = take(name); column >= 0)
    {
      refuseTwin(*layer.GetLayerDefn(), files.layer, column);
      return column;
    }
  }
  throw DataError(files.layer + ": layer \"" + layer.GetName() +
    "\" has no field \"class\" or the like; say which one has the class; its fields are " +
    fieldList(*layer.GetLayerDefn()));
}

std::int64_t vertexCount(const OGRGeometry& geometry)
{
  std::int64_t count = 0;
  for (const OGRLineString* ring : ringsIn(geometry))
  {
    count += ring->getNumPoints();
  }
  return count;
}

/// The cells as a raster of GDAL's over these numbers.
DatasetPtr rasterOver(const Cells& cells, std::vector<std::uint8_t>& numbers)
{
  DatasetPtr dataset(GetGDALDriverManager()->GetDriverByName("MEM")->Create(
    "", cells.columns, cells.rows, 0, GDT_Byte, nullptr));
  char pointer[64] = {};
  pointer[CPLPrintPointer(pointer, numbers.data(), sizeof(pointer) - 1)] = 0;
  const CPLStringList options(CSLSetNameValue(nullptr, "DATAPOINTER", pointer));
  const double size = cells.terrain.geometry().cellSize;
  double affine[6] = { cells.box.xMin, size, 0.0, cells.box.yMax, 0.0, -size };
  if (!dataset || dataset->AddBand(GDT_Byte, const_cast<char**>(options.List())) != CE_None ||
    dataset->SetGeoTransform(affine) != CE_None)
  {
    throw DataError("GDAL's raster in memory cannot be made");
  }
  return dataset;
}

/// Burns polygons into the cells whose centres they cover; a later one over an earlier one, and
/// elsewhere the other way round, which tells where they overlap.
class Burner
{
public:
  Burner(const Cells& cells, std::vector<std::uint8_t>& classes)
    : cells_(cells)
    , classes_(classes)
    , firsts_(classes.size(), 0)
    , portion_(classes.size(), 0)
    , dataset_(rasterOver(cells, classes))
    , reversed_(rasterOver(cells, portion_))
  {
  }

  void add(std::unique_ptr<OGRGeometry> geometry, int row)
  {
    vertices_ += vertexCount(*geometry);
    geometries_.push_back(std::move(geometry));
    values_.push_back(row);
    if (vertices_ > verticesAtOnce)
    {
      this->burn();
    }
  }

  void burn()
  {
    if (geometries_.empty())
    {
      return;
    }
    std::vector<OGRGeometryH> handles;
    for (const auto& geometry : geometries_)
    {
      handles.push_back(OGRGeometry::ToHandle(geometry.get()));
    }
    burnInto(*dataset_, handles, values_);
    std::reverse(handles.begin(), handles.end());
    std::reverse(values_.begin(), values_.end());
    std::fill(portion_.begin(), portion_.end(), 0);
    burnInto(*reversed_, handles, values_);
    for (std::size_t cell = 0; cell < firsts_.size(); ++cell)
    {
      firsts_[cell] = firsts_[cell] == 0 ? portion_[cell] : firsts_[cell];
    }
    geometries_.clear();
    values_.clear();
    vertices_ = 0;
  }

  /// Cells of two classes.
  void tell(
    const GroundTable& table, const std::string& fileName, std::vector<std::string>& notes) const
  {
    std::int64_t count = 0, first = -1;
    for (std::size_t cell = 0; cell < firsts_.size(); ++cell)
    {
      if (firsts_[cell] != classes_[cell])
      {
        first = ++count == 1 ? std::int64_t(cell) : first;
      }
    }
    if (count > 0)
    {
      const auto name = [&table](std::uint8_t row)
      { return "\"" + table.names[std::size_t(row) - 1] + "\""; };
      notes.push_back(fileName + ": polygons of two classes overlap on " + std::to_string(count) +
        " cells, first at " + cells_.place(first) + " " + name(firsts_[std::size_t(first)]) +
        " and " + name(classes_[std::size_t(first)]) + ". The later one counts");
    }
  }

private:
  static void burnInto(
    GDALDataset& raster, std::vector<OGRGeometryH>& handles, std::vector<double>& values)
  {
    int band = 1;
    const CPLErr result =
      GDALRasterizeGeometries(GDALDataset::ToHandle(&raster), 1, &band, int(handles.size()),
        handles.data(), nullptr, nullptr, values.data(), nullptr, isWanted, nullptr);
    stayWanted();
    if (result != CE_None)
    {
      throw DataError("GDAL cannot rasterise the polygons");
    }
    raster.FlushCache();
  }

  const Cells& cells_;
  const std::vector<std::uint8_t>& classes_;
  std::vector<std::uint8_t> firsts_, portion_; ///< Of the first polygon there; of those at hand.
  DatasetPtr dataset_, reversed_;
  std::vector<std::unique_ptr<OGRGeometry>> geometries_;
  std::vector<double> values_;
  std::int64_t vertices_ = 0;
};

/// Polygons that lie between centres of cells.
class NarrowPolygons
{
public:
  explicit NarrowPolygons(double cell)
    : cell_(cell)
  {
  }

  void look(const OGRGeometry& geometry, std::int64_t feature)
  {
    double around = 0.0;
    for (const OGRLineString* ring : ringsIn(geometry))
    {
      around += ring->get_Length();
    }
    const double width =
      2.0 * OGR_G_Area(OGRGeometry::ToHandle(const_cast<OGRGeometry*>(&geometry))) / around;
    ++all_;
    narrow_.look(width < cell_,
      [&]
      { return "feature " + std::to_string(feature) + " with " + numberText(width, 3) + " m"; });
  }

  void tell(const std::string& fileName, std::vector<std::string>& notes) const
  {
    narrow_.tell(notes, fileName + ": ",
      " of " + std::to_string(all_) + " polygons are narrower than the slope's cells of " +
        number(cell_) + " m, first ",
      ". Only cells whose centre is in one have its class: take a smaller CellSize.");
  }

private:
  double cell_;
  std::int64_t all_ = 0;
  Tally narrow_;
};

/// Multiplies the coordinates of polygons.
void stretch(OGRGeometry& geometry, double factor)
{
  if (factor == 1.0)
  {
    return;
  }
  if (wkbFlatten(geometry.getGeometryType()) == wkbMultiPolygon)
  {
    for (OGRPolygon* part : *geometry.toMultiPolygon())
    {
      stretch(*part, factor);
    }
    return;
  }
  for (OGRLinearRing* ring : *geometry.toPolygon())
  {
    for (int k = 0; k < ring->getNumPoints(); ++k)
    {
      ring->setPoint(k, ring->getX(k) * factor, ring->getY(k) * factor);
    }
  }
}

} // namespace

LayerWish polygonWish(GroundKind kind, const GroundFiles& files)
{
  LayerWish wish{ files.layer, files.layerName, kindName(kind) + "LayerName" };
  wish.what = "layer of polygons";
  wish.kinds = kPolygons;
  wish.columns = { files.field.empty() ? usualNames : ColumnChoice{ files.field } };
  return wish;
}

std::vector<std::uint8_t> fromPolygons(GroundKind kind, const GroundFiles& files,
  const GroundTable& table, const Cells& cells, std::vector<std::string>& notes)
{
  Messages messages;
  LayerFile file(polygonWish(kind, files), messages);
  OGRLayer& layer = file.layer();
  if (layer.GetFeatureCount() == 0)
  {
    throw DataError(files.layer + ": layer \"" + layer.GetName() + "\" has no polygon");
  }
  const int column = classField(layer, files);
  const std::string fieldName = layer.GetLayerDefn()->GetFieldDefn(column)->GetNameRef();
  const Columns columns = columnsOf(*layer.GetLayerDefn());
  const LayerHeights units = heightsOf(file.dataset(), layer, files.layer, notes);
  const CrsPtr& from = units.horizontal;
  file.refuseForeignAxes(from, cells.terrain.geometry().crs);
  noteCrs(from, cells, files.layer, notes);
  noteRoughWay(files.layer, from, cells.crs, notes);
  std::unique_ptr<OGRCoordinateTransformation> change;
  if (from && cells.crs && !from->IsSame(cells.crs.get()))
  {
    change.reset(OGRCreateCoordinateTransformation(from.get(), cells.crs.get()));
    if (!change)
    {
      throw DataError(
        files.layer + ": there is no way from " + crsLabel(*from) + " to " + crsLabel(*cells.crs));
    }
  }

  std::vector<std::uint8_t> classes(std::size_t(cells.columns) * cells.rows, 0);
  Burner burner(cells, classes);
  UnitDoubt doubt(units, cells.terrain.geometry().fileUnits);
  CrossedOutlines crossed;
  NarrowPolygons narrow(cells.terrain.geometry().cellSize);
  OGREnvelope all;
  bool overlaps = false;
  while (const OGRFeatureUniquePtr feature = file.next())
  {
    const FeatureRow fields(files.layer, columns, *feature, file.number());
    const OGRGeometry* written = feature->GetGeometryRef();
    if (!written || written->IsEmpty())
    {
      fields.fail("has no geometry, a POLYGON is needed");
    }
    std::unique_ptr<OGRGeometry> geometry(written->getLinearGeometry());
    const auto type = wkbFlatten(geometry->getGeometryType());
    if (type != wkbPolygon && type != wkbMultiPolygon)
    {
      fields.fail(std::string("geometry is a ") + written->getGeometryName() +
        ", classes are polygons or a raster");
    }
    stretch(*geometry, units.plane);
    if (change && geometry->transform(change.get()) != OGRERR_NONE)
    {
      fields.fail(
        "the polygon cannot be brought from " + crsLabel(*from) + " to " + crsLabel(*cells.crs));
    }
    OGREnvelope extent;
    geometry->getEnvelope(&extent);
    doubt.place(fields, extent.MinX, extent.MinY);
    all.Merge(extent);
    if (extent.MaxX < cells.box.xMin || extent.MinX > cells.box.xMax ||
      extent.MaxY < cells.box.yMin || extent.MinY > cells.box.yMax)
    {
      continue;
    }
    overlaps = true;
    crossed.look(*geometry, file.number());
    narrow.look(*geometry, file.number());
    const auto text = fields.textAt(column);
    if (!text)
    {
      fields.failField(fieldName, " is empty, it must be the class");
    }
    const int row = table.rowOf(*text);
    if (row == 0)
    {
      failClass(files.layer + ", row " + std::to_string(file.number()),
        "class \"" + *text + "\" (field \"" + fieldName + "\")", files.table, table);
    }
    burner.add(std::move(geometry), row);
  }
  file.tell(notes, true);
  doubt.tell(notes);
  if (!all.IsInit())
  {
    throw DataError(files.layer + ": layer \"" + layer.GetName() + "\" has no polygon");
  }
  if (!overlaps)
  {
    failOverlap(files.layer, boxText({ all.MinX, all.MaxX, all.MinY, all.MaxY }), cells);
  }
  burner.burn();
  burner.tell(table, files.layer, notes);
  crossed.tell(files.layer, notes);
  narrow.tell(files.layer, notes);
  return classes;
}

} // namespace rockfall::gis
