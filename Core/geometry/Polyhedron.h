#pragma once

/// @file
/// The convex polyhedron: vertices, polygonal faces with outward normals, edges, and its exact
/// integrals.

#include "base/types.h"
#include "geometry/simplexIntegration.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace rockfall
{

struct Shell;

/// A convex polyhedron. Immutable once made; the makers validate and throw GeometryError.
///
/// Coplanar neighbouring faces are merged, so a triangulated cube has 6 faces and 12 edges: an edge
/// of the polyhedron is always a real, convex edge.
class Polyhedron
{
public:
  struct Edge
  {
    std::array<int, 2> vertices; ///< End points; directed as in the loop of faces[0].
    std::array<int, 2> faces;    ///< The two faces that meet here.
  };

  Polyhedron() = default;

  /// From polygon loops, counter-clockwise seen from outside. Points closer than a relative 1e-9
  /// are one vertex, and what lies within a relative 1e-6 of a plane is planar, so that single
  /// precision will do. Checked: finite points, planar faces, closed surface (every edge used once
  /// in each direction), outward orientation, convexity, positive volume, no sliver. `name` begins
  /// every message, which counts points and faces as they were given, from 0.
  static Polyhedron fromFaces(std::span<const Vec3> points, std::span<const std::vector<int>> faces,
    const std::string& name = "polyhedron");

  /// The convex hull of a point set (Qhull), at least four points not in one plane. Nothing is
  /// printed; points inside the hull or, within a relative 1e-6, on its faces are left out.
  static Polyhedron convexHull(
    std::span<const Vec3> points, const std::string& name = "polyhedron");

  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<std::vector<int>>& faces() const
  {
    return faces_;
  }                                                             ///< Loops, CCW from outside.
  const std::vector<Vec3>& normals() const { return normals_; } ///< Per face, outward, unit.
  const std::vector<double>& offsets() const
  {
    return offsets_;
  } ///< Per face, normal · x on it, m.
  const std::vector<Edge>& edges() const { return edges_; }
  /// Vertices joined to vertex v by an edge.
  const std::vector<int>& neighbours(int v) const { return neighbours_[v]; }
  const VolumeIntegrals& integrals() const { return integrals_; }
  /// Largest distance of a vertex from the centroid, m.
  double radius() const { return radius_; }

  /// The same shape with x ↦ scale·(R x) + shift; scale > 0 (ParameterError).
  Polyhedron transformed(double scale, const Quat& rotation, const Vec3& shift) const;
  /// The same shape with its centroid at the origin.
  Polyhedron centred() const;
  /// The same shape scaled about its centroid to this volume (m³, > 0 or ParameterError).
  Polyhedron withVolume(double volume) const;

private:
  /// From a shell that has passed every check.
  static Polyhedron fromShell(
    const Shell& shell, std::span<const Vec3> points, const std::string& name);
  /// Offsets and radius, from vertices, normals and integrals.
  void updateDistances();

  std::vector<Vec3> vertices_;
  std::vector<std::vector<int>> faces_;
  std::vector<Vec3> normals_;
  std::vector<double> offsets_;
  std::vector<Edge> edges_;
  std::vector<std::vector<int>> neighbours_;
  VolumeIntegrals integrals_;
  double radius_ = 0.0;
};

} // namespace rockfall
