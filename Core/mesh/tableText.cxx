#include "mesh/tableText.h"

#include "base/errors.h"
#include "mesh/words.h"

#include <algorithm>

namespace rockfall
{

namespace
{

/// Appends a code point of the basic plane, or a half of a pair as "?": coordinates have none.
void appendUtf8(std::string& text, unsigned code)
{
  if (code < 0x80)
  {
    text += char(code);
  }
  else if (code < 0x800)
  {
    text += char(0xC0 | code >> 6);
    text += char(0x80 | (code & 0x3F));
  }
  else if (code >= 0xD800 && code < 0xE000)
  {
    text += '?';
  }
  else
  {
    text += char(0xE0 | code >> 12);
    text += char(0x80 | (code >> 6 & 0x3F));
    text += char(0x80 | (code & 0x3F));
  }
}

std::string fromUtf16(std::string_view bytes, bool big)
{
  std::string text;
  for (std::size_t k = 2; k + 1 < bytes.size(); k += 2)
  {
    const unsigned first = static_cast<unsigned char>(bytes[k]);
    const unsigned second = static_cast<unsigned char>(bytes[k + 1]);
    appendUtf8(text, big ? first << 8 | second : second << 8 | first);
  }
  return text;
}

/// Length of the mark that makes a comment of the line; 0 if it is none.
std::size_t commentMark(std::string_view line)
{
  return line.substr(0, 2) == "//"                        ? 2
    : !line.empty() && (line[0] == '#' || line[0] == '%') ? 1
                                                          : 0;
}

bool hasInnerBlank(std::string_view line, char separator)
{
  const std::vector<std::string> cells = splitCells(line, separator);
  return std::any_of(cells.begin(), cells.end(),
    [](const std::string& cell) { return cell.find(' ') != std::string::npos; });
}

} // namespace

std::string decodeText(std::string_view bytes, const std::string& name)
{
  std::string text;
  const std::string_view mark = bytes.substr(0, 2);
  if (bytes.substr(0, 3) == "\xEF\xBB\xBF")
  {
    text = bytes.substr(3);
  }
  else if (mark == "\xFF\xFE" || mark == "\xFE\xFF")
  {
    text = fromUtf16(bytes, mark == "\xFE\xFF");
  }
  else
  {
    text = bytes;
  }
  const std::size_t zero = text.find('\0');
  if (zero != std::string::npos)
  {
    throw FileError(name + ", line " +
      std::to_string(1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(zero), '\n')) +
      ": is no text, or UTF-16 without a byte order mark: save it as UTF-8");
  }
  return text;
}

TableLines splitLines(std::string_view text)
{
  TableLines table;
  for (int number = 1; !text.empty(); ++number)
  {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end);
    text.remove_prefix(text.substr(0, 2) == "\r\n" ? 2 : text.empty() ? 0 : 1);
    const std::size_t mark = commentMark(line);
    if (mark > 0 && table.lines.empty())
    {
      table.comment = trimmed(line.substr(mark));
    }
    const bool says =
      table.lines.empty() && line.size() >= 5 && lowerCase(line.substr(0, 4)) == "sep=";
    if (says)
    {
      table.separator = line[4];
    }
    if (mark == 0 && !says && !line.empty())
    {
      table.lines.push_back({ line, number });
    }
  }
  return table;
}

bool isNumeric(std::string_view line)
{
  std::string plain(line);
  for (char& c : plain)
  {
    c = c == ',' || c == ';' || c == '"' ? ' ' : c;
  }
  Words words(plain, "");
  double value = 0.0;
  bool any = false;
  for (std::string_view word = words.next(); !word.empty(); word = words.next(), any = true)
  {
    if (!parseNumber(word, value))
    {
      return false;
    }
  }
  return any;
}

char separatorOf(std::string_view line)
{
  if (line.find(';') != std::string_view::npos)
  {
    return ';';
  }
  if (line.find('\t') != std::string_view::npos)
  {
    // Names of several words need the tabs; else blanks and tabs are alike.
    return hasInnerBlank(line, '\t') && !isNumeric(line) ? '\t' : ' ';
  }
  if (line.find(',') == std::string_view::npos)
  {
    return ' ';
  }
  if (!isNumeric(line) || line.find(' ') == std::string_view::npos ||
    line.find('"') != std::string_view::npos)
  {
    return ',';
  }
  // Numbers, commas and blanks: every comma has a blank behind it, or none has.
  std::size_t ends = 0, inner = 0;
  for (std::size_t k = 0; k < line.size(); ++k)
  {
    const bool atEnd = k + 1 == line.size() || line[k + 1] == ' ';
    const bool atStart = k > 0 && line[k - 1] == ' ';
    (atEnd || atStart ? ends : inner) += line[k] == ',' ? 1 : 0;
  }
  return ends == 0 ? ' ' : inner == 0 ? ',' : '\0';
}

std::vector<std::string> splitCells(std::string_view line, char separator)
{
  std::vector<std::string> cells;
  if (separator == ' ')
  {
    Words words(line, "");
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
    {
      cells.emplace_back(word);
    }
  }
  else
  {
    bool inQuotes = false;
    std::string cell;
    const auto finish = [&]
    {
      cells.emplace_back(trimmed(cell));
      cell.clear();
    };
    for (const char c : line)
    {
      inQuotes = c == '"' ? !inQuotes : inQuotes;
      if (c == separator && !inQuotes)
      {
        finish();
      }
      else
      {
        cell += c;
      }
    }
    finish();
  }
  for (std::string& cell : cells)
  {
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
    {
      cell = trimmed(std::string_view(cell).substr(1, cell.size() - 2));
    }
  }
  return cells;
}

DecimalMark parseCell(const std::string& cell, std::string& word, double& value)
{
  word = cell;
  const std::size_t comma = word.find(',');
  if (comma != std::string::npos)
  {
    if (word.find(',', comma + 1) != std::string::npos || word.find('.') != std::string::npos)
    {
      return DecimalMark::Wrong; // parts thousands
    }
    word[comma] = '.';
  }
  if (!parseNumber(word, value))
  {
    return DecimalMark::Wrong;
  }
  return comma != std::string::npos       ? DecimalMark::Comma
    : word.find('.') != std::string::npos ? DecimalMark::Point
                                          : DecimalMark::None;
}

} // namespace rockfall
