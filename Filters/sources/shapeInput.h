#pragma once

/// @file
/// A shape that comes by pipeline, of whatever format ParaView reads.

#include "mesh/Mesh.h"

class vtkPolyData;

namespace rockfall::filters
{

/// Polygons and triangle strips as faces, and all points; points alone if there are neither.
/// Coordinates of single precision are rounded, as those of a file are. Throws FileError as
/// `checkMesh` does.
Mesh meshOf(vtkPolyData* surface);

/// Throws ParameterError if both a file (property `field`) and an input give the shape.
void requireOneShape(const std::string& field, const std::string& fileName, bool hasInput);

} // namespace rockfall::filters
