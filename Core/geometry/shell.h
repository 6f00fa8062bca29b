#pragma once

/// @file
/// Steps from a list of faces to a Polyhedron: welding, the checks, and the merging of
/// coplanar faces. Internal to geometry/.

#include "base/types.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace rockfall
{

/// All relative to the extent of the body, dimensionless.
///@{
/// Points closer than this are one; above the rounding of a 1 m block at UTM coordinates (5e-10).
constexpr double weldTolerance = 1e-9;
/// Distance from a plane below which a point lies in it: ten times the rounding of files in single
/// precision.
constexpr double planeTolerance = 1e-6;
/// Least 3 V / A, the radius of an inscribed sphere were there one; thinner is a sliver, whose
/// faces the plane tolerance could not tell apart.
constexpr double leastDepth = 1e-4;
///@}

/// A surface of face loops in the making, counter-clockwise seen from outside.
struct Shell
{
  std::vector<Vec3> points; ///< About an origin in the midst of the body, m.
  std::vector<std::vector<int>> faces;
  std::vector<int> pointIds; ///< Numbers by which the caller knows the points ...
  std::vector<int> faceIds;  ///< ... and the faces.
  double extent = 0.0;       ///< Diagonal of the bounding box, m.
};

/// The plane of a loop, by Newell's vector area.
struct FacePlane
{
  Vec3 normal;      ///< Unit; zero if the loop has no area.
  double offset;    ///< normal · x, midway between the loop's extremes, m.
  double deviation; ///< Largest distance of a point of the loop from the plane, m.
  int farthest;     ///< The point that has it.
  double area;      ///< m²
  double width;     ///< Area per diameter: how firmly the loop holds its plane, m.
};
FacePlane facePlane(std::span<const Vec3> points, std::span<const int> loop);

/// The face to the left of every directed edge, keyed by its two points.
class DirectedEdges
{
public:
  explicit DirectedEdges(const std::vector<std::vector<int>>& faces);
  /// The face whose loop goes from a to b, -1 if there is none.
  int face(int a, int b) const;
  /// Every edge is used once in each direction.
  bool closed() const;

private:
  static std::uint64_t key(int a, int b) { return std::uint64_t(a) << 32 | std::uint32_t(b); }
  std::unordered_map<std::uint64_t, int> faces_;
  bool repeated_ = false;
};

/// Finite points about an origin in their midst, duplicates welded, faces over them if any are
/// given. Points keep their order. Throws GeometryError, as do the checks; `name` begins every
/// message.
Shell weldShell(
  std::span<const Vec3> points, std::span<const std::vector<int>> faces, const std::string& name);

void checkPlanar(const Shell& shell, const std::string& name);
/// Closed and consistently wound.
void checkClosed(const Shell& shell, const std::string& name);
/// Positive volume, not a sliver.
void checkVolume(const Shell& shell, const std::string& name);
/// Reason why the shell is no convex body with a plane for each face; empty if it is one.
std::string convexityFault(const Shell& shell);

/// Merges neighbouring faces that lie within `tolerance` (m) of one plane and drops the vertices
/// where fewer than three faces are left. Nothing if the result would not be a closed surface of
/// simple loops, which a smaller tolerance mends.
std::optional<Shell> mergeCoplanar(const Shell& shell, double tolerance);

/// Face loops of the convex hull of points that are not in one plane (Qhull).
std::vector<std::vector<int>> hullFaces(std::span<const Vec3> points, const std::string& name);

} // namespace rockfall
