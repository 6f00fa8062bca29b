#include "gis/forest/standRaster.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/hectare.h"
#include "base/text/columnName.h"
#include "base/text/nameKey.h"
#include "base/text/numberText.h"
#include "base/text/plainText.h"
#include "gis/base/gdal.h"
#include "gis/base/progress.h"
#include "gis/raster/groundCells.h"
#include "gis/raster/rasterPlace.h"
#include "gis/trust/bandScale.h"
#include "gis/trust/heightUnit.h"
#include "terrain/Terrain.h"
#include "terrain/plausible.h"

#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rockfall
{

using namespace gis;

namespace
{

constexpr double cm = 0.01; // m
constexpr int kNeeded = 2;  ///< Bands.
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

struct Band
{
  const char* name; ///< As the columns of polygons are called.
  const char* unit;
  double most;
};
constexpr std::array<Band, 5> kBands = { { { "stems_ha", "", 1e5 },
  { "dbh_mean", " cm", plausible::kStemDiameter.refused / cm }, { "height", " m", 200.0 },
  { "dbh_dev", " cm", plausible::kStemDiameter.refused / cm }, { "conifers", " %", 100.0 } } };

/// "stems_ha, dbh_mean, height, dbh_dev, conifers"
std::string bandNames()
{
  std::string names;
  for (const Band& band : kBands)
  {
    names += (names.empty() ? "" : ", ") + std::string(band.name);
  }
  return names;
}

/// Throws DataError if a band is called by the name of another place, or is in another unit of
/// length than that of its place. Other names and units say nothing.
void requireMeaning(GDALDataset& dataset, const std::string& fileName)
{
  for (int b = 0; b < dataset.GetRasterCount(); ++b)
  {
    const std::string unit(trimmed(dataset.GetRasterBand(b + 1)->GetUnitType()));
    const std::string needed(trimmed(kBands[std::size_t(b)].unit));
    const auto metres = metresPer(unit), metresNeeded = metresPer(needed);
    if (metres && metresNeeded && std::abs(*metres - *metresNeeded) > 1e-5 * *metresNeeded)
    {
      throw DataError(fileName + ": band " + std::to_string(b + 1) + " (" +
        kBands[std::size_t(b)].name + ") has the unit \"" + unit + "\", it must be in " + needed);
    }
    const char* written = dataset.GetRasterBand(b + 1)->GetDescription();
    std::string name = ColumnName(written ? written : "").name;
    std::replace(name.begin(), name.end(), ' ', '_');
    for (int other = 0; other < int(kBands.size()); ++other)
    {
      if (other != b && nameKey(name) == kBands[std::size_t(other)].name)
      {
        throw DataError(fileName + ": band " + std::to_string(b + 1) + " is called \"" + written +
          "\", but band " + std::to_string(b + 1) + " of a raster of stands is " +
          kBands[std::size_t(b)].name + "; its bands are " + bandNames() + ", in this order");
      }
    }
  }
}

/// Tables may look like grids of points to GDAL.
bool isRaster(const std::string& fileName)
{
  const Messages silent;
  GDALAllRegister();
  auto* driver = GDALDriver::FromHandle(
    GDALIdentifyDriverEx(fileName.c_str(), GDAL_OF_RASTER, nullptr, nullptr));
  return driver && !driver->GetMetadataItem(GDAL_DCAP_VECTOR) &&
    std::string(driver->GetDescription()) != "XYZ";
}

/// Rows of all bands; NaN where there is nothing.
class Rows
{
public:
  Rows(GDALDataset& dataset, const std::string& fileName, Messages& messages,
    std::vector<std::string>& notes)
    : dataset_(dataset)
    , fileName_(fileName)
    , messages_(messages)
    , values_(std::size_t(dataset.GetRasterCount()))
    , mask_(std::size_t(dataset.GetRasterXSize()))
  {
    for (std::vector<double>& band : values_)
    {
      band.resize(mask_.size());
    }
    for (std::size_t b = 0; b < values_.size(); ++b)
    {
      scales_.push_back(bandScale(*dataset.GetRasterBand(int(b) + 1), fileName));
      if (scales_.back().changes())
      {
        notes.push_back(fileName + ": " + scales_.back().text() + " of band " +
          std::to_string(b + 1) + " (" + kBands[b].name + ") were applied.");
      }
    }
  }

  void read(int row)
  {
    row_ = row;
    messages_.clear();
    for (std::size_t b = 0; b < values_.size(); ++b)
    {
      GDALRasterBand& band = *dataset_.GetRasterBand(int(b) + 1);
      if (!readRows(band, row, 1, GDT_Float64, values_[b].data()) ||
        !readRows(*band.GetMaskBand(), row, 1, GDT_Byte, mask_.data()))
      {
        throw FileError(fileName_ + ": cannot be read: " + messages_.failure());
      }
      for (std::size_t k = 0; k < mask_.size(); ++k)
      {
        values_[b][k] = mask_[k] == 0 ? kNothing : scales_[b].of(values_[b][k]);
      }
    }
  }

  /// Of a cell of the row; `missing` where the band has nothing or is not there.
  double at(int column, std::size_t band, double missing) const
  {
    const double value = band < values_.size() ? values_[band][std::size_t(column)] : kNothing;
    if (std::isnan(value))
    {
      return missing;
    }
    if (!(value >= 0.0 && value <= kBands[band].most))
    {
      this->fail(column, band,
        " is " + number(value) + kBands[band].unit + ", it must be 0 to " +
          number(kBands[band].most) + kBands[band].unit);
    }
    return value;
  }

  [[noreturn]] void fail(int column, std::size_t band, const std::string& what) const
  {
    throw DataError(fileName_ + ", row " + std::to_string(row_ + 1) + ", column " +
      std::to_string(column + 1) + ": band " + std::to_string(band + 1) + " (" + kBands[band].name +
      ")" + what);
  }

private:
  GDALDataset& dataset_;
  const std::string& fileName_;
  Messages& messages_;
  int row_ = 0;
  std::vector<std::vector<double>> values_;
  std::vector<BandScale> scales_;
  std::vector<std::uint8_t> mask_;
};

/// The stand of a cell but for its place.
Stand standOf(const Rows& rows, int column, double stems)
{
  Stand stand;
  stand.stemsPerHectare = stems;
  const double mean = rows.at(column, 1, 0.0);
  if (!(mean >= 1.0))
  {
    rows.fail(column, 1,
      " is " + number(mean) + " cm where stems_ha is " + number(stems) +
        ", it must be at least 1 cm: is it in metres?");
  }
  stand.diameterMean = cm * mean;
  stand.height = rows.at(column, 2, stand.height);
  if (!(stand.height > 0.0))
  {
    rows.fail(column, 2, " is 0 m where stems_ha is " + number(stems));
  }
  const double deviation = rows.at(column, 3, 0.0);
  if (deviation > mean)
  {
    rows.fail(column, 3,
      " is " + number(deviation) + " cm, it must be at most the mean, " + number(mean) + " cm");
  }
  stand.diameterDeviation = cm * deviation;
  stand.conifers = 0.01 * rows.at(column, 4, 100.0 * stand.conifers);
  return stand;
}

} // namespace

std::vector<Stand> readStandRaster(
  const std::string& fileName, const Terrain& terrain, std::vector<std::string>& notes)
{
  std::vector<Stand> stands;
  if (fileName.empty() || !isRaster(fileName))
  {
    return stands;
  }
  Messages messages;
  const DatasetPtr source = openRaster(fileName, messages);
  const int bands = source->GetRasterCount();
  if (bands < kNeeded || bands > int(kBands.size()))
  {
    throw DataError(fileName + ": has " + std::to_string(bands) + " band" +
      (bands == 1 ? "" : "s") +
      "; a raster of stands has stems_ha, dbh_mean (cm), and if known height (m), dbh_dev (cm), "
      "conifers (%), in this order");
  }
  requireMeaning(*source, fileName);
  const RasterPlace place = placeOfCells(*source, fileName, notes);
  const Cells cells(terrain);
  noteCrs(place.crs, cells, fileName, notes);
  const CrsChange change = layerChange(fileName, place.crs, cells.crs, notes);
  const Eigen::Vector2d origin = terrain.geometry().origin().head<2>();
  const auto corner = [&](double column, double row)
  {
    const auto& a = place.affine;
    double x = a[0] + column * a[1] + row * a[2], y = a[3] + column * a[4] + row * a[5];
    const bool known = place.crs && cells.crs ? change.forth(1, &x, &y) : true;
    return known ? Vec3(x - origin.x(), y - origin.y(), 0.0) : Vec3(kNothing, kNothing, 0.0);
  };
  const int columns = source->GetRasterXSize();
  Rows rows(*source, fileName, messages, notes);
  bool over = false;
  double stemsOfAll = 0.0;
  for (int row = 0; row < source->GetRasterYSize(); ++row)
  {
    stayWanted();
    rows.read(row);
    for (int column = 0; column < columns; ++column)
    {
      const std::vector<Vec3> ring = { corner(column, row), corner(column + 1, row),
        corner(column + 1, row + 1), corner(column, row + 1) };
      Vec3 least = ring[0], most = ring[0];
      for (const Vec3& at : ring)
      {
        least = least.cwiseMin(at);
        most = most.cwiseMax(at);
      }
      if (!(least.x() < terrain.width() && most.x() > 0.0 && least.y() < terrain.height() &&
            most.y() > 0.0))
      {
        continue;
      }
      over = true;
      const double stems = rows.at(column, 0, 0.0);
      if (stems == 0.0)
      {
        continue;
      }
      Stand& stand = stands.emplace_back(standOf(rows, column, stems));
      stand.feature = std::int64_t(row) * columns + column + 1;
      stand.rings = { ring };
      stemsOfAll += stems * (ring[2] - ring[0]).cross(ring[3] - ring[1]).norm() / (2.0 * kHectare);
      if (stemsOfAll > kMostStems)
      {
        throw DataError(fileName + ": has more than " + number(kMostStems) +
          " stems on the slope; is band 1 per hectare? Cut out what rocks can reach");
      }
    }
  }
  if (!over)
  {
    const auto& a = place.affine;
    const Box box{ a[0], a[0] + columns * a[1], a[3] + source->GetRasterYSize() * a[5], a[3] };
    failOverlap(fileName, extentText(box, place.crs, cells), cells);
  }
  if (stands.empty())
  {
    throw DataError(fileName + ": has no cell with stems on the slope");
  }
  return stands;
}

} // namespace rockfall
