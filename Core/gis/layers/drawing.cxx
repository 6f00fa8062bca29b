#include "gis/layers/drawing.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/quotedList.h"
#include "gis/layers/LayerFile.h"

#include <gdal_priv.h>

#include <algorithm>

namespace rockfall::gis
{

namespace
{

std::string fieldText(const OGRFeature& entity, const char* field)
{
  const int column = entity.GetFieldIndex(field);
  return column < 0 ? std::string() : const_cast<OGRFeature&>(entity).GetFieldAsString(column);
}

bool hasHeights(const OGRGeometry& geometry)
{
  OGREnvelope3D box;
  geometry.getEnvelope(&box);
  return geometry.Is3D() && (box.MinZ != 0.0 || box.MaxZ != 0.0);
}

} // namespace

std::string drawingLayerOf(const OGRFeature& entity)
{
  return fieldText(entity, "Layer");
}

bool isText(const OGRFeature& entity)
{
  return !fieldText(entity, "Text").empty() ||
    fieldText(entity, "SubClasses").find("Text") != std::string::npos;
}

bool isPaper(const OGRFeature& entity)
{
  return fieldText(entity, "PaperSpace") == "1";
}

DrawingLayers::DrawingLayers(OGRLayer& entities)
{
  entities.ResetReading();
  while (const OGRFeatureUniquePtr entity{ entities.GetNextFeature() })
  {
    Holding& layer = layers_[drawingLayerOf(*entity)];
    const OGRGeometry* geometry = entity->GetGeometryRef();
    const unsigned kind = kindOf(geometry);
    if (!isPaper(*entity) && !isText(*entity) && kind != kRows)
    {
      ++layer.count[kind];
      layer.heights = layer.heights || hasHeights(*geometry);
    }
  }
  entities.ResetReading();
}

std::string DrawingLayers::list() const
{
  std::string list;
  for (const auto& [name, holding] : layers_)
  {
    std::string what;
    const auto add = [&, &holding = holding](unsigned kind, const char* one, const char* several)
    {
      if (const auto found = holding.count.find(kind); found != holding.count.end())
      {
        what += (what.empty() ? "" : ", ") + std::to_string(found->second) + " " +
          (found->second == 1 ? one : several);
      }
    };
    add(kLines, "line", "lines");
    add(kPoints, "point", "points");
    add(kPolygons, "area", "areas");
    list += (list.empty() ? "\"" : ", \"") + name + "\" (" + (what.empty() ? "labels" : what) +
      (holding.heights ? "" : ", no heights") + ")";
  }
  return list;
}

std::set<std::string> DrawingLayers::named(const LayerWish& wish) const
{
  std::set<std::string> chosen;
  for (std::size_t first = 0; first <= wish.layer.size();)
  {
    const std::size_t comma = std::min(wish.layer.find(',', first), wish.layer.size());
    const std::string wanted = nameKey(wish.layer.substr(first, comma - first));
    bool found = false;
    for (const auto& [name, holding] : layers_)
    {
      if (wanted == "*" || nameKey(name) == wanted || nameKey(wish.layer) == nameKey(name))
      {
        found = true;
        chosen.insert(name);
      }
    }
    if (!found)
    {
      throw DataError(wish.fileName + ": the drawing has no layer \"" +
        wish.layer.substr(first, comma - first) + "\" (" + wish.property + "); its layers are " +
        this->list());
    }
    first = comma + 1;
  }
  return chosen;
}

std::set<std::string> DrawingLayers::choose(
  const LayerWish& wish, std::vector<std::string>& notes) const
{
  if (!nameKey(wish.layer).empty())
  {
    return this->named(wish);
  }
  std::set<std::string> fitting, high;
  for (const auto& [name, holding] : layers_)
  {
    const bool fits = std::any_of(holding.count.begin(), holding.count.end(),
      [&](const auto& kind) { return (kind.first & wish.kinds) != 0; });
    if (fits)
    {
      fitting.insert(name);
      if (holding.heights)
      {
        high.insert(name);
      }
    }
  }
  if (fitting.empty())
  {
    throw DataError(wish.fileName + ": has no " + wish.what + "; the drawing's layers are " +
      (layers_.empty() ? "none" : this->list()));
  }
  const std::set<std::string>& chosen = wish.heights && !high.empty() ? high : fitting;
  if (!wish.heights && chosen.size() > 1)
  {
    throw DataError(wish.fileName + ": the drawing has " + std::to_string(chosen.size()) +
      " layers that would do, " + quotedList(chosen) + "; say in " + wish.property +
      " which, with commas between them, or * for all");
  }
  if (layers_.size() > 1)
  {
    notes.push_back("Of the drawing's layers, " + this->list() + ", " + quotedList(chosen) +
      (chosen.size() == 1 ? " was" : " were") + " taken (" + wish.property + " says others).");
  }
  return chosen;
}

} // namespace rockfall::gis
