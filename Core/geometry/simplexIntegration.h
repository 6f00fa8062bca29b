#pragma once

/// @file
/// Shi's simplex integration: the integrals of 1, X and X Xᵀ over a polyhedron, exact from its
/// faces (Shi 1996, "Simplex integration for manifold method, FEM, DDA and analytical solutions").

#include "base/types.h"

#include <span>
#include <vector>

namespace rockfall
{

/// Volume integrals of a polyhedron, exact from its faces (Shi's simplex integration).
struct VolumeIntegrals
{
  double volume = 0.0;          ///< m³
  Vec3 centroid = Vec3::Zero(); ///< m
  Mat3 second = Mat3::Zero();   ///< ∫ X Xᵀ dV about the centroid, m⁵
};

/// Integrates over the region that closed, planar face loops enclose, counter-clockwise seen from
/// outside; it need not be convex. `points` in m.
///
/// The body is the sum of signed tetrahedra (r, p0, p1, p2), one per triangle of each face's fan,
/// with r in the midst of the points. With a, b, c = p − r and J = a · (b × c), s = a + b + c:
///
///     ∫ dV     = J / 6
///     ∫ x dV   = J / 24 · s
///     ∫ xxᵀ dV = J / 120 · (s sᵀ + a aᵀ + b bᵀ + c cᵀ)
///
/// Faces wound the other way give a negative volume; the centroid of a volume of 0 is r.
VolumeIntegrals integrateSimplices(
  std::span<const Vec3> points, std::span<const std::vector<int>> faces);

} // namespace rockfall
