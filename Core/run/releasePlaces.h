#pragma once

/// @file
/// From sources to the places of single rocks: so many at each point, along each line, in each
/// polygon, or where the terrain is steep.

#include "gis/layers/sources.h"
#include "terrain/Terrain.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace rockfall
{

/// Defaults of sources that do not say otherwise.
struct ReleaseDefaults
{
  std::int64_t amount = 1; ///< Rocks of a source, ≥ 1.
  /// Rocks per m of lines and m² of polygons and steep cells, in plan; 0: `amount` counts.
  double intensity = 0.0;
  double height = 0.0;   ///< Of the rocks over ground where that is their height, m, ≥ 0.
  bool onGround = false; ///< All rocks stand over the ground, whatever z says.
  /// Points are spread over a disc of this radius if their rocks stand over the ground, else over a
  /// ball, m, ≥ 0.
  double clusterRadius = 0.0;
  std::uint64_t seed = 1; ///< With row and number of the rock it decides every random number.
  std::int64_t mostRocks = 1000000;

  void validate() const; ///< Throws ParameterError naming field and value.
};

/// Where one rock is released.
struct ReleasePlace
{
  std::size_t source = 0; ///< Index in the list of sources.
  /// Number for this rock's random draws: of its row and of it in the row.
  std::uint64_t draw = 0;
  Vec3 position = Vec3::Zero(); ///< World coordinates, m; z counts unless `overGround`.
  bool overGround = false;
  double height = 0.0; ///< Over ground, m.
};

/// Why there is no CFE under a place (world coordinates, m), to follow its name in a message.
std::string whyNoGround(const Terrain& terrain, double x, double y);

/// Throws DataError, naming both extents, if no source can be on the terrain. `layer` is the file's
/// name, `layerCrs` its CRS by name or empty.
void requireOverlap(std::span<const SourceRow> sources, const Terrain& terrain,
  const std::string& layer, const std::string& layerCrs);

/// The places of all rocks, in the order of the sources. The number by an intensity is its whole
/// part, and one more with the probability of the rest; of lines and polygons that reach beyond the
/// terrain only the rocks on it are made, and all of an amount are put on it. `terrain` may be
/// null. Throws DataError or ParameterError, naming `layer` and row.
std::vector<ReleasePlace> releasePlaces(std::span<const SourceRow> sources, const Terrain* terrain,
  const ReleaseDefaults& defaults, const std::string& layer);

/// Other places for rocks of the same sources.
class PlaceRedrawer
{
public:
  /// Keeps references. `terrain` may be null.
  PlaceRedrawer(std::span<const SourceRow> sources, const Terrain* terrain,
    const ReleaseDefaults& defaults, const std::string& layer);
  ~PlaceRedrawer();
  PlaceRedrawer(const PlaceRedrawer&) = delete;
  PlaceRedrawer& operator=(const PlaceRedrawer&) = delete;

  /// Whether the source of this place has others.
  bool hasOthers(const ReleasePlace& place) const;
  /// Draws the place anew, a function of the attempt (≥ 0) and of what `releasePlaces` depends on.
  /// False if it is not on the terrain.
  bool redraw(ReleasePlace& place, std::uint32_t attempt) const;

private:
  struct Samplers;
  std::unique_ptr<Samplers> samplers_;
};

/// Area in plan of a polygon, of which only what has a CFE under it counts, if there is a terrain:
/// where the rocks of an intensity are. m².
double areaOnTerrain(const SourceRow& polygon, const Terrain* terrain);

/// Area in plan of all CFEs that are at least `threshold` (rad) steep, m².
double steepArea(const Terrain& terrain, double threshold);

/// The places of rocks on all CFEs that are at least `threshold` (rad, above 0, below 90°) steep,
/// each part of their area in plan being as likely. Throws DataError if there is no such CFE.
std::vector<ReleasePlace> steepPlaces(
  const Terrain& terrain, double threshold, const ReleaseDefaults& defaults);

} // namespace rockfall
