#include "mesh/tableText.h"

#include "base/text/tableText.h"
#include "mesh/words.h"

#include <algorithm>

namespace rockfall
{

namespace
{

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
    const auto says = table.lines.empty() ? separatorLine(line) : std::nullopt;
    table.separator = says.value_or(table.separator);
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
  bool any = false;
  for (std::string_view word = words.next(); !word.empty(); word = words.next(), any = true)
  {
    if (!parsedNumber(word))
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
  if (separator != ' ')
  {
    return quotedCells(line, separator);
  }
  std::vector<std::string> cells;
  Words words(line, "");
  for (std::string_view word = words.next(); !word.empty(); word = words.next())
  {
    const bool quoted = word.size() >= 2 && word.front() == '"' && word.back() == '"';
    cells.emplace_back(quoted ? trimmed(word.substr(1, word.size() - 2)) : word);
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
  const auto number = parsedNumber(word);
  if (!number)
  {
    return DecimalMark::Wrong;
  }
  value = *number;
  return comma != std::string::npos       ? DecimalMark::Comma
    : word.find('.') != std::string::npos ? DecimalMark::Point
                                          : DecimalMark::None;
}

} // namespace rockfall
