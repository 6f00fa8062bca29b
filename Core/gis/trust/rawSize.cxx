#include "gis/trust/rawSize.h"

#include "base/errors.h"
#include "gis/base/gdal.h"
#include "gis/base/writtenName.h"

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cstdlib>

namespace rockfall::gis
{

namespace
{

/// A VRT may be made of others, and these of others again.
constexpr int deepest = 4;

/// Where the numbers of one raw band stand in their file.
struct RawBand
{
  std::string file;
  int number = 1; ///< Of the band, from 1.
  std::int64_t columns = 0, rows = 0;
  std::int64_t first = 0;                       ///< Place of the first number, bytes.
  std::int64_t pixelOffset = 0, lineOffset = 0; ///< Bytes; negative if they run backwards.
  std::int64_t size = 0;                        ///< Of one number, bytes.

  std::int64_t bytesNeeded() const
  {
    return first + std::max<std::int64_t>(0, (rows - 1) * lineOffset) +
      std::max<std::int64_t>(0, (columns - 1) * pixelOffset) + size;
  }
};

void requireBytes(const RawBand& band, const std::string& fileName)
{
  VSIStatBufL status;
  if (VSIStatL(band.file.c_str(), &status) != 0)
  {
    return; // no plain file: GDAL has its own ways to it, and its own errors
  }
  if (std::int64_t(status.st_size) < band.bytesNeeded())
  {
    throw FileError(fileName + (band.file == fileName ? "" : ": its data file " + band.file) +
      ": is truncated: band " + std::to_string(band.number) + " of " +
      sizeText(band.columns, band.rows) + " numbers needs " + std::to_string(band.bytesNeeded()) +
      " bytes, the file has " + std::to_string(status.st_size));
  }
}

/// Checks the raw bands, masks among them, of a VRT's header.
void checkVrtBands(const CPLXMLNode* node, GDALDataset& dataset, const std::string& fileName)
{
  for (; node; node = node->psNext)
  {
    if (node->eType != CXT_Element)
    {
      continue;
    }
    if (EQUAL(node->pszValue, "VRTRasterBand") &&
      EQUAL(CPLGetXMLValue(node, "subClass", ""), "VRTRawRasterBand"))
    {
      const auto integer = [node](const char* name, const char* missing)
      { return std::int64_t(std::strtoll(CPLGetXMLValue(node, name, missing), nullptr, 10)); };
      RawBand band;
      band.file =
        sourceFile(CPLGetXMLNode(node, "SourceFilename"), CPLGetPath(dataset.GetDescription()));
      band.number = int(integer("band", "1"));
      band.columns = dataset.GetRasterXSize();
      band.rows = dataset.GetRasterYSize();
      band.size =
        GDALGetDataTypeSizeBytes(GDALGetDataTypeByName(CPLGetXMLValue(node, "dataType", "Byte")));
      band.first = integer("ImageOffset", "0");
      band.pixelOffset = integer("PixelOffset", "0");
      band.lineOffset = integer("LineOffset", "0");
      requireBytes(band, fileName);
    }
    checkVrtBands(node->psChild, dataset, fileName);
  }
}

void check(GDALDataset& dataset, const std::string& fileName, int depth)
{
  GDALDataset::RawBinaryLayout layout;
  if (dataset.GetRawBinaryLayout(layout))
  {
    RawBand band;
    band.file = layout.osRawFilename;
    band.columns = dataset.GetRasterXSize();
    band.rows = dataset.GetRasterYSize();
    band.size = GDALGetDataTypeSizeBytes(layout.eDataType);
    band.pixelOffset = layout.nPixelOffset;
    band.lineOffset = layout.nLineOffset;
    for (band.number = 1; band.number <= dataset.GetRasterCount(); ++band.number)
    {
      band.first = std::int64_t(layout.nImageOffset) + (band.number - 1) * layout.nBandOffset;
      requireBytes(band, fileName);
    }
    return;
  }
  if (depth == deepest || !isOfDriver(dataset, "VRT"))
  {
    return;
  }
  if (const char* const* header = dataset.GetMetadata("xml:VRT"))
  {
    const CPLXMLTreeCloser root(CPLParseXMLString(*header));
    checkVrtBands(root.get(), dataset, fileName);
  }
  const CPLStringList files(dataset.GetFileList());
  const char* const silent[] = { "ENVI", "VRT", nullptr };
  for (int k = 0; k < files.size(); ++k)
  {
    // Not VERBOSE_ERROR: what cannot be opened is for GDAL to report, when it is read.
    const DatasetPtr part(EQUAL(files[k], dataset.GetDescription())
        ? nullptr
        : GDALDataset::Open(files[k], GDAL_OF_READONLY | GDAL_OF_RASTER, silent));
    if (part)
    {
      check(*part, fileName, depth + 1);
    }
  }
}

/// Nodes of a raster that nobody minds, 100 MB.
constexpr double fewNodes = 1.25e7;
/// Most nodes for each byte of its files: the best compression of a plain of one height has some
/// 1000.
constexpr double mostPerByte = 2000.0;

} // namespace

void requireSubstance(GDALDataset& dataset, const std::string& fileName)
{
  const double columns = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
  const CPLStringList files(dataset.GetFileList());
  double bytes = 0.0;
  for (int k = 0; k < files.size(); ++k)
  {
    VSIStatBufL status;
    bytes += VSIStatL(files[k], &status) == 0 ? double(status.st_size) : 0.0;
  }
  if (columns * rows > fewNodes && bytes > 0.0 && columns * rows > mostPerByte * bytes)
  {
    throw DataError(fileName + ": its " + gis::number(columns) + " x " + gis::number(rows) +
      " nodes need " + gis::number(columns * rows * sizeof(double) / 1e9) +
      " GB of memory, but all of it is in " + gis::number(bytes) +
      " bytes, so that nearly nothing of it can be data; cut out what is, e.g. with "
      "gdal_translate -projwin");
  }
}

void checkRawSize(GDALDataset& dataset, const std::string& fileName)
{
  check(dataset, fileName, 0);
}

} // namespace rockfall::gis
