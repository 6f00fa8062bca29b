#include "gis/layers/fileContent.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/quotedList.h"
#include "gis/layers/LayerFile.h"

#include <cpl_string.h>
#include <gdal_priv.h>

namespace rockfall::gis
{

namespace
{

struct NamedRaster
{
  std::string label; ///< As the user calls it.
  std::string name;  ///< As GDAL does.
};

DatasetPtr opened(const std::string& fileName, Messages& messages, bool vector)
{
  try
  {
    return vector ? openVector(fileName, messages) : openRaster(fileName, messages);
  }
  catch (const FileError&)
  {
    return nullptr;
  }
}

/// NETCDF:"a.nc":z is z, GPKG:a.gpkg:dem is dem, GTIFF_DIR:2:a.tif is 2.
std::string labelOf(const std::string& name)
{
  if (name.starts_with("GTIFF_DIR:"))
  {
    return name.substr(10, name.find(':', 10) - 10);
  }
  const auto last = name.find_last_of(":/");
  return last == std::string::npos ? name : name.substr(last + 1);
}

/// A file's rasters that have names of their own.
std::vector<NamedRaster> rastersIn(GDALDataset& dataset)
{
  std::vector<NamedRaster> rasters;
  const CSLConstList list = dataset.GetMetadata("SUBDATASETS");
  for (int k = 1;; ++k)
  {
    const char* name =
      CSLFetchNameValue(list, ("SUBDATASET_" + std::to_string(k) + "_NAME").c_str());
    if (!name)
    {
      return rasters;
    }
    rasters.push_back({ labelOf(name), name });
  }
}

std::string rasterList(const std::vector<NamedRaster>& rasters)
{
  return quotedList(rasters, &NamedRaster::label);
}

/// Bands of colours for the eye.
bool isPicture(GDALDataset& dataset)
{
  if (dataset.GetRasterCount() == 0)
  {
    return false;
  }
  const GDALColorInterp colour = dataset.GetRasterBand(1)->GetColorInterpretation();
  return colour == GCI_RedBand || colour == GCI_GreenBand || colour == GCI_BlueBand ||
    (colour == GCI_PaletteIndex && dataset.GetRasterCount() > 1);
}

/// Layers of a file of rasters that will do.
std::vector<std::string> layersIn(GDALDataset& raster, const LayerWish& wish, Messages& messages)
{
  std::vector<std::string> names;
  if (!raster.GetDriver() || !raster.GetDriver()->GetMetadataItem(GDAL_DCAP_VECTOR))
  {
    return names;
  }
  const DatasetPtr vector = opened(wish.fileName, messages, true);
  for (int i = 0; vector && i < vector->GetLayerCount(); ++i)
  {
    OGRLayer* layer = vector->GetLayer(i);
    if (nameKey(layer->GetName()) == nameKey(wish.layer) ||
      (nameKey(wish.layer).empty() && fitnessOf(*layer, wish) > 0))
    {
      names.push_back(layer->GetName());
    }
  }
  return names;
}

/// The raster of this name in a file.
FileContent namedRaster(GDALDataset& dataset, const LayerWish& wish,
  const std::vector<NamedRaster>& rasters, Messages& messages)
{
  const std::string wanted = nameKey(wish.layer);
  for (const NamedRaster& raster : rasters)
  {
    if (nameKey(raster.label) == wanted || nameKey(raster.name) == wanted)
    {
      return { false, raster.name };
    }
  }
  // A GeoPackage of one raster does not list it, but says what it is called.
  const char* const own = dataset.GetMetadataItem("IDENTIFIER");
  if (own && dataset.GetRasterCount() > 0 && nameKey(own) == wanted)
  {
    return { false, wish.fileName };
  }
  const std::string name = "GPKG:" + wish.fileName + ":" + wish.layer;
  if (isOfDriver(dataset, "GPKG") && opened(name, messages, false))
  {
    return { false, name };
  }
  const DatasetPtr vector = opened(wish.fileName, messages, true);
  throw DataError(wish.fileName + ": has no raster or layer \"" + wish.layer + "\" (" +
    wish.property + "); it has " +
    (rasters.empty() ? "one raster" : "the rasters " + rasterList(rasters)) +
    (vector && vector->GetLayerCount() > 0 ? " and the layers " + layerList(*vector) : ""));
}

} // namespace

FileContent contentOf(const LayerWish& wish, std::vector<std::string>& notes)
{
  Messages messages;
  const DatasetPtr dataset = opened(wish.fileName, messages, false);
  if (!dataset)
  {
    // Other contents are a raster's business: its message says so.
    return { bool(opened(wish.fileName, messages, true)), wish.fileName };
  }
  const std::vector<NamedRaster> rasters = rastersIn(*dataset);
  const std::vector<std::string> layers = layersIn(*dataset, wish, messages);
  if (!nameKey(wish.layer).empty())
  {
    return !layers.empty() ? FileContent{ true, "" }
                           : namedRaster(*dataset, wish, rasters, messages);
  }
  const bool picture = isPicture(*dataset);
  if (!layers.empty())
  {
    if (!picture)
    {
      throw DataError(wish.fileName + ": has " +
        (rasters.empty() ? "a raster" : "rasters, " + rasterList(rasters) + ",") +
        " and a layer that would do, \"" + layers.front() + "\"; say in " + wish.property +
        " which it is");
    }
    notes.push_back("Beside a picture the file has a " + std::string(wish.what) + ", \"" +
      layers.front() + "\", which was taken.");
    return { true, "" };
  }
  if (dataset->GetRasterCount() > 0 || rasters.empty())
  {
    if (rasters.size() > 1)
    {
      notes.push_back("Of its " + std::to_string(rasters.size()) + " rasters, " +
        rasterList(rasters) + ", the first was taken (" + wish.property + " says another one).");
    }
    return { false, wish.fileName };
  }
  if (rasters.size() > 1)
  {
    throw DataError(wish.fileName + ": has " + std::to_string(rasters.size()) +
      " rasters that would do, " + rasterList(rasters) + "; say in " + wish.property +
      " which it is");
  }
  return { false, rasters.front().name };
}

} // namespace rockfall::gis
