#pragma once

/// @file
/// The convex polyhedron: vertices, polygonal faces with outward normals, edges, and its exact
/// integrals.

#include "base/types.h"
#include "geometry/ShapeLayout.h"
#include "geometry/simplexIntegration.h"

#include <array>
#include <memory>
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

  Polyhedron()
    : parts_(nothing())
  {
  }
  // Copies share what they are made of; what is moved from stays whole.
  Polyhedron(const Polyhedron&) = default;
  Polyhedron& operator=(const Polyhedron&) = default;
  ~Polyhedron() = default;

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

  const std::vector<Vec3>& vertices() const { return parts_->vertices; }
  /// Loops, CCW from outside.
  const std::vector<std::vector<int>>& faces() const { return parts_->faces; }
  /// Per face, outward, unit.
  const std::vector<Vec3>& normals() const { return parts_->normals; }
  /// Per face, normal · x on it, m.
  const std::vector<double>& offsets() const { return parts_->offsets; }
  const std::vector<Edge>& edges() const { return parts_->edges; }
  /// All of this for loops over vertices or faces.
  const ShapeLayout& layout() const { return parts_->layout; }
  /// Vertices joined to vertex v by an edge.
  const std::vector<int>& neighbours(int v) const { return parts_->neighbours[v]; }
  const VolumeIntegrals& integrals() const { return parts_->integrals; }
  /// Largest distance of a vertex from the centroid, m.
  double radius() const { return parts_->radius; }

  /// The same shape with x ↦ scale·(R x) + shift; scale > 0 (ParameterError).
  Polyhedron transformed(double scale, const Quat& rotation, const Vec3& shift) const;
  /// The same shape with its centroid at the origin.
  Polyhedron centred() const;
  /// The same shape scaled about its centroid to this volume (m³, > 0 or ParameterError).
  Polyhedron withVolume(double volume) const;

private:
  struct Parts
  {
    std::vector<Vec3> vertices;
    std::vector<std::vector<int>> faces;
    std::vector<Vec3> normals;
    std::vector<double> offsets;
    std::vector<Edge> edges;
    std::vector<std::vector<int>> neighbours;
    VolumeIntegrals integrals;
    double radius = 0.0;
    ShapeLayout layout;

    /// Offsets, radius and layout, from vertices, normals and integrals.
    void updateDistances();
  };
  explicit Polyhedron(Parts parts);
  /// From a shell that has passed every check.
  static Polyhedron fromShell(
    const Shell& shell, std::span<const Vec3> points, const std::string& name);
  /// Ingredients of a polyhedron without faces.
  static const std::shared_ptr<const Parts>& nothing();

  std::shared_ptr<const Parts> parts_; ///< Of all copies: a thousand alike take up the room of one.
};

} // namespace rockfall
