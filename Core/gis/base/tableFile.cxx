#include "gis/base/tableFile.h"

#include "base/text/nameKey.h"
#include "base/text/tableText.h"
#include "gis/base/tableText.h"
#include "gis/base/writtenName.h"

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <optional>
#include <set>

namespace rockfall::gis
{

namespace
{

/// A table of more bytes is left to GDAL: no reader takes as many rows.
constexpr std::int64_t largestTable = std::int64_t(1) << 30;

std::optional<std::string> wholeTable(const std::string& path)
{
  return wholeFile(path, largestTable);
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

bool isGml(const std::string& fileName)
{
  return nameKey(CPLGetExtension(fileName.c_str())) == "gml";
}

/// A folder in memory of its own, for one file.
TableFile inMemory(const std::string& fileName, const std::string& content)
{
  static std::atomic<int> count = 0;
  TableFile made;
  made.folder = "/vsimem/rockfall-table-" + std::to_string(++count);
  made.path = made.folder + "/" + CPLGetFilename(fileName.c_str());
  writeInMemory(made.path, content);
  return made;
}

/// Fields, geometries and CRSs in a .gfs, one line each.
std::set<std::string> statementsOf(const std::string& schema)
{
  std::set<std::string> all;
  const CPLXMLTreeCloser tree(CPLParseXMLString(schema.c_str()));
  const CPLXMLNode* const list =
    tree.get() ? CPLGetXMLNode(tree.get(), "=GMLFeatureClassList") : nullptr;
  for (const CPLXMLNode* of = list ? list->psChild : nullptr; of; of = of->psNext)
  {
    if (!EQUAL(of->pszValue, "GMLFeatureClass"))
    {
      continue;
    }
    const std::string layer = CPLGetXMLValue(of, "Name", "");
    all.insert(layer + " in " + CPLGetXMLValue(of, "SRSName", "no CRS"));
    for (const CPLXMLNode* field = of->psChild; field; field = field->psNext)
    {
      if (EQUAL(field->pszValue, "PropertyDefn"))
      {
        all.insert(layer + "." + CPLGetXMLValue(field, "Name", "") + " " +
          CPLGetXMLValue(field, "Type", ""));
      }
    }
  }
  return all;
}

} // namespace

void tellSchema(
  const TableFile& table, const std::string& fileName, std::vector<std::string>& notes)
{
  const std::string fresh = wholeTable(CPLResetExtension(table.path.c_str(), "gfs")).value_or("");
  if (table.schema.empty() || fresh.empty())
  {
    return;
  }
  const std::set<std::string> own = statementsOf(fresh), other = statementsOf(table.schema);
  std::vector<std::string> differing;
  std::set_symmetric_difference(
    own.begin(), own.end(), other.begin(), other.end(), std::back_inserter(differing));
  if (!differing.empty())
  {
    notes.push_back(std::string(CPLGetFilename(CPLResetExtension(fileName.c_str(), "gfs"))) +
      " beside it says otherwise than the GML itself, first \"" + differing.front() +
      "\"; it was not read.");
  }
}

TableFile readableTable(const std::string& fileName, std::vector<std::string>& notes)
{
  VSIStatBufL status;
  const bool gml = isGml(fileName);
  if ((!gml && !isTable(fileName)) || VSIStatL(fileName.c_str(), &status) != 0 ||
    VSI_ISDIR(status.st_mode))
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
  if (gml)
  {
    TableFile made = inMemory(fileName, *written);
    made.schema = beside("gfs").value_or("");
    return made;
  }
  std::string text = asUtf8(*written, beside("cpg").value_or(""), fileName, notes);
  std::optional<std::string> bare = bareTable(text, fileName, notes);
  if (!bare && text == *written)
  {
    return { fileName, "" };
  }
  TableFile made = inMemory(fileName, bare ? *bare : text);
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
