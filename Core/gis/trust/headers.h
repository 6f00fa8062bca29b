#pragma once

/// @file
/// Headers of files, as far as they speak of heights and GDAL leaves it out: SAGA's Z_FACTOR,
/// Z_OFFSET and UNIT, GRASS's multiplier, the $INSUNITS of a DXF drawing, Zunits and VERTCS of a
/// .prj file. Internal to gis/.

#include <map>
#include <optional>
#include <string>

class GDALDataset;

namespace rockfall::gis
{

/// Keys, lowered, and values of a text header; empty if there is none.
using Header = std::map<std::string, std::string>;

/// The .sgrd of a SAGA grid, also of one in a zip file.
Header sagaHeader(GDALDataset& dataset);
/// The lines before the numbers of a GRASS ASCII grid.
Header grassHeader(const std::string& fileName);

/// Statements of a .prj file beside the data, beyond its CRS.
struct PrjHeights
{
  std::string unit;           ///< Of a Zunits line; empty if there is none.
  double verticalShift = 0.0; ///< Of a VERTCS, which GDAL drops; in its unit.
};
PrjHeights prjHeights(GDALDataset& dataset);

/// The unit of a drawing, of its coordinates and its heights alike.
struct DrawingUnit
{
  int code = 0;                 ///< $INSUNITS; 0: unitless.
  std::string name;             ///< "feet"
  std::optional<double> metres; ///< Nothing for a code that is none.
};
/// Nothing if the file is no drawing or says nothing.
std::optional<DrawingUnit> drawingUnit(GDALDataset& dataset, const std::string& fileName);

/// The one altitudeMode of all geometries of a KML file, for GDAL without libkml, whose driver gives
/// none by feature. Throws DataError for several.
std::string kmlMode(const std::string& fileName);

} // namespace rockfall::gis
