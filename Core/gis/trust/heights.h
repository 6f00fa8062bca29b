#pragma once

/// @file
/// Meaning of the numbers for heights in a file: unit, direction and reference.
/// Every reader asks here, of rasters and layers alike. Internal to gis/.
///
/// A declaration of the file is taken, and a note says so: the unit of a band, the third axis of a
/// CRS (a compound one, a 3D one, an engineering one; ESRI's VERTCS), scale and offset, netCDF's
/// `units`, `positive` and `standard_name`, SAGA's Z_FACTOR, Z_OFFSET and UNIT, GRASS's multiplier,
/// Zunits, the unit of a drawing, the end of a column's name. Two declarations that contradict each
/// other are an error. Nothing declared: metres, with a note if the coordinates are in feet.

#include "gis/base/FeatureRow.h"
#include "gis/base/crs.h"
#include "gis/base/gdal.h"

#include <string>
#include <vector>

class GDALRasterBand;

namespace rockfall::gis
{

/// Height, m upwards = number · scale + offset.
struct Heights
{
  double scale = 1.0;
  double offset = 0.0;
  double unit = 1.0; ///< m per unit that is declared; 1 if none is.
  CrsPtr reference;  ///< See heightCrs; null if nothing says what they refer to.

  double metres(double number) const { return number * scale + offset; }
};

/// Of a band of a raster; what is done is added to `notes`. Throws DataError naming file, band and
/// unit for a unit that is not known and for declarations that contradict each other.
Heights heightsOf(GDALDataset& dataset, GDALRasterBand& band, const std::string& fileName,
  std::vector<std::string>& notes);

/// Of a layer: its coordinates, and its heights where it has any.
struct LayerHeights : Heights
{
  double plane = 1.0;           ///< m per unit of coordinates that are local ones; else 1.
  CrsPtr horizontal;            ///< Null for local coordinates.
  std::string note;             ///< To be told where heights are read; empty if they are metres.
  std::string doubt;            ///< To be told where heights are read that may be feet; else empty.
  bool kml = false;             ///< Each feature says what its altitude is over; see altitudeOf.
  bool heightsDeclared = false; ///< Whether the CRS or the format says the unit of heights.
  bool planeDeclared = false;   ///< The same of coordinates.
  /// altitudeMode of features that do not give it.
  std::string kmlMode = "clamptoground";

  /// Of a column, by the unit in its name (base/text/columnName.h); else as all of them.
  Heights ofColumn(const std::string& name) const;
  /// Adds `note` and `doubt` to the notes.
  void tell(std::vector<std::string>& notes) const;
};

/// `notes` gets what is done to local coordinates.
LayerHeights heightsOf(GDALDataset& dataset, OGRLayer& layer, const std::string& fileName,
  std::vector<std::string>& notes);

/// Reference of the altitude of a feature of a KML file, by its altitudeMode.
enum class Altitude
{
  Datum,  ///< Absolute, as in all other files.
  Ground, ///< Relative to the ground.
  None,   ///< Clamped to the ground, which is KML's default: it says nothing.
};
Altitude altitudeOf(const LayerHeights& heights, const FeatureRow& row);

} // namespace rockfall::gis
