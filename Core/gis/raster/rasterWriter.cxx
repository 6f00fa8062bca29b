#include "gis/raster/rasterWriter.h"

#include "base/errors.h"
#include "base/version.h"
#include "gis/base/crs.h"
#include "gis/base/gdal.h"
#include "gis/base/outputFile.h"

#include <cpl_string.h>
#include <gdal_pam.h>
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

/// A band whose values are asked for row by row, so that no second copy of a map is made.
class Band : public GDALPamRasterBand
{
public:
  Band(GDALDataset* dataset, const MapImage& map, const MapBand& band)
    : rows_(map.rows)
    , band_(band)
  {
    this->poDS = dataset;
    this->eDataType = GDT_Float32;
    this->nBlockXSize = map.columns;
    this->nBlockYSize = 1;
    this->SetDescription(band.name.c_str());
    this->SetUnitType(band.unit.c_str());
    this->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  }

protected:
  CPLErr IReadBlock(int, int row, void* values) override
  {
    band_.fill(rows_ - 1 - row, { static_cast<float*>(values), std::size_t(this->nBlockXSize) });
    return CE_None;
  }

  /// Past GDAL's cache of blocks, which would become a copy of the map.
  CPLErr IRasterIO(GDALRWFlag flag, int x, int y, int width, int height, void* values, int columns,
    int rows, GDALDataType type, GSpacing step, GSpacing lineStep,
    GDALRasterIOExtraArg* extra) override
  {
    if (flag != GF_Read || width != columns || height != rows)
    {
      return GDALPamRasterBand::IRasterIO(
        flag, x, y, width, height, values, columns, rows, type, step, lineStep, extra);
    }
    row_.resize(std::size_t(this->nBlockXSize));
    for (int k = 0; k < height; ++k)
    {
      band_.fill(rows_ - 1 - y - k, row_);
      GDALCopyWords(row_.data() + x, GDT_Float32, int(sizeof(float)),
        static_cast<char*>(values) + k * lineStep, type, int(step), width);
    }
    return CE_None;
  }

private:
  std::vector<float> row_;
  int rows_;
  const MapBand& band_;
};

/// The map as GDAL's drivers read it. What it says of itself goes into the copy and not into a file
/// beside.
class Map : public GDALPamDataset
{
public:
  explicit Map(const MapImage& map)
  {
    this->nPamFlags |= GPF_NOSAVE;
    this->eAccess = GA_ReadOnly;
    this->nRasterXSize = map.columns;
    this->nRasterYSize = map.rows;
    double affine[6] = { map.west, map.cellSize, 0.0, map.south + map.rows * map.cellSize, 0.0,
      -map.cellSize };
    GDALSetGeoTransform(GDALDataset::ToHandle(this), affine);
    if (!map.crs.empty())
    {
      this->SetSpatialRef(crsFromText(map.crs).get());
    }
    this->SetMetadataItem("AREA_OR_POINT", "Area");
    this->SetMetadataItem("TIFFTAG_SOFTWARE", versionText().c_str());
    for (const auto& [name, text] : map.metadata)
    {
      this->SetMetadataItem(name.c_str(), text.c_str());
    }
    for (std::size_t k = 0; k < map.bands.size(); ++k)
    {
      this->SetBand(int(k) + 1, new Band(this, map, map.bands[k])); // the dataset's from now on
    }
  }
};

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
  Map source(map);
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
  DatasetPtr written(
    driver->CreateCopy(file.temporary().c_str(), &source, FALSE, options.List(), nullptr, nullptr));
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
