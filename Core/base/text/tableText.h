#pragma once

/// @file
/// The text of tables, of attributes and of points alike: its encoding and its cells.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rockfall
{

/// File and line, from 1, as messages begin.
std::string lineName(const std::string& fileName, std::size_t line);

/// Text of any encoding as UTF-8. `declared`: a name such as "ISO-8859-2" or a code page such as
/// "1250", of a .cpg file; empty: a byte order mark says it, else it is UTF-8 if all of it can be,
/// UTF-16 if it is full of zeros, and else Windows-1252, which has Latin-1 in it.
///
/// Throws DataError naming file and line: text of several encodings, bytes that are no letter of
/// its encoding, an encoding that nobody knows. `notes` gets the encoding that was assumed.
std::string asUtf8(std::string text, const std::string& declared, const std::string& fileName,
  std::vector<std::string>& notes);

/// The cells of a line, without their quotes and the blanks about them. A separator in quotes parts
/// nothing; two quotes in quotes are one of the cell's own.
std::vector<std::string> quotedCells(std::string_view line, char separator);

/// The separator of a line "sep=;" as spreadsheets write it, in quotes or not (nothing behind the
/// sign of equality: a tab); nothing if it is another line.
std::optional<char> separatorLine(std::string_view line);

} // namespace rockfall
