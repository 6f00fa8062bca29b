#include "gis/base/gdal.h"

#include "base/detachedCall.h"
#include "base/errors.h"
#include "gis/base/tableFile.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <iterator>
#include <mutex>

namespace rockfall::gis
{

namespace
{

void CPL_STDCALL keep(CPLErr level, CPLErrorNum, const char* text)
{
  auto& kept = *static_cast<Messages::Kept*>(CPLGetErrorHandlerUserData());
  if (level >= CE_Failure && kept.failure.empty())
  {
    kept.failure = text;
  }
  else if (level == CE_Warning)
  {
    kept.warning = kept.warning.empty() ? text : kept.warning;
    if (kept.lostText.empty() && std::strstr(text, "Invalid value type"))
    {
      kept.lostText = text;
    }
  }
}

void registerDrivers()
{
  static std::once_flag once;
  std::call_once(once, [] { GDALAllRegister(); });
}

enum class Kind
{
  Raster,
  Vector
};

/// Result of opening a file.
struct Opened
{
  DatasetPtr dataset;
  std::string failure; ///< GDAL's reason where there is none.
  std::string address; ///< Asked for and not opened; empty: none.
};

/// Some drivers read all of a file to open it (XYZ, GeoJSON, KML, spreadsheets) and ask nobody.
Opened tryOpen(const std::string& fileName, Kind kind)
{
  const char* const* drivers = openingDrivers();
  // Tables: every column as text. A column that GDAL took for numbers would turn words into zeros.
  // GeoJSON: a text like 3:2 stays one; GDAL would make a time of day of it. Other drivers do not
  // know these options and say so in a warning that nobody sees.
  // GeoJSON: its own text is kept, as true among numbers becomes 1.
  // GML: no schema from an address that the file names, unless that is allowed.
  const char* const tableOptions[] = { "AUTODETECT_TYPE=NO", "DATE_AS_STRING=YES",
    "NATIVE_DATA=YES", drivers ? "DOWNLOAD_SCHEMA=NO" : nullptr, nullptr };
  // Text grids: GDAL takes one without a point for integers, and reads nan, inf and the like as 0.
  const char* const rasterOptions[] = { "DATATYPE=Float64", nullptr };
  // The vertical part of a GeoTIFF's CRS, also of the old versions that GDAL takes it away from.
  const CPLConfigOptionSetter vertical("GTIFF_REPORT_COMPD_CS", "YES", true);
  // Spreadsheets: GDAL takes a first row for a header only if the next one is not all text as well.
  const CPLConfigOptionSetter headers[] = { { "OGR_XLSX_HEADERS", "FORCE", false },
    { "OGR_ODS_HEADERS", "FORCE", false }, { "OGR_XLS_HEADERS", "FORCE", false } };
  Messages messages;
  takeRefusedAddress();
  const unsigned flags = GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR |
    (kind == Kind::Raster ? GDAL_OF_RASTER : GDAL_OF_VECTOR);
  DatasetPtr dataset(GDALDataset::Open(
    fileName.c_str(), flags, drivers, kind == Kind::Vector ? tableOptions : rasterOptions));
  if (dataset)
  {
    // Metadata of a GeoPackage that nobody has asked for go to an .aux.xml beside it (GDAL 3.10).
    dataset->GetMetadata();
  }
  for (int i = 0; kind == Kind::Vector && dataset && i < dataset->GetLayerCount(); ++i)
  {
    dataset->GetLayer(i)->GetLayerDefn(); // sheets look for their header only when they are asked
  }
  return { std::move(dataset), messages.failure(), takeRefusedAddress() };
}

Opened openOrLeave(const std::string& fileName, Kind kind)
{
  return detachedCall(
    [fileName, kind, all = openingDrivers() == nullptr]
    {
      const AllowReferences allow(all); // of the thread that this runs on
      return tryOpen(fileName, kind);
    });
}

/// `path`: where the file is read from, if that is not under its own name.
DatasetPtr open(
  const std::string& fileName, Kind kind, Messages& messages, const std::string& path = {})
{
  registerDrivers();
  if (fileName.empty())
  {
    throw FileError("No file name was given");
  }
  refuseReferences(fileName, GDAL_OF_RASTER | GDAL_OF_VECTOR);
  messages.clear();
  const auto local = [&](Opened opened)
  {
    if (!opened.address.empty())
    {
      throw FileError(fileName + ": names the address " + opened.address + whereAllowed());
    }
    return opened;
  };
  Opened opened = local(openOrLeave(path.empty() ? fileName : path, kind));
  if (opened.dataset)
  {
    refuseNamedFiles(*opened.dataset, fileName);
    return std::move(opened.dataset);
  }

  // Only now: names like NETCDF:"a.nc":z and /vsizip/ are no files, and some formats are folders.
  const std::string& reason = opened.failure;
  VSIStatBufL status;
  if (VSIStatExL(fileName.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG) != 0)
  {
    throw FileError(fileName + ": no such file");
  }
  if (VSI_ISDIR(status.st_mode))
  {
    throw FileError(fileName + ": is a folder, not a file");
  }
  const Kind other = kind == Kind::Raster ? Kind::Vector : Kind::Raster;
  std::vector<std::string> unused;
  const TableFile table =
    other == Kind::Vector ? readableTable(fileName, unused) : TableFile{ fileName, "" };
  const bool isOther = local(openOrLeave(table.path, other)).dataset != nullptr;
  CloseDataset{ table.folder }(nullptr);
  if (isOther)
  {
    throw FileError(fileName +
      (kind == Kind::Raster ? ": is a vector layer, a raster is needed"
                            : ": is a raster, a layer of points or a table is needed"));
  }
  throw FileError(fileName +
    (kind == Kind::Raster ? ": is not a raster that GDAL can read"
                          : ": is not a vector layer or table that GDAL can read") +
    (reason.empty() ? "" : " (" + reason + ")"));
}

} // namespace

Messages::Messages()
{
  CPLPushErrorHandlerEx(keep, &kept_);
}

Messages::~Messages()
{
  CPLPopErrorHandler();
}

void CloseDataset::operator()(GDALDataset* dataset) const
{
  GDALClose(dataset);
  if (!folder.empty())
  {
    VSIRmdirRecursive(folder.c_str());
  }
}

DatasetPtr openRaster(const std::string& fileName, Messages& messages)
{
  return open(fileName, Kind::Raster, messages);
}

DatasetPtr openVector(
  const std::string& fileName, Messages& messages, std::vector<std::string>* notes)
{
  // Before any of it is read: its name may be an address.
  registerDrivers();
  refuseReferences(fileName, GDAL_OF_RASTER | GDAL_OF_VECTOR);
  std::vector<std::string> made;
  const TableFile table = readableTable(fileName, made);
  CloseDataset closing{ table.folder };
  try
  {
    DatasetPtr dataset = open(fileName, Kind::Vector, messages, table.path);
    tellSchema(table, fileName, made);
    dataset.get_deleter() = std::move(closing);
    if (notes)
    {
      std::move(made.begin(), made.end(), std::back_inserter(*notes));
    }
    return dataset;
  }
  catch (...)
  {
    closing(nullptr);
    throw;
  }
}

bool isOfDriver(const GDALDataset& dataset, const char* name)
{
  // GDAL's own functions are not const.
  auto* driver = const_cast<GDALDataset&>(dataset).GetDriver();
  return driver && EQUAL(driver->GetDescription(), name);
}

std::string exactly(double value)
{
  char text[32];
  return { text, std::to_chars(text, text + sizeof(text), value).ptr };
}

std::string sizeText(std::int64_t columns, std::int64_t rows)
{
  return std::to_string(columns) + " x " + std::to_string(rows);
}

} // namespace rockfall::gis
