#include "gis/trust/gridAxes.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "gis/base/gdal.h"
#include "gis/trust/heightUnit.h"

#include <cpl_string.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <memory>

namespace rockfall::gis
{

namespace
{

/// Nodes may be so far from where even steps put them, in cells: as SourceGrid takes cells for
/// square.
constexpr double evenWithin = 0.01;

using ArrayPtr = std::shared_ptr<GDALMDArray>;

std::string attributeOf(const ArrayPtr& array, const char* name)
{
  const auto attribute = array->GetAttribute(name);
  const char* text = attribute ? attribute->ReadAsString() : nullptr;
  return nameKey(trimmed(text ? text : ""));
}

/// 'x', 'y' or 0, by what an axis says of itself.
char directionOf(const ArrayPtr& axis)
{
  const std::string standard = attributeOf(axis, "standard_name"),
                    letter = attributeOf(axis, "axis"), name = nameKey(axis->GetName());
  const auto isOf = [&](const char* word) { return standard.find(word) != std::string::npos; };
  if (letter == "x" || isOf("x_coordinate") || isOf("longitude"))
  {
    return 'x';
  }
  if (letter == "y" || isOf("y_coordinate") || isOf("latitude"))
  {
    return 'y';
  }
  if (name == "x" || name == "lon" || name == "longitude" || name == "easting")
  {
    return 'x';
  }
  return name == "y" || name == "lat" || name == "latitude" || name == "northing" ? 'y' : 0;
}

/// The places along a dimension; empty if the file gives none.
std::vector<double> placesOf(const ArrayPtr& axis)
{
  if (!axis || axis->GetDimensionCount() != 1 || axis->GetDataType().GetClass() != GEDTC_NUMERIC)
  {
    return {};
  }
  const GUInt64 start = 0;
  const size_t count = size_t(axis->GetDimensions()[0]->GetSize());
  std::vector<double> places(count);
  if (!axis->Read(
        &start, &count, nullptr, nullptr, GDALExtendedDataType::Create(GDT_Float64), places.data()))
  {
    places.clear();
  }
  return places;
}

void requireEven(
  const ArrayPtr& axis, const std::vector<double>& places, const std::string& fileName)
{
  if (places.size() < 2)
  {
    return;
  }
  const double step = (places.back() - places.front()) / double(places.size() - 1);
  double largest = 0.0, rounding = 0.0;
  for (const double place : places)
  {
    largest = std::max(largest, std::abs(place));
  }
  if (axis->GetDataType().GetNumericDataType() == GDT_Float32)
  {
    rounding = 2.0 * FLT_EPSILON * largest;
  }
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const double off = std::abs(places[i] - (places.front() + double(i) * step));
    if (step != 0.0 && off <= evenWithin * std::abs(step) + rounding)
    {
      continue;
    }
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (std::size_t k = 1; k < places.size(); ++k)
    {
      least = std::min(least, places[k] - places[k - 1]);
      most = std::max(most, places[k] - places[k - 1]);
    }
    throw DataError(fileName + ": its axis \"" + axis->GetName() +
      "\" is not evenly spaced: the steps are " + number(least) + " to " + number(most) +
      "; bring it to a grid of even steps first");
  }
}

/// The numbers of one row of the band's own plane.
std::vector<double> rowOf(const ArrayPtr& array, std::size_t row, int band, std::size_t columns)
{
  const auto& dimensions = array->GetDimensions();
  std::vector<GUInt64> start(dimensions.size(), 0);
  std::vector<size_t> count(dimensions.size(), 1);
  std::size_t place = std::size_t(band) - 1;
  for (std::size_t k = dimensions.size() - 2; k-- > 0;)
  {
    start[k] = place % dimensions[k]->GetSize();
    place /= dimensions[k]->GetSize();
  }
  start[dimensions.size() - 2] = row;
  count.back() = columns;
  std::vector<double> values(columns);
  if (!array->Read(start.data(), count.data(), nullptr, nullptr,
        GDALExtendedDataType::Create(GDT_Float64), values.data()))
  {
    values.clear();
  }
  return values;
}

/// Whether GDAL's first row is the variable's last one.
bool isTurnedOver(const ArrayPtr& array, GDALRasterBand& band)
{
  const auto columns = std::size_t(band.GetXSize());
  std::vector<double> top(columns);
  if (band.RasterIO(GF_Read, 0, 0, band.GetXSize(), 1, top.data(), band.GetXSize(), 1, GDT_Float64,
        0, 0, nullptr) != CE_None)
  {
    return false;
  }
  const auto same = [&top](const std::vector<double>& row)
  {
    return std::equal(row.begin(), row.end(), top.begin(), top.end(),
      [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); });
  };
  return !same(rowOf(array, 0, band.GetBand(), columns)) &&
    same(rowOf(array, std::size_t(band.GetYSize()) - 1, band.GetBand(), columns));
}

/// The unit of both axes.
void findUnit(
  const ArrayPtr& xAxis, const ArrayPtr& yAxis, const std::string& fileName, GridAxes& axes)
{
  const std::string one = xAxis ? attributeOf(xAxis, "units") : std::string(),
                    other = yAxis ? attributeOf(yAxis, "units") : std::string();
  const auto metres = metresPer(one), otherMetres = metresPer(other);
  if (!metres || !otherMetres)
  {
    return; // degrees, or nothing that says a length
  }
  if (*metres != *otherMetres)
  {
    throw DataError(fileName + ": its axis \"" + xAxis->GetName() + "\" is in " + one + ", \"" +
      yAxis->GetName() + "\" in " + other + "; bring both to one unit first");
  }
  axes.metres = *metres;
  axes.unit = one;
}

AxesPlace placeOf(const ArrayPtr& array, GDALRasterBand& band, const ArrayPtr& xAxis,
  const std::vector<double>& x, const ArrayPtr& yAxis, std::vector<double> y, double metres)
{
  AxesPlace place;
  if (isTurnedOver(array, band))
  {
    std::reverse(y.begin(), y.end());
  }
  place.inDegrees = attributeOf(xAxis, "units").starts_with("degree") &&
    attributeOf(yAxis, "units").starts_with("degree");
  const double dx = (x.back() - x.front()) / double(x.size() - 1) * metres;
  const double dy = (y.back() - y.front()) / double(y.size() - 1) * metres;
  place.affine = { x.front() * metres - 0.5 * dx, dx, 0.0, y.front() * metres - 0.5 * dy, 0.0, dy };
  return place;
}

} // namespace

GridAxes checkAxes(GDALDataset& dataset, GDALRasterBand& band, bool placed,
  const std::string& fileName, std::vector<std::string>& notes)
{
  const char* variable = band.GetMetadataItem("NETCDF_VARNAME");
  const CPLStringList files(dataset.GetFileList());
  if (!isOfDriver(dataset, "netCDF") || !variable || files.size() == 0)
  {
    return {};
  }
  const char* const drivers[] = { "netCDF", nullptr };
  const DatasetPtr whole(GDALDataset::Open(
    files[0], GDAL_OF_MULTIDIM_RASTER | GDAL_OF_READONLY, drivers, nullptr, nullptr));
  const auto root = whole ? whole->GetRootGroup() : nullptr;
  ArrayPtr array;
  if (root)
  {
    array =
      *variable == '/' ? root->OpenMDArrayFromFullname(variable) : root->OpenMDArray(variable);
    array = array ? array : root->ResolveMDArray(variable, "/");
  }
  if (!array || array->GetDimensionCount() < 2)
  {
    return {};
  }
  const auto& dimensions = array->GetDimensions();
  const ArrayPtr xAxis = dimensions.back()->GetIndexingVariable(),
                 yAxis = dimensions[dimensions.size() - 2]->GetIndexingVariable();
  if (xAxis && yAxis && (directionOf(xAxis) == 'y' || directionOf(yAxis) == 'x'))
  {
    throw DataError(fileName + ": the rows of \"" + array->GetName() + "\" run along \"" +
      xAxis->GetName() + "\", its columns along \"" + yAxis->GetName() +
      "\"; turn it first, e.g. gdalmdimtranslate -array name=" + array->GetName() +
      ",transpose=[1,0]");
  }
  std::string others;
  double places = 1.0;
  for (std::size_t k = 0; k + 2 < dimensions.size(); ++k)
  {
    places *= double(dimensions[k]->GetSize());
    others += (others.empty() ? "" : ", ") + dimensions[k]->GetName() + " of " +
      std::to_string(dimensions[k]->GetSize());
  }
  if (places > 1.0)
  {
    notes.push_back("The variable \"" + array->GetName() + "\" has further axes (" + others +
      "); band " + std::to_string(band.GetBand()) + " of " + number(places) + " was taken.");
  }
  const std::vector<double> x = placesOf(xAxis), y = placesOf(yAxis);
  requireEven(xAxis, x, fileName);
  requireEven(yAxis, y, fileName);
  GridAxes axes;
  findUnit(xAxis, yAxis, fileName, axes);
  if (placed || x.size() != std::size_t(band.GetXSize()) ||
    y.size() != std::size_t(band.GetYSize()) || x.size() < 2 || y.size() < 2)
  {
    return axes;
  }
  notes.push_back("The file's place is that of its axes \"" + xAxis->GetName() + "\" and \"" +
    yAxis->GetName() + "\".");
  axes.place = placeOf(array, band, xAxis, x, yAxis, y, axes.metres);
  return axes;
}

} // namespace rockfall::gis
