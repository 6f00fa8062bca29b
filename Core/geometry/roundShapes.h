#pragma once

/// @file
/// The round shapes that a user picks by name, as exact bodies (roundBody.h); drawn as 1280
/// triangles.

#include "geometry/shapes.h"

namespace rockfall
{

/// makeShape makes it.
inline constexpr Shape kSphere{ 9 };
/// Of three axes, scaled to the volume.
inline constexpr Shape kEllipsoid{ 10 };
/// How many shapes there are, polyhedra and others.
inline constexpr int kShapes = 11;

/// An ellipsoid of these whole axes (m), centroid at the origin. Throws ParameterError.
Polyhedron makeEllipsoid(const Vec3& lengths);

} // namespace rockfall
