#pragma once

/// @file
/// Embankments, trees and barriers from OGR layers (METHOD 6).

#include "terrain/stand.h"
#include "terrain/structures.h"

#include <span>
#include <string>
#include <vector>

namespace rockfall
{

class Terrain;

/// Layers as the user gives them; empty: there are none.
struct StructureFiles
{
  std::string embankments; ///< Lines.
  std::string trees;       ///< Points, lines that lie, or polygons of stands.
  std::string barriers;    ///< Lines.
  /// Trees without a capacity of their own break at that of their diameter (stemCapacity); else
  /// they never break.
  bool treesBreak = true;
  /// The layer of each file by name (gis/layers/LayerFile.h); empty: the one that will do.
  std::string embankmentLayer, treeLayer, barrierLayer;

  bool any() const { return !embankments.empty() || !trees.empty() || !barriers.empty(); }
};

/// Reads one layer of each, brought to the terrain's CRS; without a CRS on either side the
/// coordinates are taken as they are. Column names without regard to case; empty cells are as good
/// as no column. Sides' slopes are metres across per metre down, as a number; of a ratio ("2:3",
/// "3:2") the larger one is the way across, with a note.
///
/// - Embankments: `height` (over ground, m) or `crest` (elevation, m), `width` (of the crest, m),
///   `slope` (of both sides), or `slope_up` and `slope_down` (of the mountain and the valley side).
/// - Trees: `diameter` (cm) and `height` (m), `capacity` (kJ), `factor` (of the species). A line is
///   lying stems, one a piece between two of its points; it needs no height.
/// - Stands: `stems_ha`, `dbh_mean` and `dbh_dev` (cm), `height` (m), `conifers` (%), `f_conifer`
///   and `f_broad` (factors of the species), `spacing` (m).
/// - Barriers: `height` (m), `capacity` (kJ; empty: holds everything), `mode` (stop or record),
///   `absorbs` (1 or 0), `overhang` (0 to 0.5),
///   `braking` (m), `residual` (%), `fill` (m³/m).
/// - Embankments and trees: `rv`, `rt`, `phi` (degrees), `cohesion` (N); empty: the slope's own.
///
/// Trees where the terrain has no ground are left out, with a note; if all do, that is an error.
/// Notes tell what is there twice or better than anything that is built (terrain/plausible.h).
/// Throws FileError, DataError or ParameterError naming file, row, field and value: another
/// geometry, a number missing or out of range, no overlap with the terrain, more than a million
/// rows, what cannot be built (see Obstacles).
///
/// `cells`: stands of the file of trees, if that is a raster (gis/forest/standRaster.h).
Structures readStructures(const StructureFiles& files, const Terrain& terrain,
  std::vector<std::string>& notes, std::span<const Stand> cells = {});

} // namespace rockfall
