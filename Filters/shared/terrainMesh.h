#pragma once

/// @file
/// The triangles that show a slope.

#include "terrain/Terrain.h"

class vtkPolyData;

namespace rockfall::filters
{

/// Smallest stride at which a mesh over every stride-th node has at most `maximum` triangles.
int displayStride(const Terrain& terrain, std::int64_t maximum);

/// Number of triangles of the mesh over every stride-th node.
std::int64_t countTriangles(const Terrain& terrain, int stride);

/// Fills `mesh` with the triangles over every stride-th node, in real coordinates, with the cell
/// arrays CFEId, RestitutionCoefficient, RestitutionClass, FrictionAngle (degrees) and JointClass
/// and the point array Elevation. A node without a triangle gets no point.
void makeTerrainMesh(const Terrain& terrain, int stride, vtkPolyData* mesh);

} // namespace rockfall::filters
