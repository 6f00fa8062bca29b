#pragma once

/// @file
/// Lines and rings of features, for every reader of them alike. Internal to gis/: needs GDAL's headers.

#include "base/Tally.h"
#include "gis/base/FeatureRow.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rockfall::gis
{

/// The lines of a feature: parts of several lines and of collections, curves as short straight
/// pieces; without parts that are empty. The row owns them. Throws DataError naming file and row if
/// there is none, or something else. `outlines`, if given, lets polygons have their outer rings
/// taken, and gets how many there were.
std::vector<const OGRLineString*> linesIn(const FeatureRow& row, std::int64_t* outlines = nullptr);

/// Polygons whose outlines cross or touch themselves: programs differ in what is inside of them.
class CrossedOutlines
{
public:
  void look(const OGRGeometry& polygon, std::int64_t row);
  void tell(const std::string& fileName, std::vector<std::string>& notes) const;

private:
  std::int64_t all_ = 0;
  Tally crossed_;
};

/// Throws DataError naming file and row if the outline of the row's polygon, or of one of them,
/// crosses or touches itself.
void requireValidPolygon(const FeatureRow& row);

/// The rings of a polygon or of several. The geometry owns them.
std::vector<const OGRLineString*> ringsIn(const OGRGeometry& geometry);

} // namespace rockfall::gis
