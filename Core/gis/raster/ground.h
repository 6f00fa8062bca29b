#pragma once

/// @file
/// Classes of ground: a grid or polygons that say where, a table that says what (METHOD 6).

#include "terrain/Terrain.h"

#include <string>
#include <vector>

namespace rockfall
{

/// The material's numbers that a table has.
enum class GroundKind
{
  Restitution, ///< Rv or Rn, its deviation, model, Rt, K, roughness.
  Joint,       ///< φ, its deviation, cohesion.
};

/// A layer and its table, as the user gives them.
struct GroundFiles
{
  std::string layer; ///< Raster or polygons; empty: no classes.
  std::string table; ///< Anything OGR opens.
  std::string field; ///< Of the polygons, with the class; empty looks for class, name, code, …
  std::string layerName = {};  ///< Of the layer's file (LayerFile.h); empty: what will do.
  std::string tableSheet = {}; ///< Of the table's file; empty: what will do.
  bool alone = false;          ///< The other kind has no table: what this one says of it is told.
};

/// Reads classes and brings them to the cells of a terrain, each cell by its centre. Layers of any
/// CRS and extent are brought to the terrain's CRS; without a CRS on either side the coordinates
/// are taken as they are. Cells that the layer does not cover are of class 0, the terrain's own
/// material.
///
/// Columns of the table, case-insensitive: class (the raster's value or the polygons' text), name,
/// preset (see terrain/presets.h); for restitution rv (or rn, restitution), rv_deviation, model (0
/// to 2 or its name), rt, speed (m/s), roughness_mean, roughness (its deviation), roughness_length,
/// rg70, rg20, rg10 (m); for joints phi, phi_deviation (degrees), cohesion (N). What
/// is empty is the preset's if there is one; else rv and phi are needed, and of the others the
/// deviations are 0 and the rest is the terrain's own material's.
///
/// Class k of the result is row k of the table. `notes` gets the shares of the classes, rows that
/// no cell uses and cells without class. Returns no classes if no layer is named.
///
/// Throws FileError (missing, unreadable), DataError (no overlap, no way to the terrain's CRS, a
/// class without a row, no such field, other geometries; in the table: no row or more than 255, a
/// class twice, words for numbers, values out of range) or ParameterError (a layer without a table
/// or a table without a layer), naming file, row, field, class and value.
MaterialClasses readGround(GroundKind kind, const GroundFiles& files, const Terrain& terrain,
  std::vector<std::string>& notes);

} // namespace rockfall
