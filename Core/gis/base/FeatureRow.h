#pragma once

/// @file
/// One row of a layer, asked by column name (nameKey): every bad cell is a DataError that names
/// file, row, field and value. Internal to gis/: needs GDAL's headers.

#include "base/types.h"
#include "gis/base/fields.h"

#include <ogrsf_frmts.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>

namespace rockfall::gis
{

class Messages;

class FeatureRow
{
public:
  /// `row`: of the feature in the file, from 1. References are kept.
  FeatureRow(const std::string& fileName, const Columns& columns, const OGRFeature& feature,
    std::int64_t row);

  const std::string& fileName() const { return fileName_; }
  /// File and row, as messages begin.
  std::string where() const { return fileName_ + ", row " + std::to_string(row_); }
  [[noreturn]] void fail(const std::string& what) const;
  /// About a field that is there.
  [[noreturn]] void failField(const std::string& name, const std::string& what) const;
  /// About a field without a value: an empty cell, or no such column in what the file is `of`.
  [[noreturn]] void failAbsent(
    const std::string& name, const std::string& rest, const char* of = "layer") const;
  /// Fails with what was said when the row was read if a word was lost: OGR only warns where a
  /// typed table (.csvt) holds text in a column of numbers, and gives 0.
  void refuseLostText(const Messages& messages) const;

  bool has(const std::string& name) const { return columns_.count(name) > 0; }
  /// The value of the first of these names that has one; empty cells are as good as no column.
  /// Fails if another one of them has another value.
  std::optional<std::string> text(std::initializer_list<const char*> names) const;
  std::optional<std::string> text(const char* name) const { return this->text({ name }); }
  std::optional<double> number(std::initializer_list<const char*> names) const; ///< Finite.
  std::optional<double> number(const char* name) const { return this->number({ name }); }
  /// A number from `low` to `high`, "it must be `range`".
  std::optional<double> ranged(
    std::initializer_list<const char*> names, double low, double high, const char* range) const;
  std::optional<double> positive(const char* name) const;
  std::optional<double> notNegative(const char* name) const;
  std::optional<std::int64_t> count(const char* name) const; ///< Whole, ≥ 0.
  double needed(const char* name) const;
  /// Empty if none of the three is there; else those that are not there are 0.
  std::optional<Vec3> vector(const std::array<const char*, 3>& names) const;
  /// All or none of lx, ly, lz.
  std::optional<Vec3> lengths() const;
  std::optional<double> numberAt(int column) const;
  std::optional<std::string> textAt(int column) const;

  /// The feature's geometry, curves as lines, always the same one: it lives as long as the row and
  /// its feature. Null if there is none.
  const OGRGeometry* geometry() const;

private:
  std::optional<int> columnOf(std::initializer_list<const char*> names) const;
  std::string nameOf(int column) const;
  /// Whether a column is of truths, of which GDAL makes 1 and 0, in GeoJSON beside numbers as well.
  bool isTruth(int column) const;

  const std::string& fileName_;
  const Columns& columns_;
  const OGRFeature& feature_;
  std::int64_t row_;
  mutable std::unique_ptr<OGRGeometry> straight_; ///< Of a curved geometry, once asked for.
};

} // namespace rockfall::gis
