#pragma once

/// @file
/// The slope as one realisation sees it, and the small explicit piece of it under a rock.

#include "terrain/Terrain.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace rockfall
{

/// A terrain with the random numbers of one iteration put on it (METHOD 7). A value: two surfaces
/// of the same terrain, seed and iteration are the same.
class Surface
{
public:
  Surface(const Terrain& terrain, std::uint64_t seed, int iteration);
  /// Without roughness and with the mean material.
  static Surface asSurveyed(const Terrain& terrain);

  const Terrain& terrain() const { return *terrain_; }
  double restitution() const { return restitution_; } ///< Rv drawn, clamped to 0 … 1.
  double friction() const { return friction_; }       ///< tan φ of the φ drawn.
  double cohesion() const { return terrain_->material().cohesion; } ///< N

  double nodeHeight(int row, int column) const; ///< With roughness, NaN for nodata, m.
  double elevation(double x, double y) const;   ///< With roughness, NaN outside, m.
  /// Upper bound of the surface over a box, m; −∞ if there is none.
  double maxHeight(double xMin, double xMax, double yMin, double yMax) const
  {
    return terrain_->maxHeight(xMin, xMax, yMin, yMax) + roughnessBound_;
  }

private:
  explicit Surface(const Terrain& terrain);

  const Terrain* terrain_;
  std::uint64_t seed_ = 0;
  std::uint32_t iteration_ = 0;
  bool rough_ = false;
  double roughnessBound_ = 0.0;
  double restitution_;
  double friction_; ///< tan φ
};

/// An explicit piece of surface: the triangles near a rock with their edges and nodes. Contact code
/// sees nothing else, so that any triangulated surface can serve it.
struct SurfacePatch
{
  struct Triangle
  {
    std::array<int, 3> nodes; ///< Counter-clockwise from outside.
    /// Across edge k (nodes k, k+1): the other triangle (−1: none here) and the edge's bend.
    std::array<int, 3> neighbours;
    std::array<signed char, 3> bends; ///< +1 convex (ridge), 0 flat, −1 concave (valley).
    Vec3 normal;
    double offset; ///< normal · x on the plane, m.
    std::int64_t cfe;
  };
  /// A convex edge between two triangles: the only kind that an edge of a rock can touch.
  struct Ridge
  {
    std::array<int, 2> nodes;
    std::array<int, 2> triangles;
    std::array<int, 2> wings; ///< The third node of each triangle.
    std::int64_t key;         ///< The same edge has the same key in every patch.
  };
  struct Node
  {
    Vec3 position;
    std::int64_t key;
    std::int64_t cfe; ///< One of the CFEs here, 0 if there is none.
    bool peak;        ///< On a ridge, all neighbours known: a rock's face can touch it.
    std::array<int, 6> neighbours; ///< Of a peak; −1 where there are fewer.
  };

  std::vector<Node> nodes;
  std::vector<Triangle> triangles;
  std::vector<Ridge> ridges;

  /// Cells gathered: rows [row0, row1], columns [column0, column1]; empty if row1 < row0.
  int row0 = 0, row1 = -1, column0 = 0, column1 = -1;
  /// Nodes are rows of `nodeColumns` from the north, `cellSize` (m) apart.
  int nodeColumns = 0, nodeRows = 0;
  double cellSize = 0.0;
  double highest = 0.0; ///< Of its nodes, m.
  /// Mean of its CFEs' gradients (∂z/∂x, ∂z/∂y), and the farthest that one of them is from it.
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
  double relief = 0.0;

  /// x–y box in which a rock may stand for this patch to be enough, m.
  double xMin = 0.0, xMax = -1.0, yMin = 0.0, yMax = -1.0;

  /// Elevation of the surface, −∞ where there is none in the patch, m.
  double elevation(double x, double y) const
  {
    const double c = (x - nodes[0].position.x()) / cellSize;
    const double r = (nodes[0].position.y() - y) / cellSize;
    if (!(c >= 0.0 && r >= 0.0 && c <= nodeColumns - 1 && r <= nodeRows - 1))
    {
      return -std::numeric_limits<double>::infinity();
    }
    const int column = std::min(int(c), nodeColumns - 2), row = std::min(int(r), nodeRows - 2);
    const double s = c - column, t = r - row;
    const Node* upper = &nodes[std::size_t(row) * nodeColumns + column];
    const Node* lower = upper + nodeColumns;
    const double z0 = upper[0].position.z(), z2 = lower[1].position.z();
    const double z = t >= s
      ? z0 + t * (lower[0].position.z() - z0) + s * (z2 - lower[0].position.z())
      : z0 + s * (upper[1].position.z() - z0) + t * (z2 - upper[1].position.z());
    return std::isnan(z) ? -std::numeric_limits<double>::infinity() : z;
  }
  bool covers(double x0, double x1, double y0, double y1) const
  {
    return x0 >= xMin && x1 <= xMax && y0 >= yMin && y1 <= yMax;
  }
};

/// Gathers the cells under a box (local frame, m) with a ring of one cell around them, by index
/// arithmetic [paper eq. 1]. Reuses the memory of `patch`.
void gatherPatch(
  const Surface& surface, double xMin, double xMax, double yMin, double yMax, SurfacePatch& patch);

} // namespace rockfall
