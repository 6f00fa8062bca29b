#include "gis/base/writtenName.h"

#include "base/text/nameKey.h"
#include "base/text/plainText.h"

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>
#include <system_error>

namespace rockfall::gis
{

namespace
{

/// A virtual dataset is a page of text, or a mosaic of many thousand tiles.
constexpr std::int64_t largestXml = 256 << 20; // bytes

/// GDAL's file systems that read one local file, or memory. Others are networks, standard input,
/// or name further files (/vsisparse/).
constexpr const char* localSystems[] = { "/vsimem/", "/vsizip/", "/vsizip{", "/vsitar/", "/vsitar{",
  "/vsigzip/", "/vsi7z/", "/vsi7z{", "/vsirar/", "/vsirar{", "/vsisubfile/" };

} // namespace

bool isOnOtherSystem(const std::string& name)
{
  const std::string low = nameKey(name);
  for (auto at = low.find("/vsi"); at != std::string::npos; at = low.find("/vsi", at + 1))
  {
    const bool folder = low.find_first_of("/{?", at + 1) == std::string::npos;
    if (!folder &&
      std::none_of(std::begin(localSystems), std::end(localSystems),
        [&](const char* system) { return low.compare(at, std::strlen(system), system) == 0; }))
    {
      return true;
    }
  }
  return false;
}

bool isAddress(const std::string& name)
{
  return name.find("://") != std::string::npos || isOnOtherSystem(name);
}

bool isXml(const std::string& name)
{
  return trimmed(name).starts_with("<");
}

std::optional<std::string> wholeFile(const std::string& fileName, std::int64_t largest)
{
  GByte* bytes = nullptr;
  vsi_l_offset size = 0;
  if (!VSIIngestFile(nullptr, fileName.c_str(), &bytes, &size, largest))
  {
    return std::nullopt;
  }
  const std::unique_ptr<GByte, void (*)(void*)> owner(bytes, VSIFree);
  return std::string(reinterpret_cast<const char*>(bytes), std::size_t(size));
}

std::string xmlOf(const std::string& fileName)
{
  return wholeFile(fileName, largestXml).value_or("");
}

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

std::string sourceFile(const CPLXMLNode* element, const std::string& folder)
{
  const std::string written = element ? CPLGetXMLValue(element, "", "") : "";
  const bool relative = element && CPLTestBool(CPLGetXMLValue(element, "relativeToVRT", "0"));
  return relative && !written.empty()
    ? std::string(CPLProjectRelativeFilename(folder.c_str(), written.c_str()))
    : written;
}

std::string folderOf(const std::string& fileName)
{
  return std::string(CPLGetPath(fileName.c_str()));
}

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

} // namespace rockfall::gis
