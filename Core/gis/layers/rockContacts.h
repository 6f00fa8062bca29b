#pragma once

/// @file
/// The table of pairs of materials of rocks that hit each other.

#include "base/RockContact.h"

#include <span>
#include <string>
#include <vector>

namespace rockfall
{

/// Reads a table of anything OGR opens (`sheet`: by name, gis/layers/LayerFile.h). Columns,
/// case-insensitive: material_a and material_b, in any order, the same for a material that meets
/// itself; restitution (or rn, e), phi (or friction_angle; degrees), and cohesion (or c; N per
/// contact point), which is `usualCohesion` where it is empty. Other columns are ignored.
///
/// `materials` are the names that the rocks have, in any number and order; a pair of another one is
/// an error, as it may be a name that was misspelt.
///
/// Throws FileError (missing, a folder, a raster, unreadable) or DataError naming file, row, field
/// and value: no such column, an empty cell, a word for a number, a value out of range, a pair
/// twice (also in reverse order), a material that no rock has, more than 255 materials, no row.
/// Prints nothing.
std::vector<RockContactPair> readRockContacts(const std::string& fileName, double usualCohesion,
  std::span<const std::string> materials, const std::string& sheet = {},
  std::vector<std::string>* notes = nullptr);

} // namespace rockfall
