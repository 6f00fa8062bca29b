#pragma once

/// @file
/// Spheres and ellipsoids: shapes whose vertices lie on one, as close together as only a mesh of it
/// has them.
///
/// Such a polyhedron is what is drawn and read; its mass properties and its contact with the slope
/// are those of the round body (contact/ground/roundContact.h). With the matrix A of the semi-axes,
///
///     x = c + A s, |s| = 1,  A = Σ aᵢ eᵢ eᵢᵀ,  ∫ X Xᵀ dV = V/5 A²,  V = 4/3 π det A
///
/// The plane with the outward normal n that touches it is |A n| away from its centre, and touches
/// it in c + A² n / |A n|.

#include "geometry/ShapeLayout.h"
#include "geometry/simplexIntegration.h"

#include <optional>
#include <span>

namespace rockfall
{

struct RoundBody
{
  Vec3 centre = Vec3::Zero();
  Mat3 axes = Mat3::Identity(); ///< A, m.
  double least = 0.0;           ///< The smallest semi-axis, m.
  double most = 0.0;            ///< The largest one, m.

  VolumeIntegrals integrals() const;
};

/// The sphere or ellipsoid that a convex mesh stands for: its points on the surface but for single
/// precision, no face more than 3 % inside.
std::optional<RoundBody> roundBodyOf(
  std::span<const Vec3> points, std::span<const Vec3> normals, std::span<const double> offsets);

/// Whether a shape is one; its axes A then follow the numbers of the faces in the layout's data.
inline bool isRound(const ShapeLayout& layout)
{
  return layout.data.size() > std::size_t(ShapeLayout::kOfVertices * layout.vertexFours +
                                ShapeLayout::kOfFaces * layout.faceFours);
}
/// A of a round shape, in its own axes, m.
inline Mat3 roundAxes(const ShapeLayout& layout)
{
  return Eigen::Map<const Mat3>(layout.data.data() + layout.data.size() - 9);
}

/// Distance of the plane with this normal that touches a round body with the axes A from its
/// centre, m.
inline double roundReach(const Mat3& axes, const Vec3& normal)
{
  return (axes.transpose() * normal).norm();
}

} // namespace rockfall
