#pragma once

/// @file
/// The text of tables (CSV): its encoding, and what spreadsheets and people put before the header.

#include <optional>
#include <string>
#include <vector>

namespace rockfall::gis
{

/// Text of any encoding as UTF-8. `declared`: a name such as "ISO-8859-2" or a code page such as
/// "1250", of a .cpg file; empty: a byte order mark says it, else it is UTF-8 if all of it can be,
/// UTF-16 if it is full of zeros, and else Windows-1252, which has Latin-1 in it.
///
/// Throws DataError naming file and line: text of several encodings, bytes that are no letter of
/// its encoding, an encoding that nobody knows. `notes` gets the encoding that was assumed.
std::string asUtf8(std::string text, const std::string& declared, const std::string& fileName,
  std::vector<std::string>& notes);

/// A table in UTF-8 without what is no table: a byte order mark, a line "sep=;", blank lines before
/// the header, and comments, which are lines that begin with # or //. A comment of as many cells as
/// the first row is the header, if that row is all numbers. Nothing if all of it is table.
///
/// Throws DataError naming file and line where a line below the header begins with # and has as
/// many cells as the header, so that nobody knows whether it is a comment.
std::optional<std::string> bareTable(
  const std::string& text, const std::string& fileName, std::vector<std::string>& notes);

} // namespace rockfall::gis
