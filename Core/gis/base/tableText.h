#pragma once

/// @file
/// Lines that spreadsheets and people put before the header of a table (CSV), and between its rows.

#include <optional>
#include <string>
#include <vector>

namespace rockfall::gis
{

/// A table in UTF-8 without what is no table: a byte order mark, a line "sep=;", blank lines before
/// the header, and comments, which are lines that begin with # or //. A comment of as many cells as
/// the first row is the header, if that row is all numbers. Nothing if all of it is table.
///
/// Throws DataError naming file and line where a line below the header begins with # and has as
/// many cells as the header, so that nobody knows whether it is a comment.
std::optional<std::string> bareTable(
  const std::string& text, const std::string& fileName, std::vector<std::string>& notes);

} // namespace rockfall::gis
