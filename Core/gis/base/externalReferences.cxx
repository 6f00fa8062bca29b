#include "gis/base/externalReferences.h"

#include "base/errors.h"
#include "base/noFile.h"
#include "base/text/nameKey.h"
#include "gis/base/hdf5References.h"
#include "gis/base/writtenName.h"

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <cstring>
#include <filesystem>
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

/// Drivers that read the file that is named and what lies beside it under its name. Not: those of
/// network services and databases, those whose header may name the file of the numbers (MRF, PDS,
/// SNODAS, PCIDSK, HDF4, …), lists of tiles, and GPSBabel, which runs a program. VRTs and HDF5 are
/// looked into.
const char* const kFormats[] = { "VRT", "OGR_VRT",
  // rasters
  "GTiff", "COG", "HFA", "AIG", "AAIGrid", "GRASSASCIIGrid", "ISG", "SDTS", "DTED", "PNG", "JPEG",
  "JDEM", "GIF", "BIGGIF", "FITS", "BSB", "XPM", "BMP", "PCRaster", "ILWIS", "SGI", "SRTMHGT",
  "Leveller", "Terragen", "netCDF", "JP2OpenJPEG", "JP2ECW", "JP2KAK", "JP2Lura", "JP2MrSID", "ECW",
  "MrSID", "JPEGXL", "GRIB", "RMF", "RST", "GSAG", "GSBG", "GS7BG", "R", "WEBP", "MBTiles", "PNM",
  "BT", "LAN", "EIR", "LCP", "GTX", "LOSLAS", "NTv2", "CTable2", "ACE2", "KRO", "ROI_PAC",
  "RRASTER", "BYN", "ARG", "RIK", "USGSDEM", "GXF", "KEA", "BAG", "S102", "S104", "S111", "HDF5",
  "HDF5Image", "NWT_GRD", "NWT_GRC", "SAGA", "XYZ", "HF2", "CTG", "ZMap", "NGSGEOID", "SIGDEM",
  "HEIF", "TGA", "GPKG", "GenBin", "ENVI", "EHdr", "GMT", "NOAA_B", "NSIDCbin", "E00GRID", "ESAT",
  "OZI", "TIFF", "LIBERTIFF", "Zarr",
  // layers
  "ESRI Shapefile", "MapInfo File", "UK .NTF", "LVBAG", "OGR_SDTS", "S57", "DGN", "DGNv8", "DWG",
  "CSV", "NAS", "GML", "GPX", "LIBKML", "KML", "GeoJSON", "GeoJSONSeq", "ESRIJSON", "TopoJSON",
  "JSONFG", "Interlis 1", "Interlis 2", "OGR_GMT", "SQLite", "WAsP", "OpenFileGDB", "FileGDB",
  "DXF", "CAD", "FlatGeobuf", "Geoconcept", "GeoRSS", "VFK", "OSM", "SOSI", "EDIGEO", "SVG",
  "Idrisi", "XLS", "ODS", "XLSX", "SXF", "Selafin", "JML", "VDV", "MVT", "MapML", "TIGER", "AVCBin",
  "AVCE00", "Parquet", "Arrow", "PMTiles", "AIVector", "MiraMonVector", "PGDUMP", nullptr };

const char* const remedy = " (files that name network addresses or other files of the machine are "
                           "read only where AllowReferences is on)";

/// An address in this program's own memory: what stands there, or the end of the program.
bool isMemory(const std::string& name)
{
  return name.find("MEM:::") != std::string::npos;
}

bool isKnown(const char* driver)
{
  for (const char* const* name = kFormats; *name; ++name)
  {
    if (EQUAL(*name, driver))
    {
      return true;
    }
  }
  return false;
}

void refuseDriver(const std::string& fileName, const std::string& whole, unsigned flags, int depth);

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

/// Checks where values that may name a file lead; `whole` is the file that the user named.
/// Any value, because GDAL's keys for files (sources, masks, overviews, places of nodes, options of
/// drivers) are many and grow.
class NamedFiles
{
public:
  NamedFiles(const std::string& fileName, const std::string& whole, int depth)
    : folder_(isXml(fileName) ? std::string() : folderOf(fileName))
    , inlineText_(isXml(fileName))
    , whole_(whole)
    , depth_(depth)
  {
  }

  /// All elements and attributes of an XML text.
  void checkXml(const CPLXMLNode* node)
  {
    for (; node; node = node->psNext)
    {
      const auto is = [node](const char* name)
      { return node->eType == CXT_Element && EQUAL(node->pszValue, name); };
      if (is("SrcSQL"))
      {
        throw FileError(whole_ + ": has an SQL statement, which may name other files" + remedy);
      }
      if (is("PixelFunctionCode"))
      {
        throw FileError(whole_ + ": has a program in it" + remedy);
      }
      if (is("SourceFilename") || is("SourceDataset") || is("SrcDataSource"))
      {
        this->checkSource(CPLGetXMLValue(node, "", ""), sourceFile(node, folder_));
      }
      else if (node->eType == CXT_Text)
      {
        this->check(node->pszValue);
      }
      this->checkXml(node->psChild);
    }
  }

  /// A value that may be anything. A name with a driver before it, an XML text and a name of an
  /// existing file are looked at; addresses that nothing opens are common among metadata.
  void check(std::string written)
  {
    constexpr std::size_t longest = 4096;
    constexpr const char* base = ":::BASE:::"; // beside the file itself
    written = written.starts_with(base) ? written.substr(std::strlen(base)) : written;
    if (isOnOtherSystem(written))
    {
      this->refuse(written);
    }
    if (isXml(written))
    {
      refuseDriver(written, whole_, GDAL_OF_RASTER | GDAL_OF_VECTOR, this->deeper());
      return;
    }
    const bool word = written.find_first_of("/\\.:") == std::string::npos;
    const bool numbers = written.find_first_not_of("0123456789+-.eE, ") == std::string::npos;
    if (word || numbers || written.size() > longest ||
      written.find_first_of("\n<>") != std::string::npos ||
      written.find("://") != std::string::npos)
    {
      return;
    }
    for (const bool relative : { false, true })
    {
      const std::string name = relative
        ? std::string(CPLProjectRelativeFilename(folder_.c_str(), written.c_str()))
        : written;
      VSIStatBufL status;
      const std::string file = fileWithin(name);
      if (VSIStatL(file.c_str(), &status) == 0 && VSI_ISREG(status.st_mode))
      {
        if (inlineText_ || !isWithin(file, folder_))
        {
          this->refuse(written);
        }
        if (file != whole_)
        {
          refuseDriver(name, whole_, GDAL_OF_RASTER | GDAL_OF_VECTOR, this->deeper());
        }
        return;
      }
    }
    if (written.find(':') != std::string::npos)
    {
      // Databases and services: PG:host=…
      refuseDriver(written, whole_, GDAL_OF_RASTER | GDAL_OF_VECTOR, this->deeper());
    }
  }

private:
  [[noreturn]] void refuse(const std::string& written) const
  {
    throw FileError(whole_ + ": names " + written + ", which is not beside it" + remedy);
  }

  int deeper() const
  {
    if (depth_ == mostNested)
    {
      throw FileError(whole_ + ": is made of files that are made of others, deeper than " +
        std::to_string(mostNested) + remedy);
    }
    return depth_ + 1;
  }

  /// A value that names a file in any case.
  void checkSource(const std::string& written, const std::string& name)
  {
    if (written.empty())
    {
      return;
    }
    if (isAddress(name) || isMemory(name) || isXml(name) || inlineText_ || !isWithin(name, folder_))
    {
      this->refuse(written);
    }
    VSIStatBufL status;
    if (VSIStatExL(name.c_str(), &status, VSI_STAT_EXISTS_FLAG) == 0)
    {
      refuseDriver(name, whole_, GDAL_OF_RASTER | GDAL_OF_VECTOR, this->deeper());
    }
    else if (written.find(':') != std::string::npos)
    {
      throw FileError(whole_ + ": names " + written + ", which is no file beside it" + remedy);
    }
    // Else GDAL says that there is none.
  }

  std::string folder_;
  bool inlineText_;
  const std::string& whole_;
  int depth_;
};

CPLXMLTreeCloser xmlTree(const std::string& text)
{
  return CPLXMLTreeCloser(text.empty() ? nullptr : CPLParseXMLString(text.c_str()));
}

/// The file that GDAL keeps beside another one for what that cannot hold.
void refuseAuxiliary(const std::string& file, const std::string& whole, int depth)
{
  VSIStatBufL status;
  const std::string name = file + ".aux.xml";
  if (!isXml(file) && VSIStatExL(name.c_str(), &status, VSI_STAT_EXISTS_FLAG) == 0)
  {
    const CPLXMLTreeCloser root = xmlTree(xmlOf(name));
    NamedFiles(file, whole, depth).checkXml(root.get());
  }
}

/// Tables of MapInfo that are views or mosaics of others, which their text names.
void refuseTableOfTables(const std::string& file, const std::string& whole)
{
  if (!EQUAL(CPLGetExtension(file.c_str()), "tab"))
  {
    return;
  }
  const std::string text = nameKey(xmlOf(file));
  if (text.find("create view") != std::string::npos || text.find("isseamless") != std::string::npos)
  {
    throw FileError(whole + ": is a table of MapInfo that is made of others" + remedy);
  }
}

/// Pipes, devices and the like: who opens one waits for ever, or reads without an end.
void refusePipes(const std::string& fileName, const std::string& whole)
{
  if (const std::string there = noFile(fileName); !there.empty())
  {
    throw FileError(whole + ": " + (fileName == whole ? "is" : "names " + fileName + ",") + " " +
      there + ", no file");
  }
}

void refuseDriver(const std::string& fileName, const std::string& whole, unsigned flags, int depth)
{
  refusePipes(fileWithin(fileName), whole);
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
  refuseAuxiliary(file, whole, depth);
  if (EQUAL(name, "Zarr"))
  {
    refuseLinksOut(file, whole);
  }
  if (EQUAL(name, "MapInfo File"))
  {
    refuseTableOfTables(file, whole);
  }
  if (!EQUAL(name, "VRT") && !EQUAL(name, "OGR_VRT"))
  {
    return;
  }
  const CPLXMLTreeCloser root = xmlTree(isXml(fileName) ? fileName : xmlOf(fileName));
  if (!root)
  {
    // Other ways to say a virtual raster: vrt://file, which names any.
    throw FileError(whole + ": is a virtual raster that cannot be looked into" + remedy);
  }
  NamedFiles(fileName, whole, depth).checkXml(root.get());
}

} // namespace

std::string whereAllowed()
{
  return remedy;
}

const char* const* openingDrivers()
{
  return allowed ? nullptr : kFormats;
}

void refuseReferences(const std::string& fileName, unsigned flags)
{
  if (isMemory(fileName))
  {
    throw FileError(fileName + ": names memory, which is no file");
  }
  refusePipes(fileName, fileName);
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

void refuseNamedFiles(GDALDataset& dataset, const std::string& fileName)
{
  if (allowed)
  {
    return;
  }
  for (const char* domain : { "OVERVIEWS", "GEOLOCATION" })
  {
    for (CSLConstList item = dataset.GetMetadata(domain); item && *item; ++item)
    {
      const std::string text = *item;
      NamedFiles(fileWithin(fileName), fileName, 0).check(text.substr(text.find('=') + 1));
    }
  }
}

} // namespace gis

} // namespace rockfall
