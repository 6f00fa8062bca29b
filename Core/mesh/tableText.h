#pragma once

/// @file
/// Lines and cells of a table of points: comments, what parts the columns, decimals. Its encoding:
/// base/text/tableText.h.

#include <string>
#include <string_view>
#include <vector>

namespace rockfall
{

/// A line that is neither empty nor a comment.
struct TableLine
{
  std::string_view text;
  int number = 0; ///< From 1.
};

struct TableLines
{
  std::vector<TableLine> lines;
  std::string_view comment; ///< The last one before the first line, without its mark.
  char separator = '\0';    ///< Separator of a line sep=;
};
/// `text` must outlive the result.
TableLines splitLines(std::string_view text);

/// Whether all that stands between blanks, commas and semicolons are numbers.
bool isNumeric(std::string_view line);

/// Separator of the columns of a line: ';', '\t', ',' or ' ' for any number of blanks; '\0' if
/// nobody can tell, as of 1,5, 2,5, 3,5.
char separatorOf(std::string_view line);

/// Trimmed and without quotes.
std::vector<std::string> splitCells(std::string_view line, char separator);

enum class DecimalMark
{
  None,
  Point,
  Comma,
  Wrong ///< No number.
};
/// The number of a cell and what it has for its decimal mark. `word` becomes the number with a
/// point.
DecimalMark parseCell(const std::string& cell, std::string& word, double& value);

} // namespace rockfall
