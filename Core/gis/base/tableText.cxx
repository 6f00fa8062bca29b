#include "gis/base/tableText.h"

#include "base/errors.h"
#include "base/text/plainText.h"
#include "base/text/tableText.h"

#include <cpl_csv.h>

#include <algorithm>
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

/// With commas between its cells, all of them quoted.
std::string inQuotes(const RowCells& cells)
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

bool isBlank(std::string_view line)
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
      if (!separator && !isComment(line) && !isBlank(line))
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

} // namespace

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
  { result += head.said ? inQuotes(quotedCells(row, separator)) : std::string(row); };
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
    if (!isBlank(line))
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

} // namespace rockfall::gis
