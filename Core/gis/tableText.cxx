#include "gis/tableText.h"

#include "base/errors.h"
#include "base/nameKey.h"
#include "gis/fields.h"

#include <cpl_csv.h>
#include <unicode/ucnv.h>
#include <unicode/unistr.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string_view>

namespace rockfall::gis
{

namespace
{

constexpr char western[] = "windows-1252";

std::string lineName(const std::string& fileName, std::size_t line)
{
  return fileName + ", line " + std::to_string(line);
}

/// Number of the line of a byte, from 1.
std::size_t lineAt(std::string_view text, std::size_t byte)
{
  return 1 + std::size_t(std::count(text.begin(), text.begin() + std::ptrdiff_t(byte), '\n'));
}

bool isAscii(char c)
{
  return (c & 0x80) == 0;
}

/// The first of the lines that is not UTF-8, 0 if all are; and whether any has letters beyond ASCII
/// that are.
struct Utf8Lines
{
  std::size_t firstBad = 0;
  bool someGood = false;

  explicit Utf8Lines(std::string_view text)
  {
    std::size_t number = 0;
    while (!text.empty())
    {
      const auto end = std::min(text.find('\n'), text.size() - 1) + 1;
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(end);
      ++number;
      if (std::all_of(line.begin(), line.end(), isAscii))
      {
        continue;
      }
      const bool good = isUtf8(line);
      someGood = someGood || good;
      firstBad = !good && firstBad == 0 ? number : firstBad;
    }
  }
};

std::string fromConverter(
  const std::string& text, const std::string& encoding, const std::string& fileName)
{
  UErrorCode status = U_ZERO_ERROR;
  const std::unique_ptr<UConverter, void (*)(UConverter*)> converter(
    ucnv_open(encoding.c_str(), &status), ucnv_close);
  if (U_FAILURE(status))
  {
    throw DataError(
      fileName + ": its .cpg file says the encoding \"" + encoding + "\", which is not known");
  }
  // Line by line, so that a byte that is no letter is found.
  std::string result;
  std::size_t number = 0;
  const bool lines = ucnv_getMinCharSize(converter.get()) == 1;
  ucnv_setToUCallBack(converter.get(), UCNV_TO_U_CALLBACK_STOP, nullptr, nullptr, nullptr, &status);
  for (std::size_t first = 0; first < text.size();)
  {
    const auto end = lines ? std::min(text.find('\n', first), text.size() - 1) + 1 : text.size();
    ++number;
    ucnv_resetToUnicode(converter.get());
    const icu::UnicodeString decoded(
      text.data() + first, int32_t(end - first), converter.get(), status);
    // U+0080 to U+009F are letters of no text: ICU gives them for bytes that an encoding leaves
    // free.
    bool letters = U_SUCCESS(status);
    for (int32_t k = 0; k < decoded.length() && letters; ++k)
    {
      letters = decoded[k] < 0x80 || decoded[k] > 0x9f;
    }
    if (!letters)
    {
      throw DataError(lineName(fileName, number) + ": is neither UTF-8 nor text in " + encoding +
        "; save the table as UTF-8, or name its encoding in a .cpg file beside it");
    }
    decoded.toUTF8String(result);
    first = end;
  }
  return result;
}

std::string fromUtf16(std::string_view text, bool bigEnd)
{
  icu::UnicodeString units;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
  {
    const auto one = std::uint8_t(text[i]), two = std::uint8_t(text[i + 1]);
    units.append(char16_t(bigEnd ? one << 8 | two : two << 8 | one));
  }
  std::string result;
  return units.toUTF8String(result);
}

std::string fromUtf32(std::string_view text, bool bigEnd)
{
  icu::UnicodeString units;
  for (std::size_t i = 0; i + 3 < text.size(); i += 4)
  {
    std::uint32_t code = 0;
    for (std::size_t k = 0; k < 4; ++k)
    {
      code = code << 8 | std::uint8_t(text[i + (bigEnd ? k : 3 - k)]);
    }
    units.append(UChar32(std::min<std::uint32_t>(code, 0xfffd)));
  }
  std::string result;
  return units.toUTF8String(result);
}

/// The word about a byte.
std::string wordAt(const std::string& text, std::size_t byte)
{
  const char* const ends = " \t\r\n,;\"|";
  const auto before = text.find_last_of(ends, byte);
  const auto first = before == std::string::npos ? 0 : before + 1;
  return text.substr(first, text.find_first_of(ends, byte) - first);
}

/// Throws if signs stand within words, as ” does in H”hle: the text is of another code page.
void refuseSignsInWords(const std::string& text, const std::string& fileName)
{
  const auto letter = [](char c)
  { return !isAscii(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (const std::string sign : { "„", "…", "†", "‡", "ˆ", "‰", "‹", "“", "”", "•", "˜", "™", "›" })
  {
    for (auto at = text.find(sign); at != std::string::npos; at = text.find(sign, at + 1))
    {
      const auto after = at + sign.size();
      if (at > 0 && after < text.size() && letter(text[at - 1]) && letter(text[after]))
      {
        throw DataError(lineName(fileName, lineAt(text, at)) + ": is not UTF-8, and \"" +
          wordAt(text, at) +
          "\", as it is in Windows-1252, is no word; save the table as UTF-8, or name its encoding "
          "in a .cpg file beside it");
      }
    }
  }
}

/// Little end (even) or big end (odd) of UTF-16 without a mark; −1: it is none.
int unmarkedUtf16(std::string_view text)
{
  std::size_t zeros[2] = { 0, 0 };
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    zeros[i % 2] += text[i] == '\0';
  }
  const std::size_t half = text.size() / 2;
  return zeros[1] > half * 6 / 10 && zeros[0] == 0 ? 0
    : zeros[0] > half * 6 / 10 && zeros[1] == 0    ? 1
                                                   : -1;
}

std::string decoded(std::string text, const std::string& declared, const std::string& fileName,
  std::vector<std::string>& notes)
{
  const std::string_view view = text;
  using namespace std::string_view_literals;
  if (view.starts_with("\xff\xfe\0\0"sv) || view.starts_with("\0\0\xfe\xff"sv))
  {
    return fromUtf32(view.substr(4), view.starts_with("\0\0\xfe\xff"sv));
  }
  if (view.starts_with("\xff\xfe"sv) || view.starts_with("\xfe\xff"sv))
  {
    return fromUtf16(view.substr(2), view[0] == '\xfe');
  }
  if (view.starts_with("\xef\xbb\xbf"sv))
  {
    text.erase(0, 3);
  }
  else if (const int end = unmarkedUtf16(view); end >= 0)
  {
    notes.push_back("The table's text is UTF-16 without a mark that says so.");
    return fromUtf16(view, end == 1);
  }
  if (const auto zero = text.find('\0'); zero != std::string::npos)
  {
    throw DataError(lineName(fileName, lineAt(text, zero)) +
      ": holds a byte 0, which no text does; save the table as UTF-8");
  }
  const Utf8Lines utf8(text);
  if (utf8.firstBad == 0)
  {
    return text;
  }
  if (!declared.empty() && nameKey(declared) != "utf-8" && nameKey(declared) != "65001")
  {
    const bool page = declared.find_first_not_of("0123456789") == std::string::npos;
    return fromConverter(text, (page ? "cp" : "") + declared, fileName);
  }
  if (utf8.someGood)
  {
    throw DataError(lineName(fileName, utf8.firstBad) +
      ": is not UTF-8 as others are; save the table in one encoding, UTF-8");
  }
  std::string result = fromConverter(text, western, fileName);
  refuseSignsInWords(result, fileName);
  const auto first =
    std::size_t(std::find_if_not(result.begin(), result.end(), isAscii) - result.begin());
  notes.push_back("The table is not UTF-8; it was read as Windows-1252 (Latin-1): line " +
    std::to_string(utf8.firstBad) + " has \"" + wordAt(result, first) +
    "\". A .cpg file beside it can name another encoding.");
  return result;
}

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

/// Cells without their quotes and the blanks about them.
RowCells cellsOf(std::string_view line, char separator)
{
  RowCells cells(1);
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i)
  {
    const char c = line[i];
    if (c == '"' && inside && i + 1 < line.size() && line[i + 1] == '"')
    {
      cells.back() += line[i++];
    }
    else if (c == '"')
    {
      inside = !inside;
    }
    else if (c == separator && !inside)
    {
      cells.emplace_back();
    }
    else
    {
      cells.back() += c;
    }
  }
  std::transform(cells.begin(), cells.end(), cells.begin(), trimmed);
  return cells;
}

bool isAllNumbers(const RowCells& cells)
{
  const auto isEmpty = [](const std::string& cell) { return cell.empty(); };
  return std::count_if(cells.begin(), cells.end(), isEmpty) < std::ptrdiff_t(cells.size()) - 1 &&
    std::all_of(cells.begin(), cells.end(),
      [&](const std::string& cell) { return isEmpty(cell) || parsed(cell); });
}

/// The separator of a line "sep=;", if it is one.
std::optional<char> separatorLine(std::string_view line)
{
  std::string text(line.substr(0, line.find_last_not_of("\r\n") + 1));
  text.erase(std::remove(text.begin(), text.end(), '"'), text.end());
  return text.size() == 5 && nameKey(text).starts_with("sep=") ? std::optional(text[4])
    : nameKey(text) == "sep="                                  ? std::optional('\t')
                                                               : std::nullopt;
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

/// What comes before the rows.
struct TableHead
{
  std::optional<char> said; ///< The separator, by a line of its own.
  std::string_view header, lastComment;
  std::size_t comments = 0;
  bool bare = true; ///< There is nothing but the header.

  explicit TableHead(TextLines& lines)
  {
    for (std::string_view line; header.empty() && lines.take(line);)
    {
      const auto separator = said ? std::nullopt : separatorLine(line);
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
    const RowCells named = cellsOf(lastComment.substr(start), separator);
    return named.size() == first.size() && !isAllNumbers(named) ? lastComment.substr(start)
                                                                : std::string_view();
  }
};

} // namespace

std::string asUtf8(std::string text, const std::string& declared, const std::string& fileName,
  std::vector<std::string>& notes)
{
  std::string result = decoded(std::move(text), trimmed(declared), fileName, notes);
  // Of UTF-16 as well.
  if (result.starts_with("\xef\xbb\xbf"))
  {
    result.erase(0, 3);
  }
  return result;
}

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
    head.said ? *head.said : CSVDetectSeperator(std::string(head.header).c_str());
  std::string result;
  const auto put = [&](std::string_view row)
  { result += head.said ? inQuotes(cellsOf(row, separator)) : std::string(row); };
  const RowCells first = cellsOf(head.header, separator);
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
    if (isComment(line) && (first.size() == 1 || cellsOf(line, separator).size() != first.size()))
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
