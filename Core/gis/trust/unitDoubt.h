#pragma once

/// @file
/// Numbers without a unit beside a slope whose file declares another one than the metre. Internal to
/// gis/.

#include "gis/base/FeatureRow.h"
#include "gis/trust/heights.h"
#include "terrain/Terrain.h"

#include <string>
#include <vector>

namespace rockfall::gis
{

/// Heights and places of one layer that were taken as metres although they may be in the unit of the
/// slope's file: the first of each is told, with the way to say which it is.
class UnitDoubt
{
public:
  UnitDoubt() = default;
  UnitDoubt(const LayerHeights& layer, const FileUnits& slope);

  /// A height of a column, or of the geometry if there is no name.
  void height(const FeatureRow& row, const std::string& column, double number);
  /// Coordinates of a geometry or of the columns x and y.
  void place(const FeatureRow& row, double x, double y) { this->place(row.where(), x, y); }
  /// Of the raster, or whatever `where` names.
  void place(const std::string& where, double x, double y);
  void tell(std::vector<std::string>& notes) const;

private:
  FileUnits slope_; ///< 1 where the layer leaves no doubt.
  std::string height_, place_;
};

} // namespace rockfall::gis
