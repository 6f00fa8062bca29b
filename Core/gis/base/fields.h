#pragma once

/// @file
/// The fields of a layer's features as text and numbers, by names as nameKey has them.

#include "base/text/plainText.h"

#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <vector>

class GDALDataset;
class OGRFeature;
class OGRFeatureDefn;

namespace rockfall::gis
{

class Messages;

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

/// A feature of a layer. Errors are DataError and name file, row (from 1), field and value.
class Fields
{
public:
  Fields(const std::string& fileName, const Columns& columns, const OGRFeature& feature,
    std::int64_t row);

  const std::string& fileName() const { return fileName_; }
  /// File and row, as messages begin.
  std::string where() const { return fileName_ + ", row " + std::to_string(row_); }
  [[noreturn]] void fail(const std::string& what) const;
  /// Fails with what was said when the row was read if a word was lost: OGR only warns where a
  /// typed table (.csvt) holds text in a column of numbers, and gives 0.
  void refuseLostText(const Messages& messages) const;
  /// Of the first of these names that has a value; empty cells are as good as no column. Fails if
  /// another one of them has another value.
  std::optional<std::string> text(std::initializer_list<const char*> names) const;
  std::optional<double> number(std::initializer_list<const char*> names) const;
  /// From `low` to `high`, "it must be `range`".
  std::optional<double> ranged(
    std::initializer_list<const char*> names, double low, double high, const char* range) const;
  std::optional<double> numberAt(int column) const;
  std::optional<std::string> textAt(int column) const;

private:
  std::optional<int> columnOf(std::initializer_list<const char*> names) const;
  std::string nameOf(int column) const;
  /// Whether it is true or false, of which GDAL makes 1 and 0, in GeoJSON beside numbers as well.
  bool isTruth(int column) const;

  const std::string& fileName_;
  const Columns& columns_;
  const OGRFeature& feature_;
  std::int64_t row_;
};

} // namespace rockfall::gis
