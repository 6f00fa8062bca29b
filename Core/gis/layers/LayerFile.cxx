#include "gis/layers/LayerFile.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/text/columnName.h"
#include "base/text/nameKey.h"
#include "base/text/quotedList.h"
#include "gis/base/fields.h"
#include "gis/layers/drawing.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>

namespace rockfall::gis
{

namespace
{

/// Features of a layer without a declared kind that are looked at to find it.
constexpr int lookedAt = 100;

/// Kinds of a type of geometry; 0 for collections and for what nothing is read of.
unsigned kindOfType(OGRwkbGeometryType type)
{
  switch (wkbFlatten(type))
  {
    case wkbPoint:
    case wkbMultiPoint:
      return kPoints;
    case wkbLineString:
    case wkbMultiLineString:
    case wkbCircularString:
    case wkbCompoundCurve:
    case wkbCurve:
    case wkbMultiCurve:
      return kLines;
    case wkbPolygon:
    case wkbMultiPolygon:
    case wkbCurvePolygon:
    case wkbSurface:
    case wkbMultiSurface:
      return kPolygons;
    case wkbNone:
      return kRows;
    default:
      return 0;
  }
}

/// Kinds that a layer declares; 0 if it declares none.
unsigned declaredKinds(const OGRLayer& layer)
{
  return kindOfType(const_cast<OGRLayer&>(layer).GetGeomType());
}

/// Content of a layer, as declared or by its first features.
struct Content
{
  unsigned kinds = 0;
  bool hasZ = false;

  explicit Content(OGRLayer& layer)
    : kinds(declaredKinds(layer))
    , hasZ(wkbHasZ(layer.GetGeomType()))
  {
    if (kinds != 0 && (hasZ || !(kinds & kLines)))
    {
      return;
    }
    const bool declared = kinds != 0;
    layer.ResetReading();
    for (int k = 0; k < lookedAt; ++k)
    {
      const OGRFeatureUniquePtr feature(layer.GetNextFeature());
      if (!feature)
      {
        break;
      }
      const OGRGeometry* geometry = feature->GetGeometryRef();
      kinds |= declared ? 0u : kindOf(geometry);
      hasZ = hasZ || (geometry && geometry->Is3D());
    }
    layer.ResetReading();
  }
};

bool hasOneOf(const Columns& columns, const ColumnChoice& names)
{
  return std::any_of(names.begin(), names.end(),
    [&](const std::string& name)
    {
      const std::string key = nameKey(name);
      return columns.count(key) > 0 ||
        std::any_of(columns.begin(), columns.end(),
          [&](const Columns::value_type& column) { return ColumnName(column.first).name == key; });
    });
}

bool hasFeatures(OGRLayer& layer)
{
  layer.ResetReading();
  const OGRFeatureUniquePtr first(layer.GetNextFeature());
  layer.ResetReading();
  return bool(first);
}

} // namespace

unsigned kindOf(const OGRGeometry* geometry)
{
  if (!geometry || geometry->IsEmpty())
  {
    return kRows;
  }
  if (wkbFlatten(geometry->getGeometryType()) != wkbGeometryCollection)
  {
    return kindOfType(geometry->getGeometryType());
  }
  // A collection is what all of its parts are.
  unsigned kinds = 0;
  for (const OGRGeometry* part : *geometry->toGeometryCollection())
  {
    kinds |= part->IsEmpty() ? 0u : kindOf(part);
  }
  return kinds == kLines || kinds == kPoints || kinds == kPolygons ? kinds : 0u;
}

std::string layerList(GDALDataset& dataset)
{
  std::string list;
  for (int i = 0; i < dataset.GetLayerCount(); ++i)
  {
    OGRLayer* layer = dataset.GetLayer(i);
    const GIntBig count = layer->GetFeatureCount();
    list += (i ? ", \"" : "\"") + std::string(layer->GetName()) + "\" (" +
      (layer->GetGeomType() == wkbNone
          ? ""
          : std::string(OGRGeometryTypeToName(layer->GetGeomType())) + ", ") +
      std::to_string(count) + (count == 1 ? " feature)" : " features)");
  }
  return list;
}

int fitnessOf(OGRLayer& layer, const LayerWish& wish)
{
  const Content content(layer);
  const Columns columns = columnsOf(*layer.GetLayerDefn());
  const bool table = wish.kinds & kRows;
  // Rows without a geometry need columns that say where they are; those are among the wished ones.
  const bool all = std::all_of(wish.columns.begin(), wish.columns.end(),
    [&](const ColumnChoice& choice) { return hasOneOf(columns, choice); });
  const bool placed = wish.kinds == kRows || (content.kinds & ~kRows & wish.kinds) ||
    (table && (content.kinds & kRows) && columns.count("x") && columns.count("y"));
  if (!placed || (wish.kinds == kRows && !all))
  {
    return 0;
  }
  const bool best = (all && !wish.columns.empty()) || (wish.heights && content.hasZ);
  return best ? 3 : (content.kinds & wish.better) ? 2 : 1;
}

LayerFile::LayerFile(const LayerWish& wish, Messages& messages)
  : wish_(wish)
  , messages_(messages)
  , dataset_(openVector(wish.fileName, messages, &notes_))
{
  if (dataset_->GetLayerCount() == 0)
  {
    throw DataError(wish_.fileName + ": has no " + wish_.what);
  }
  drawing_ = isOfDriver(*dataset_, "DXF");
  drawing_ ? this->chooseInDrawing() : this->choose();
  this->checkColumns();
  refuseSurplusCells(*dataset_, wish_.fileName);
  layer_->ResetReading();
  messages_.clear();
}

void LayerFile::choose()
{
  const int count = dataset_->GetLayerCount();
  std::vector<OGRLayer*> layers;
  layers.reserve(std::size_t(count));
  for (int i = 0; i < count; ++i)
  {
    layers.push_back(dataset_->GetLayer(i));
  }
  const auto keep = [&](auto&& good)
  {
    std::vector<OGRLayer*> kept;
    std::copy_if(layers.begin(), layers.end(), std::back_inserter(kept),
      [&](OGRLayer* layer) { return good(*layer); });
    if (!kept.empty())
    {
      layers = std::move(kept);
    }
    return !layers.empty();
  };
  const std::string wanted = nameKey(wish_.layer);
  if (!wanted.empty())
  {
    layers.erase(std::remove_if(layers.begin(), layers.end(),
                   [&](OGRLayer* layer) { return nameKey(layer->GetName()) != wanted; }),
      layers.end());
    keep([&](OGRLayer& layer) { return layer.GetName() == wish_.layer; });
    if (layers.size() != 1)
    {
      throw DataError(wish_.fileName + ": has " + (layers.empty() ? "no" : "more than one") +
        " layer \"" + wish_.layer + "\" (" + wish_.property + "); its layers are " +
        layerList(*dataset_));
    }
    layer_ = layers.front();
    return;
  }
  if (count == 1)
  {
    layer_ = layers.front();
    const unsigned declared = declaredKinds(*layer_);
    if (wish_.heights && declared != 0 && !(declared & wish_.kinds))
    {
      throw DataError(wish_.fileName + ": has no " + wish_.what + ", only " + layerList(*dataset_) +
        "; contours are lines, a DEM is a raster");
    }
    return;
  }
  layers.erase(std::remove_if(layers.begin(), layers.end(),
                 [&](OGRLayer* layer) { return fitnessOf(*layer, wish_) == 0; }),
    layers.end());
  if (layers.empty())
  {
    throw DataError(
      wish_.fileName + ": has no " + wish_.what + "; its layers are " + layerList(*dataset_));
  }
  for (const int fitness : { 1, 2, 3 })
  {
    keep([&](OGRLayer& layer) { return fitnessOf(layer, wish_) >= fitness && hasFeatures(layer); });
  }
  if (layers.size() > 1 && hasFeatures(*layers.front()))
  {
    throw DataError(wish_.fileName + ": has " + std::to_string(layers.size()) +
      " layers that would do, " + quotedList(layers, &OGRLayer::GetName) + "; say in " +
      wish_.property + " which it is");
  }
  layer_ = layers.front();
  this->note("Of its " + std::to_string(count) + " layers, " + layerList(*dataset_) + ", \"" +
    layer_->GetName() + "\" was taken (" + wish_.property + " says another one).");
}

void LayerFile::chooseInDrawing()
{
  layer_ = dataset_->GetLayer(0);
  const DrawingLayers layers(*layer_);
  drawn_ = layers.choose(wish_, notes_);
}

void LayerFile::checkColumns() const
{
  for (int i = 0; i < this->definition().GetFieldCount(); ++i)
  {
    if (!isUtf8(this->definition().GetFieldDefn(i)->GetNameRef()))
    {
      throw DataError(wish_.fileName + ": the name of its column " + std::to_string(i + 1) +
        " is not UTF-8; a .cpg file beside it says the encoding, as windows-1252");
    }
  }
}

void LayerFile::refuseForeignAxes(const CrsPtr& from, const std::string& target) const
{
  const std::string driver =
    dataset_->GetDriver() ? dataset_->GetDriver()->GetDescription() : std::string();
  if (!from || !target.empty() || (from->IsGeographic() && driver.starts_with("GeoJSON")))
  {
    return;
  }
  const std::string backward = backwardAxes(*from);
  if (from->IsGeographic() || !backward.empty())
  {
    throw DataError(wish_.fileName + ": layer \"" + layer_->GetName() +
      (backward.empty() ? "\" is in degrees (" : "\" counts to the " + backward + " (") +
      crsLabel(*from) +
      "), and nothing says in which CRS the slope is; give its elevations a CRS, or the layer the "
      "coordinates of the slope");
  }
}

OGRFeatureUniquePtr LayerFile::next()
{
  while (OGRFeatureUniquePtr feature{ layer_->GetNextFeature() })
  {
    stayWanted();
    ++number_;
    if (!drawing_)
    {
      return feature;
    }
    if (!drawn_.count(drawingLayerOf(*feature)))
    {
      continue; // which the note about the layers says
    }
    if (!isPaper(*feature) && (kindOf(feature->GetGeometryRef()) & wish_.kinds) &&
      !isText(*feature))
    {
      return feature;
    }
    ++others_;
  }
  if (!messages_.failure().empty())
  {
    throw FileError(wish_.fileName + ": row " + std::to_string(number_ + 1) +
      " cannot be read: " + messages_.failure());
  }
  if (others_ > 0 && !finished_)
  {
    this->note(std::to_string(others_) + (others_ == 1 ? " entity" : " entities") +
      " of the drawing that " + (others_ == 1 ? "is" : "are") +
      " of another kind (labels, points, hatches, paper space) left out.");
  }
  finished_ = true;
  return nullptr;
}

void LayerFile::tell(std::vector<std::string>& notes, bool named) const
{
  for (const std::string& text : notes_)
  {
    notes.push_back((named ? wish_.fileName + ": " : "") + text);
  }
}

} // namespace rockfall::gis
