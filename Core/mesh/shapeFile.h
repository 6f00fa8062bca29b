#pragma once

/// @file
/// A rock's shape from a file of points or of a surface.

#include "geometry/Polyhedron.h"

#include <string>
#include <vector>

namespace rockfall
{

/// Reads a shape. Points (.csv, .xyz, .txt: see pointTable.h; or a mesh file without polygons) give
/// their convex hull. A surface (.vtp, .vtk, .stl, .ply, .obj) must be closed with its faces
/// outward; it is taken as it is if `asItIs`, else its hull is taken, with a note if that changed
/// it. Throws FileError or GeometryError, naming the file; DataError if its coordinates are rounded
/// by more than a thousandth of the body.
Polyhedron readShape(const std::string& fileName, bool asItIs, std::vector<std::string>& notes);

} // namespace rockfall
