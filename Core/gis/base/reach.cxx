#include "gis/base/reach.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "gis/base/fields.h"
#include "gis/base/hdf5References.h"

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <vector>

namespace rockfall
{

namespace
{

thread_local bool allowed = false;

} // namespace

AllowReferences::AllowReferences(bool allow)
  : before_(allowed)
{
  allowed = allow;
}

AllowReferences::~AllowReferences()
{
  allowed = before_;
}

namespace gis
{

namespace
{

/// A virtual dataset may be made of others, and these of others again.
constexpr int mostNested = 4;
/// A virtual dataset is a page of text, or a mosaic of many thousand tiles.
constexpr GIntBig largestXml = 256 << 20; // bytes

/// Drivers that read the file that is named and what lies beside it under its name. Not: those of
/// network services and databases, those whose header may name the file of the numbers (MRF, PDS,
/// SNODAS, PCIDSK, HDF4, …), lists of tiles, and GPSBabel, which runs a program. VRTs and HDF5 are
/// looked into.
const char* const known[] = { "VRT", "OGR_VRT",
  // rasters
  "GTiff", "COG", "HFA", "AIG", "AAIGrid", "GRASSASCIIGrid", "ISG", "SDTS", "DTED", "PNG", "JPEG",
  "MEM", "JDEM", "GIF", "BIGGIF", "FITS", "BSB", "XPM", "BMP", "PCRaster", "ILWIS", "SGI",
  "SRTMHGT", "Leveller", "Terragen", "netCDF", "JP2OpenJPEG", "JP2ECW", "JP2KAK", "JP2Lura",
  "JP2MrSID", "ECW", "MrSID", "JPEGXL", "GRIB", "RMF", "RST", "GSAG", "GSBG", "GS7BG", "R", "WEBP",
  "MBTiles", "PNM", "BT", "LAN", "EIR", "LCP", "GTX", "LOSLAS", "NTv2", "CTable2", "ACE2", "KRO",
  "ROI_PAC", "RRASTER", "BYN", "ARG", "RIK", "USGSDEM", "GXF", "KEA", "BAG", "S102", "S104", "S111",
  "HDF5", "HDF5Image", "NWT_GRD", "NWT_GRC", "SAGA", "XYZ", "HF2", "CTG", "ZMap", "NGSGEOID",
  "SIGDEM", "HEIF", "TGA", "GPKG", "GenBin", "ENVI", "EHdr", "GMT", "NOAA_B", "NSIDCbin", "E00GRID",
  "ESAT", "OZI", "TIFF", "LIBERTIFF", "Zarr",
  // layers
  "ESRI Shapefile", "MapInfo File", "UK .NTF", "LVBAG", "OGR_SDTS", "S57", "DGN", "DGNv8", "DWG",
  "Memory", "CSV", "NAS", "GML", "GPX", "LIBKML", "KML", "GeoJSON", "GeoJSONSeq", "ESRIJSON",
  "TopoJSON", "JSONFG", "Interlis 1", "Interlis 2", "OGR_GMT", "SQLite", "WAsP", "OpenFileGDB",
  "FileGDB", "DXF", "CAD", "FlatGeobuf", "Geoconcept", "GeoRSS", "VFK", "OSM", "SOSI", "EDIGEO",
  "SVG", "Idrisi", "XLS", "ODS", "XLSX", "SXF", "Selafin", "JML", "VDV", "MVT", "MapML", "TIGER",
  "AVCBin", "AVCE00", "Parquet", "Arrow", "PMTiles", "AIVector", "MiraMonVector", "PGDUMP",
  nullptr };

const char* const remedy = " (files that name network addresses or other files of the machine are "
                           "read only where AllowReferences is on)";

bool isAddress(const std::string& name)
{
  const std::string low = nameKey(name);
  const auto holds = [&low](const char* part) { return low.find(part) != std::string::npos; };
  return holds("://") || holds("/vsicurl") || holds("/vsis3") || holds("/vsigs") ||
    holds("/vsiaz") || holds("/vsiadls") || holds("/vsioss") || holds("/vsiswift") ||
    holds("/vsihdfs") || holds("/vsiwebhdfs") || holds("/vsistdin") || holds("/vsicrypt");
}

bool isKnown(const char* driver)
{
  for (const char* const* name = known; *name; ++name)
  {
    if (EQUAL(*name, driver))
    {
      return true;
    }
  }
  return false;
}

bool isXml(const std::string& name)
{
  return trimmed(name).starts_with("<");
}

/// All of a file; nothing if it is none, or too large for what it should be.
std::string xmlOf(const std::string& fileName)
{
  GByte* bytes = nullptr;
  vsi_l_offset size = 0;
  if (!VSIIngestFile(nullptr, fileName.c_str(), &bytes, &size, largestXml))
  {
    return {};
  }
  std::string content(reinterpret_cast<const char*>(bytes), std::size_t(size));
  VSIFree(bytes);
  return content;
}

/// Whether a file lies in a folder or below, after all its links.
bool isWithin(const std::string& fileName, const std::string& folder)
{
  if (fileName.starts_with("/vsi") || folder.starts_with("/vsi"))
  {
    return fileName.starts_with(folder + "/") && fileName.find("..") == std::string::npos;
  }
  std::error_code failed;
  const auto whole = [&failed](const std::string& path)
  { return std::filesystem::weakly_canonical(std::filesystem::absolute(path, failed), failed); };
  const std::filesystem::path inner = whole(fileName), outer = whole(folder.empty() ? "." : folder);
  return !failed &&
    std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

void refuseDriver(const std::string& fileName, const std::string& whole, unsigned flags, int depth);

std::string folderOf(const std::string& fileName)
{
  return std::string(CPLGetPath(fileName.c_str()));
}

/// The file of a name like NETCDF:"a.nc":z or HDF5:a.h5://z; other names as they are.
std::string fileWithin(const std::string& name)
{
  const auto colon = name.find(':'), quote = name.find('"');
  if (colon == std::string::npos || name.find_first_of("/\\.") < colon)
  {
    return name;
  }
  if (quote != std::string::npos)
  {
    return name.substr(quote + 1, name.find('"', quote + 1) - quote - 1);
  }
  VSIStatBufL status;
  for (auto end = name.size(); end != std::string::npos && end > colon;
       end = name.rfind(':', end - 1))
  {
    const std::string file = name.substr(colon + 1, end - colon - 1);
    if (VSIStatL(file.c_str(), &status) == 0)
    {
      return file;
    }
  }
  return name;
}

/// Files that an HDF5 file names, as virtual rasters do.
void refuseHdf5References(const std::string& fileName, const std::string& whole, int depth)
{
  if (fileName.starts_with("/vsi"))
  {
    throw FileError(whole +
      ": is HDF5 in an archive or in memory, which cannot be looked into; "
      "unpack it first" +
      remedy);
  }
  const std::optional<std::vector<std::string>> names = hdf5References(fileName);
  if (!names)
  {
    throw FileError(
      whole + ": is HDF5 that cannot be looked into: damaged, or of another version" + remedy);
  }
  for (const std::string& written : *names)
  {
    if (written.empty() || written == ".")
    {
      continue; // the file itself
    }
    const std::string folder = folderOf(fileName);
    const bool absolute = std::filesystem::path(written).is_absolute();
    const std::string name =
      absolute ? written : CPLFormFilename(folder.c_str(), written.c_str(), nullptr);
    if (isAddress(written) || !isWithin(name, folder))
    {
      throw FileError(whole + ": names " + written + ", which is not beside it" + remedy);
    }
    if (depth == mostNested)
    {
      throw FileError(whole + ": is made of files that are made of others, deeper than " +
        std::to_string(mostNested) + remedy);
    }
    if (isHdf5(name) && name != fileName)
    {
      refuseHdf5References(name, whole, depth + 1);
    }
  }
}

/// Links among the files of a store that lead out of its folder.
void refuseLinksOut(const std::string& folder, const std::string& whole)
{
  namespace fs = std::filesystem;
  std::error_code failed;
  for (fs::recursive_directory_iterator at(folder, failed), end; !failed && at != end;
       at.increment(failed))
  {
    if (at->is_symlink(failed) && !isWithin(at->path().string(), folder))
    {
      throw FileError(whole + ": has a link " + at->path().filename().string() +
        " to a file that is not within it" + remedy);
    }
  }
}

/// Files that a virtual dataset names; `whole` is the file that the user named.
class References
{
public:
  References(const std::string& fileName, const std::string& whole, int depth)
    : folder_(isXml(fileName) ? std::string() : folderOf(fileName))
    , inlineText_(isXml(fileName))
    , whole_(whole)
    , depth_(depth)
  {
  }

  void check(const CPLXMLNode* node)
  {
    for (; node; node = node->psNext)
    {
      if (node->eType != CXT_Element)
      {
        continue;
      }
      const auto is = [node](const char* name) { return EQUAL(node->pszValue, name); };
      if (is("SourceFilename") || is("SourceDataset") || is("SrcDataSource"))
      {
        this->checkName(node);
      }
      else if (is("SrcSQL"))
      {
        const std::string sql = nameKey(CPLGetXMLValue(node, "", ""));
        if (sql.find('\'') != std::string::npos || sql.find('(') != std::string::npos)
        {
          throw FileError(whole_ + ": has an SQL statement that may name other files" + remedy);
        }
      }
      else if (is("PixelFunctionCode"))
      {
        throw FileError(whole_ + ": has a program in it" + remedy);
      }
      this->check(node->psChild);
    }
  }

private:
  void checkName(const CPLXMLNode* node)
  {
    const std::string written = CPLGetXMLValue(node, "", "");
    std::string name = written;
    if (CPLTestBool(CPLGetXMLValue(node, "relativeToVRT", "0")))
    {
      name = CPLProjectRelativeFilename(folder_.c_str(), written.c_str());
    }
    if (written.empty())
    {
      return;
    }
    if (isAddress(name) || isXml(name) || inlineText_ || !isWithin(name, folder_))
    {
      throw FileError(whole_ + ": names " + written + ", which is not beside it" + remedy);
    }
    VSIStatBufL status;
    if (VSIStatExL(name.c_str(), &status, VSI_STAT_EXISTS_FLAG) != 0)
    {
      if (written.find(':') != std::string::npos)
      {
        throw FileError(whole_ + ": names " + written + ", which is no file beside it" + remedy);
      }
      return; // GDAL says so
    }
    if (depth_ == mostNested)
    {
      throw FileError(whole_ + ": is made of files that are made of others, deeper than " +
        std::to_string(mostNested) + remedy);
    }
    refuseDriver(name, whole_, GDAL_OF_RASTER | GDAL_OF_VECTOR, depth_ + 1);
  }

  std::string folder_;
  bool inlineText_;
  const std::string& whole_;
  int depth_;
};

void refuseDriver(const std::string& fileName, const std::string& whole, unsigned flags, int depth)
{
  auto* driver =
    static_cast<GDALDriver*>(GDALIdentifyDriverEx(fileName.c_str(), flags, nullptr, nullptr));
  if (!driver)
  {
    return; // nothing that GDAL reads
  }
  const char* name = driver->GetDescription();
  if (!isKnown(name))
  {
    throw FileError(whole + ": " + (fileName == whole ? "" : "names " + fileName + ", which ") +
      "is read by GDAL's driver " + name + ", which may open network addresses or other files" +
      remedy);
  }
  const std::string file = fileWithin(fileName);
  if (isHdf5(file))
  {
    refuseHdf5References(file, whole, depth);
  }
  if (EQUAL(name, "Zarr"))
  {
    refuseLinksOut(file, whole);
  }
  if (!EQUAL(name, "VRT") && !EQUAL(name, "OGR_VRT"))
  {
    return;
  }
  const std::string text = isXml(fileName) ? fileName : xmlOf(fileName);
  const std::unique_ptr<CPLXMLNode, void (*)(CPLXMLNode*)> root(
    text.empty() ? nullptr : CPLParseXMLString(text.c_str()), CPLDestroyXMLNode);
  if (!root)
  {
    // Other ways to say a virtual raster: vrt://file, which names any.
    throw FileError(whole + ": is a virtual raster that cannot be looked into" + remedy);
  }
  References(fileName, whole, depth).check(root.get());
}

} // namespace

const char* const* openingDrivers()
{
  return allowed ? nullptr : known;
}

StayLocal::StayLocal()
{
  if (allowed)
  {
    return;
  }
  constexpr std::pair<const char*, const char*> options[] = {
    // An ending that no address has: all others are refused.
    { "CPL_VSIL_CURL_ALLOWED_EXTENSIONS", ".nothing-is-allowed" },
    // VirtualText, VirtualShape and their kin are modules of SpatiaLite.
    { "SPATIALITE_LOAD", "NO" },
  };
  for (const auto& [name, value] : options)
  {
    const char* old = CPLGetThreadLocalConfigOption(name, nullptr);
    before_.emplace_back(name, old ? std::optional<std::string>(old) : std::nullopt);
    CPLSetThreadLocalConfigOption(name, value);
  }
}

StayLocal::~StayLocal()
{
  for (const auto& [name, old] : before_)
  {
    CPLSetThreadLocalConfigOption(name, old ? old->c_str() : nullptr);
  }
}

void refuseReferences(const std::string& fileName, unsigned flags)
{
  if (allowed)
  {
    return;
  }
  if (!isXml(fileName) && isAddress(fileWithin(fileName)))
  {
    throw FileError(fileName + ": is an address" + remedy);
  }
  refuseDriver(fileName, fileName, flags, 0);
}

} // namespace gis

} // namespace rockfall
