#include "gis/base/tableFile.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "base/text/tableText.h"
#include "gis/base/writtenName.h"

#include <cpl_conv.h>
#include <cpl_csv.h>
#include <cpl_minixml.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>

namespace rockfall::gis
{

namespace
{

/// Lines of a text, with quoted cells that go over several lines kept whole.
struct TextLines
{
  std::string_view rest;
  std::size_t number = 0; ///< Of the line that was last taken, from 1.
  std::size_t next = 1;

  bool take(std::string_view& line)
  {
    if (rest.empty())
    {
      return false;
    }
    number = next;
    std::size_t end = 0;
    bool quoted = false;
    for (; end < rest.size(); ++end)
    {
      quoted = quoted != (rest[end] == '"');
      next += rest[end] == '\n';
      if (rest[end] == '\n' && !quoted)
      {
        ++end;
        break;
      }
    }
    line = rest.substr(0, end);
    rest.remove_prefix(end);
    return true;
  }
};

bool isComment(std::string_view line)
{
  return line.starts_with("#") || line.starts_with("//");
}

using RowCells = std::vector<std::string>;

bool isAllNumbers(const RowCells& cells)
{
  const auto isEmpty = [](const std::string& cell) { return cell.empty(); };
  return std::count_if(cells.begin(), cells.end(), isEmpty) < std::ptrdiff_t(cells.size()) - 1 &&
    std::all_of(cells.begin(), cells.end(),
      [&](const std::string& cell) { return isEmpty(cell) || parsedNumber(cell); });
}

/// The row with commas between its cells, all of them quoted.
std::string csvRow(const RowCells& cells)
{
  std::string row;
  for (std::string cell : cells)
  {
    for (auto at = cell.find('"'); at != std::string::npos; at = cell.find('"', at + 2))
    {
      cell.insert(at, "\"");
    }
    row += (row.empty() ? "\"" : ",\"") + cell + "\"";
  }
  return row + "\n";
}

bool isBlankLine(std::string_view line)
{
  return line.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

/// Lines before the rows.
struct TableHead
{
  char said = '\0'; ///< The separator, by a line of its own; 0: there is none.
  std::string_view header, lastComment;
  std::size_t comments = 0;
  bool bare = true; ///< There is nothing but the header.

  explicit TableHead(TextLines& lines)
  {
    for (std::string_view line; header.empty() && lines.take(line);)
    {
      const char separator = said ? '\0' : separatorLine(line).value_or('\0');
      if (!separator && !isComment(line) && !isBlankLine(line))
      {
        header = line;
        return;
      }
      bare = false;
      said = separator ? separator : said;
      if (isComment(line))
      {
        lastComment = line;
        ++comments;
      }
    }
  }

  /// The last comment, if it has the names of what is all numbers; else empty.
  std::string_view names(const RowCells& first, char separator) const
  {
    const auto start = lastComment.find_first_not_of("#/ \t");
    if (start == std::string_view::npos || !isAllNumbers(first))
    {
      return {};
    }
    const RowCells named = quotedCells(lastComment.substr(start), separator);
    return named.size() == first.size() && !isAllNumbers(named) ? lastComment.substr(start)
                                                                : std::string_view();
  }
};

/// A table in UTF-8 without what is no table: a byte order mark, a line "sep=;", blank lines before
/// the header, and comments, which are lines that begin with # or //. A comment of as many cells as
/// the first row is the header, if that row is all numbers. Nothing if all of it is table.
///
/// Throws DataError naming file and line where a line below the header begins with # and has as
/// many cells as the header, so that nobody knows whether it is a comment.
std::optional<std::string> bareTable(
  const std::string& text, const std::string& fileName, std::vector<std::string>& notes)
{
  TextLines lines{ text };
  TableHead head(lines);
  if (head.bare && text.find("\n#") == std::string::npos && text.find("\n//") == std::string::npos)
  {
    return std::nullopt;
  }
  const char separator =
    head.said ? head.said : CSVDetectSeperator(std::string(head.header).c_str());
  std::string result;
  const auto put = [&](std::string_view row)
  { result += head.said ? csvRow(quotedCells(row, separator)) : std::string(row); };
  const RowCells first = quotedCells(head.header, separator);
  if (const std::string_view names = head.names(first, separator); !names.empty())
  {
    put(names);
    --head.comments;
  }
  put(head.header);
  // Below the header. A first cell of #1, #2, … is no comment if all rows have it.
  std::vector<std::size_t> unclear;
  std::size_t rows = 0;
  for (std::string_view line; lines.take(line);)
  {
    if (isComment(line) &&
      (first.size() == 1 || quotedCells(line, separator).size() != first.size()))
    {
      ++head.comments;
      continue;
    }
    if (isComment(line))
    {
      unclear.push_back(lines.number);
    }
    if (!isBlankLine(line))
    {
      put(line);
      ++rows;
    }
  }
  if (!unclear.empty() && unclear.size() != rows)
  {
    throw DataError(lineName(fileName, unclear.front()) +
      ": begins with # or // and has as many cells as the header: is it a comment or a row? Leave "
      "it out, or begin its first cell otherwise");
  }
  if (head.comments > 0)
  {
    notes.push_back(std::to_string(head.comments) +
      (head.comments == 1 ? " line that begins" : " lines that begin") +
      " with # or // left out as comments; rows are counted without.");
  }
  return result;
}

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
