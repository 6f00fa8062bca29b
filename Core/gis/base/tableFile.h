#pragma once

/// @file
/// Tables as files (CSV) and GML in a form that GDAL reads rightly.

#include <string>
#include <vector>

namespace rockfall::gis
{

/// A table as GDAL is to read it.
struct TableFile
{
  std::string path;   ///< The file's own, or one in memory.
  std::string folder; ///< In memory, to be removed when nothing reads it any more; empty: none.
  std::string schema = {}; ///< Text of the .gfs beside GML, which is not read.
};

/// `fileName` itself, unless it is a table by its ending (.csv, .tsv, .psv) whose text is not plain
/// UTF-8, or not table from its first line on: then a copy that is, with its .csvt and .prj beside
/// it. GML is copied without the .gfs and .xsd beside it: GDAL would take fields, types and the CRS
/// from these, and write a .gfs there. Throws DataError naming file and line.
TableFile readableTable(const std::string& fileName, std::vector<std::string>& notes);

/// A note if the .gfs beside GML says otherwise than the one that GDAL has made of it anew.
void tellSchema(
  const TableFile& table, const std::string& fileName, std::vector<std::string>& notes);

} // namespace rockfall::gis
