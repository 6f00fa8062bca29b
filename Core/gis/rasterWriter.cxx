#include "gis/rasterWriter.h"

#include "base/errors.h"
#include "base/version.h"
#include "gis/crs.h"
#include "gis/gdal.h"
#include "gis/outputFile.h"

#include <cpl_string.h>
#include <gdal_priv.h>

#include <limits>

namespace rockfall
{

using namespace gis;

namespace
{

[[noreturn]] void fail(const std::string& fileName, const Messages& messages)
{
  throw FileError(fileName + ": cannot be written" +
    (messages.failure().empty() ? "" : ": " + messages.failure()));
}

DatasetPtr inMemory(const std::string& fileName, const MapImage& map, Messages& messages)
{
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  DatasetPtr dataset(driver
      ? driver->Create("", map.columns, map.rows, int(map.bands.size()), GDT_Float32, nullptr)
      : nullptr);
  if (!dataset)
  {
    fail(fileName, messages);
  }
  double affine[6] = { map.west, map.cellSize, 0.0, map.south + map.rows * map.cellSize, 0.0,
    -map.cellSize };
  dataset->SetGeoTransform(affine);
  if (!map.crs.empty())
  {
    dataset->SetSpatialRef(crsFromText(map.crs).get());
  }
  dataset->SetMetadataItem("AREA_OR_POINT", "Area");
  dataset->SetMetadataItem("TIFFTAG_SOFTWARE", versionText().c_str());
  for (const auto& [name, text] : map.metadata)
  {
    dataset->SetMetadataItem(name.c_str(), text.c_str());
  }
  std::vector<float> row(std::size_t(map.columns));
  for (std::size_t k = 0; k < map.bands.size(); ++k)
  {
    GDALRasterBand& band = *dataset->GetRasterBand(int(k) + 1);
    band.SetDescription(map.bands[k].name.c_str());
    band.SetUnitType(map.bands[k].unit.c_str());
    band.SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
    for (int y = 0; y < map.rows; ++y)
    {
      map.bands[k].fill(map.rows - 1 - y, row);
      if (band.RasterIO(GF_Write, 0, y, map.columns, 1, row.data(), map.columns, 1, GDT_Float32, 0,
            0, nullptr) != CE_None)
      {
        fail(fileName, messages);
      }
    }
  }
  return dataset;
}

} // namespace

std::string writeGeoTiff(const std::string& fileName, const MapImage& map)
{
  if (map.columns < 1 || map.rows < 1 || !(map.cellSize > 0.0) || map.bands.empty())
  {
    throw ParameterError(fileName + ": a map of " + sizeText(map.columns, map.rows) +
      " cells and " + std::to_string(map.bands.size()) + " bands cannot be written");
  }
  Messages messages;
  GDALAllRegister();
  OutputFile file(fileName);
  const DatasetPtr memory = inMemory(fileName, map, messages);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("COG");
  CPLStringList options;
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  if (driver)
  {
    options.SetNameValue("PREDICTOR", "YES");
    options.SetNameValue("OVERVIEW_RESAMPLING", "NEAREST"); // a mean of quantiles is no quantile
  }
  else
  {
    driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    options.SetNameValue("PREDICTOR", "3");
    options.SetNameValue("TILED", "YES");
  }
  if (!driver)
  {
    throw FileError(fileName + ": cannot be written: this GDAL has no GeoTIFF driver");
  }
  messages.clear();
  DatasetPtr written(driver->CreateCopy(
    file.temporary().c_str(), memory.get(), FALSE, options.List(), nullptr, nullptr));
  const bool made = bool(written);
  written.reset(); // what is left to be written is written now
  if (!made || !messages.failure().empty())
  {
    fail(fileName, messages);
  }
  file.commit();
  return driver->GetDescription();
}

} // namespace rockfall
