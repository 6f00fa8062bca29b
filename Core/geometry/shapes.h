#pragma once

/// @file
/// The rock shapes that a user picks by name. Every maker gives a polyhedron with its centroid at
/// the origin and the volume asked for.

#include "geometry/Polyhedron.h"

#include <string>
#include <vector>

namespace rockfall
{

/// The numbers are those of the `Shape` property of the rock-block source.
enum class Shape
{
  Cube = 0,        ///< Edges along the axes.
  Tetrahedron = 1, ///< Regular.
  Octahedron = 2,
  Dodecahedron = 3,
  Icosahedron = 4,
  Box = 5,     ///< Three lengths, scaled to the volume.
  Eota111 = 6, ///< METHOD 11.
  Eota221 = 7,
  File = 8,      ///< From a file's points or mesh.
  Sphere = 9,    ///< Exact (roundBody.h), drawn as 1280 triangles.
  Ellipsoid = 10 ///< The same of three axes, scaled to the volume.
};
inline constexpr int kShapes = 11;

/// A regular, EOTA or round shape of this volume (m³). Not for Box, Ellipsoid and File
/// (ParameterError).
Polyhedron makeShape(Shape shape, double volume);

/// A box of these edge lengths along the axes (m).
Polyhedron makeBox(const Vec3& lengths);

/// An ellipsoid of these whole axes (m), centroid at the origin. Throws ParameterError.
Polyhedron makeEllipsoid(const Vec3& lengths);

/// The label of a shape as a user reads and types it ("cube", "eota111"), and back; the way back
/// ignores case and throws ParameterError naming the word and the choices.
std::string shapeName(Shape shape);
Shape shapeFromName(const std::string& name);

} // namespace rockfall
