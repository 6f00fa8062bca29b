#pragma once

/// @file
/// Tables as files (CSV) in a form that GDAL reads rightly.

#include <string>
#include <vector>

namespace rockfall::gis
{

/// A table as GDAL is to read it.
struct TableFile
{
  std::string path;   ///< The file's own, or one in memory.
  std::string folder; ///< In memory, to be removed when nothing reads it any more; empty: none.
};

/// `fileName` itself, unless it is a table by its ending (.csv, .tsv, .psv) whose text is not plain
/// UTF-8 from its header on (tableText.h): then a copy that is, with its .csvt and .prj beside it.
/// Throws DataError naming file and line.
TableFile readableTable(const std::string& fileName, std::vector<std::string>& notes);

} // namespace rockfall::gis
