#pragma once

/// @file
/// Rockfall sources from OGR layers of points, lines and polygons and from CSV tables.

#include "base/VolumeDistribution.h"
#include "base/types.h"
#include "geometry/ShapeMix.h"
#include "terrain/Terrain.h"

#include <optional>
#include <string>
#include <vector>

namespace rockfall
{

enum class SourceGeometry
{
  Point,
  Line,
  Polygon
};

/// A row of a source layer. Fields that the layer does not have stay empty; the caller has the
/// defaults.
struct SourceRow
{
  std::int64_t row = 0; ///< In the file, from 1 (not counting a header).
  SourceGeometry geometry = SourceGeometry::Point;
  /// Of a point: world coordinates of the blocks' centre, m; z is NaN if nothing says it.
  Vec3 position = Vec3::Zero();
  /// Of lines and polygons: corners of the lines or of all rings, world coordinates, m; z is NaN
  /// if nothing says it.
  std::vector<std::vector<Vec3>> parts;
  std::optional<double> height; ///< Over ground, m, ≥ 0; goes before any z.

  std::optional<std::int64_t> sourceId;
  std::string sourceName;             ///< Empty if it is not said.
  std::optional<std::int64_t> amount; ///< Of rocks, ≥ 0.
  std::optional<double> intensity; ///< Rocks per m of a line, per m² of a polygon, in plan, ≥ 0.

  /// How often a rock of the source falls, one of three: 1/a; 1/a per hectare of a polygon, in plan;
  /// A of F(V) = A V^−B, 1/a and V in m³, between the bounds and with the exponent of its volumes.
  std::optional<double> frequency, frequencyPerHectare, frequencyA;

  std::optional<ShapeMix> shapes;
  std::optional<double> volume; ///< m³
  std::optional<VolumeLaw> volumeLaw;
  std::optional<double> volumeDeviation, volumeMinimum, volumeMaximum; ///< m³
  std::optional<double> volumeExponent;
  std::string material;                ///< Name of a RockMaterial; empty if it is not said.
  std::string materialName;            ///< For contacts of rocks; empty if it is not said.
  std::optional<double> density;       ///< kg/m³
  std::optional<double> youngModulus;  ///< Pa
  std::optional<double> poissonRatio;  ///< Dimensionless.
  std::optional<Vec3> velocity;        ///< m/s
  std::optional<Vec3> angularVelocity; ///< rad/s
  std::optional<Vec3> orientation;     ///< Degrees, as the source's `Orientation`.
  std::optional<Vec3> lengths;         ///< Box edges, m.

  std::optional<double> horizontalDeviation, verticalDeviation; ///< Per iteration, m, ≥ 0.
  std::optional<double> attitudeDeviation;                      ///< Per iteration, degrees, ≥ 0.
  bool randomAttitude = false;                                  ///< Per iteration any attitude.

  bool operator==(const SourceRow&) const = default;
};

/// How a source layer is to be read.
struct SourceOptions
{
  /// WKT or "EPSG:n": what has a CRS is brought to it, heights to its vertical part if both have
  /// one. Empty: coordinates are taken as they are.
  std::string targetCrs;
  /// By name (gis/layers/LayerFile.h); empty: the one that will do.
  std::string layer = {};
  /// There is a terrain to stand on: z may be missing.
  bool haveTerrain = false;
  FileUnits terrainUnits = {}; ///< Of the terrain's file.
  /// More rows are an error, and so are more rocks.
  std::int64_t mostRocks = 1000000;
};

/// Statements of a layer as a whole.
struct SourceLayer
{
  std::vector<SourceRow> rows;
  /// WKT of the CRS in which the positions are: the target if there is one, else that of the layer
  /// if all rows have a geometry of their own, else nothing.
  std::string crs;
  /// The layer's own CRS by name, for messages; empty if it has none.
  std::string ownCrs;
  std::vector<std::string> notes; ///< One sentence per thing that was done to the data.
};

/// Reads one layer of anything OGR opens. Columns are listed in docs/sources.md, without
/// regard to upper and lower case; other columns are ignored, and an empty cell is as good as no
/// column. Points, lines and polygons; multipoints of one point; rows of a table without geometry
/// have x, y and z. Where a geometry has its own z, that goes before the column z (or z_m, z_ft).
/// Heights become metres upwards, and those of the target's vertical datum; where the target or the
/// layer does not say what its heights refer to, they are taken as they are. Of KML, altitudeMode
/// says what an altitude is over. A note tells rows that release the same rocks at one place.
///
/// Throws FileError (missing, a folder, a raster, unreadable) or DataError naming file, row, field
/// and value. Prints nothing; safe on several threads at once.
SourceLayer readSourceLayer(const std::string& fileName, const SourceOptions& options);

/// Throws DataError, which begins with `name`, if the outline of an area (x and y, closed or not)
/// crosses or touches itself, as readSourceLayer does of a polygon. Prints nothing.
void requireValidOutline(const std::vector<Vec3>& corners, const std::string& name);

/// WKT2:2019 on one line of a CRS given as "EPSG:n", WKT or PROJ string, with its vertical part, if
/// it has one, in metres upwards; empty for empty text.
/// Throws DataError naming the text. Prints nothing.
std::string wktOfCrs(const std::string& text);

/// "EPSG:32632 (WGS 84 / UTM zone 32N)", for messages; empty for empty text.
std::string labelOfCrs(const std::string& text);

/// Whether two CRS (WKT or "EPSG:n") have the same horizontal part; an empty one is that of all.
bool sameCrs(const std::string& one, const std::string& other);

/// Datums of the heights of two CRS (WKT or "EPSG:n"), "a and b", if both say it and it is not
/// the same; else empty.
std::string differentHeights(const std::string& one, const std::string& other);

} // namespace rockfall
