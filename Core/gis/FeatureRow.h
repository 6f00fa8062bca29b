#pragma once

/// @file
/// One row of a layer, asked by column name: every bad cell is an error that names file, row, field
/// and value. Internal to gis/: needs GDAL's headers.

#include "base/types.h"

#include <ogrsf_frmts.h>

#include <array>
#include <map>
#include <optional>
#include <string>

namespace rockfall::gis
{

/// Column names in small letters, to their numbers.
using Columns = std::map<std::string, int>;
Columns columnsOf(const OGRFeatureDefn& definition);

/// Without blanks at either end.
std::string trimmed(const std::string& text);

class FeatureRow
{
public:
  /// `number`: of the row in the file, from 1. References are kept.
  FeatureRow(const std::string& fileName, const Columns& columns, const OGRFeature& feature,
    std::int64_t number)
    : fileName_(fileName)
    , columns_(columns)
    , feature_(feature)
    , number_(number)
  {
  }

  [[noreturn]] void fail(const std::string& what) const;
  /// The same, about a field that is there.
  [[noreturn]] void failField(const std::string& name, const std::string& what) const;

  bool has(const std::string& name) const { return columns_.count(name) > 0; }
  /// Empty cells are as good as none.
  std::optional<std::string> text(const std::string& name) const;
  std::optional<double> number(const std::string& name) const; ///< Finite.
  std::optional<double> positive(const std::string& name) const;
  std::optional<double> notNegative(const std::string& name) const;
  std::optional<std::int64_t> count(const std::string& name) const; ///< Whole, ≥ 0.
  double needed(const std::string& name) const;
  /// Empty if none of the three is there; else those that are not there are 0.
  std::optional<Vec3> vector(const std::array<const char*, 3>& names) const;
  /// All or none of lx, ly, lz.
  std::optional<Vec3> lengths() const;

  /// The feature's geometry, curves as lines; null if there is none.
  const OGRGeometry* geometry() const;

private:
  const std::string& fileName_;
  const Columns& columns_;
  const OGRFeature& feature_;
  std::int64_t number_;
  mutable std::unique_ptr<OGRGeometry> straight_; ///< Of a curved geometry.
};

} // namespace rockfall::gis
