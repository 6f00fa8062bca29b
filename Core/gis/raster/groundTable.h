#pragma once

/// @file
/// The table of a ground layer.

#include "gis/raster/ground.h"

#include <map>
#include <string>
#include <vector>

namespace rockfall::gis
{

/// The rows of a table, and how cells find theirs.
struct GroundTable
{
  std::vector<std::string> names;         ///< Row by row.
  std::vector<SurfaceMaterial> materials; ///< Row by row.
  std::vector<Roughness> roughness;       ///< Row by row; empty if the table has none.
  std::map<std::string, int> rows;        ///< From class (and name, if no class has it), from 1.

  /// 0 if there is none. Numbers are one, however they are written.
  int rowOf(const std::string& key) const;
  /// "1", "2", "rock": all classes, for a message.
  std::string keys() const;
};

/// As properties begin: "Restitution" or "Joint".
std::string kindName(GroundKind kind);

/// The table of `files`, see readGround. `usual`, `usualRoughness`: what is taken for empty cells.
GroundTable readGroundTable(GroundKind kind, const GroundFiles& files, const SurfaceMaterial& usual,
  const Roughness& usualRoughness, std::vector<std::string>& notes);

} // namespace rockfall::gis
