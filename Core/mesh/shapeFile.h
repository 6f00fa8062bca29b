#pragma once

/// @file
/// A rock's shape of points or of a surface.

#include "geometry/Polyhedron.h"
#include "mesh/Mesh.h"

#include <string>
#include <vector>

namespace rockfall
{

/// Points alone give their convex hull. A surface must be closed with its faces outward; it is taken
/// as it is if `asItIs`, else its hull is taken, with a note if that changed it. `name` is that of
/// the file or input, for messages. Throws GeometryError; DataError if coordinates are rounded by
/// more than a thousandth of the body.
Polyhedron shapeOf(
  const Mesh& mesh, const std::string& name, bool asItIs, std::vector<std::string>& notes);

/// The same of a file: points (.csv, .xyz, .txt: see pointTable.h) or a mesh (.stl, .ply, .obj).
/// Throws FileError, too.
Polyhedron readShape(const std::string& fileName, bool asItIs, std::vector<std::string>& notes);

} // namespace rockfall
