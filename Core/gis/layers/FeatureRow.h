#pragma once

/// @file
/// One row of a layer, asked by column name: every bad cell is an error that names file, row, field
/// and value. Internal to gis/: needs GDAL's headers.

#include "base/types.h"
#include "gis/base/fields.h"

#include <ogrsf_frmts.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace rockfall::gis
{

/// Fields by one name each, and the geometry.
class FeatureRow : public Fields
{
public:
  /// `number`: of the row in the file, from 1. References are kept.
  FeatureRow(const std::string& fileName, const Columns& columns, const OGRFeature& feature,
    std::int64_t number)
    : Fields(fileName, columns, feature, number)
    , columns_(columns)
    , feature_(feature)
  {
  }

  /// About a field that is there.
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
  const Columns& columns_;
  const OGRFeature& feature_;
  mutable std::unique_ptr<OGRGeometry> straight_; ///< Of a curved geometry.
};

} // namespace rockfall::gis
