#pragma once

/// @file
/// The columns of a layer, by names as nameKey has them.

#include <map>
#include <string>
#include <vector>

class GDALDataset;
class OGRFeatureDefn;

namespace rockfall::gis
{

/// Field indices by nameKey; of two with one key only the first (see refuseTwin).
using Columns = std::map<std::string, int>;
Columns columnsOf(const OGRFeatureDefn& definition);
/// "a", "b", "c": the fields of a layer, for a message.
std::string fieldList(const OGRFeatureDefn& definition);

using ColumnNames = std::vector<const char*>;

/// Throws DataError if another column has the name of this one (nameKey).
void refuseTwin(const OGRFeatureDefn& definition, const std::string& fileName, int column);

/// Throws DataError where a column that would not be read begins as one that is not there, as
/// "capacity_kJ" or "Volume [m3]" do, is short for it, as "coh", or is a slip of it, as "ammount";
/// and where two columns have the name of one that is read. `known`: names that are read; `others`:
/// those for which only the second counts, being short, needed, or begun like by foreign columns
/// ("Shape_Area").
void refuseNearMisses(const OGRFeatureDefn& definition, const std::string& fileName,
  const ColumnNames& known, const ColumnNames& others = {});

/// One note of the columns that are not read although they sound as if they were: quantities in the
/// languages of the Alps, and columns like one that is there and read, as "capacity_kJ" beside
/// "capacity". `known` and `others` as above.
void tellUnread(const OGRFeatureDefn& definition, const std::string& fileName,
  const ColumnNames& known, const ColumnNames& others, std::vector<std::string>& notes);

/// OGR drops what stands beyond the last column of a CSV file's header, so a table whose decimal
/// commas split every number in two would be read without a word. Throws DataError naming the row;
/// does nothing for other formats.
void refuseSurplusCells(GDALDataset& dataset, const std::string& fileName);

} // namespace rockfall::gis
