#include "gis/base/tableFile.h"

#include "base/text/nameKey.h"
#include "base/text/tableText.h"
#include "gis/base/tableText.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>

#include <atomic>
#include <memory>
#include <optional>

namespace rockfall::gis
{

namespace
{

/// A table of more bytes is left to GDAL: no reader takes as many rows.
constexpr GIntBig largestTable = GIntBig(1) << 30;

std::optional<std::string> wholeTable(const std::string& path)
{
  GByte* bytes = nullptr;
  vsi_l_offset size = 0;
  if (!VSIIngestFile(nullptr, path.c_str(), &bytes, &size, largestTable))
  {
    return std::nullopt;
  }
  const std::unique_ptr<GByte, void (*)(void*)> owner(bytes, VSIFree);
  return std::string(reinterpret_cast<const char*>(bytes), std::size_t(size));
}

void writeInMemory(const std::string& path, const std::string& content)
{
  if (VSILFILE* file = VSIFOpenL(path.c_str(), "wb"))
  {
    VSIFWriteL(content.data(), 1, content.size(), file);
    VSIFCloseL(file);
  }
}

bool isTable(const std::string& fileName)
{
  const std::string end = nameKey(CPLGetExtension(fileName.c_str()));
  return end == "csv" || end == "tsv" || end == "psv";
}

} // namespace

TableFile readableTable(const std::string& fileName, std::vector<std::string>& notes)
{
  VSIStatBufL status;
  if (!isTable(fileName) || VSIStatL(fileName.c_str(), &status) != 0 || VSI_ISDIR(status.st_mode))
  {
    return { fileName, "" };
  }
  const std::optional<std::string> written = wholeTable(fileName);
  if (!written)
  {
    return { fileName, "" };
  }
  const auto beside = [&](const char* end)
  { return wholeTable(CPLResetExtension(fileName.c_str(), end)); };
  std::string text = asUtf8(*written, beside("cpg").value_or(""), fileName, notes);
  std::optional<std::string> bare = bareTable(text, fileName, notes);
  if (!bare && text == *written)
  {
    return { fileName, "" };
  }
  static std::atomic<int> count = 0;
  TableFile made;
  made.folder = "/vsimem/rockfall-table-" + std::to_string(++count);
  made.path = made.folder + "/" + CPLGetFilename(fileName.c_str());
  writeInMemory(made.path, bare ? *bare : text);
  for (const char* end : { "csvt", "prj" })
  {
    if (const auto companion = beside(end))
    {
      writeInMemory(CPLResetExtension(made.path.c_str(), end), *companion);
    }
  }
  return made;
}

} // namespace rockfall::gis
