#pragma once

/// @file
/// Structures as the rocks meet them: embankments and trees as explicit triangles on the slope,
/// barriers as upright planes.
///
/// The solid is the union of the slope and the obstacles. Every embankment is one mesh with mitred
/// joints, every tree a prism, upright or lying; all go down below the ground, where they are open. What is buried
/// is never met.

#include "terrain/BoxIndex.h"
#include "terrain/structures.h"

#include <array>
#include <limits>
#include <span>
#include <vector>

namespace rockfall
{

class Terrain;
struct SurfacePatch;

/// Triangles with what contact needs to know of them.
struct ObstacleMesh
{
  struct Triangle
  {
    std::array<int, 3> nodes;
    std::array<int, 3> neighbours = { -1, -1, -1 }; ///< Across nodes k, k + 1; −1: underground.
    std::array<signed char, 3> bends = { 0, 0, 0 };
    Vec3 normal = Vec3::UnitZ();
  };
  struct Node
  {
    Vec3 position;
    bool peak = false;                                          ///< On a ridge.
    std::array<int, 6> neighbours = { -1, -1, -1, -1, -1, -1 }; ///< Along edges that bend.
  };
  std::vector<Node> nodes;
  std::vector<Triangle> triangles;

  /// Finds neighbours, bends, normals and peaks of the triangles from `from` on; their neighbours
  /// are among them.
  void connect(std::size_t from = 0);
};

/// Appends the mesh of an embankment. Throws DataError naming what cannot be built.
void addEmbankment(const Embankment& embankment, const Terrain& terrain, ObstacleMesh& mesh);

/// Where a lying stem is.
struct LyingStem
{
  Vec3 from = Vec3::Zero(), to = Vec3::Zero(); ///< Ends of its axis, m.
  double radius = 0.0;                         ///< m
  double rise = 0.0;                           ///< Of its top over its axis, straight up, m.
  double depth = 0.0;                          ///< Of its foot under its axis, m.
  double hollow = 0.0;                         ///< Largest gap between it and the ground, m.
  double buried = 0.0;                         ///< Most that the ground stands over its top, m.
};

/// Immutable, so safe to share over threads.
class Obstacles
{
public:
  /// Sides of a tree's prism, and triangles of it.
  static constexpr int treeSides = 8;
  static constexpr int treeTriangles = 3 * treeSides - 2;

  /// Throws ParameterError or DataError naming feature, field and value: numbers out of range,
  /// places where there is no ground, sides that do not come down to the ground.
  Obstacles(Structures structures, const Terrain& terrain);

  const Structures& structures() const { return structures_; }
  bool solid() const { return !mesh_.triangles.empty() || !structures_.trees.empty(); }
  const ObstacleMesh& mesh() const { return mesh_; } ///< Of the embankments.
  int embankmentOf(int meshTriangle) const { return owners_[std::size_t(meshTriangle)]; }
  /// Corners of the upper and lower end of a tree's prism and its triangles.
  static const ObstacleMesh& treeShape();
  /// The same of a lying stem, with fewer of both.
  static const ObstacleMesh& lyingShape();
  const ObstacleMesh& shapeOf(int tree) const
  {
    return this->lyingOf(tree) ? lyingShape() : treeShape();
  }
  Vec3 treeCorner(int tree, int corner) const;
  Vec3 treeNormal(int tree, int triangle) const;
  /// Null if it stands.
  const LyingStem* lyingOf(int tree) const
  {
    const std::size_t k = std::size_t(tree);
    return k < lyingNumbers_.size() && lyingNumbers_[k] >= 0
      ? &lying_[std::size_t(lyingNumbers_[k])]
      : nullptr;
  }
  /// Adds notes on lying stems that bridge a hollow deeper than they are thick, or lie within the
  /// ground.
  void askAfterLying(std::vector<std::string>& notes) const;
  /// Whether a place is within a tree.
  bool isInTree(int tree, const Vec3& place) const;
  /// Box that the tree takes up in plan, and its top.
  FlatBox treeBox(int tree) const;

  /// CFEs of obstacles have numbers beyond the slope's: first the embankments', then the trees'.
  std::int64_t firstCfe() const { return firstCfe_; }
  int treeOf(std::int64_t cfe) const; ///< −1 if it is none.
  int materialOf(std::int64_t cfe) const;
  /// Whether what an obstacle's CFE is of is hard: trees, and embankments of a material of their own
  /// that has no scars.
  bool isFirm(std::int64_t cfe) const;

  /// Upper bound of the obstacles over a box, m; −∞ if there is none.
  double maxHeight(double xMin, double xMax, double yMin, double yMax) const
  {
    return std::max(meshIndex_.top(xMin, xMax, yMin, yMax), treeIndex_.top(xMin, xMax, yMin, yMax));
  }
  /// Whether there may be any in a box that does something to rocks: barriers, too, but those that
  /// only record.
  bool anyIn(double xMin, double xMax, double yMin, double yMax) const
  {
    bool any = this->maxHeight(xMin, xMax, yMin, yMax) > -std::numeric_limits<double>::infinity();
    this->visitBarriers(xMin, xMax, yMin, yMax,
      [&](const Piece& piece)
      { any = any || !structures_.barriers[std::size_t(piece.barrier)].records; });
    return any;
  }
  /// Appends to a patch what stands in a box, without the trees that are `gone` (ascending).
  void append(double xMin, double xMax, double yMin, double yMax, std::span<const int> gone,
    SurfacePatch& patch) const;
  /// The same of single triangles of embankments (ascending) and trees.
  void append(
    std::span<const int> triangles, std::span<const int> trees, SurfacePatch& patch) const;

  template <typename Use>
  void visitTriangles(double xMin, double xMax, double yMin, double yMax, Use&& use) const
  {
    meshIndex_.visit(xMin, xMax, yMin, yMax, use);
  }
  template <typename Use>
  void visitTrees(double xMin, double xMax, double yMin, double yMax, Use&& use) const
  {
    treeIndex_.visit(xMin, xMax, yMin, yMax, use);
  }
  double treeRadius(int tree) const; ///< Of the circle around the upright prism, m.
  double treeTop(int tree) const { return treeEnds_[std::size_t(tree)][1]; }

  /// Elevation of the embankment over a place in plan, m; −∞ if there is none.
  double embankmentTop(double x, double y) const;

  /// A piece of a barrier between two of its points.
  struct Piece
  {
    int barrier;
    Eigen::Vector2d from, to;
    bool begins, ends; ///< At the barrier's ends.
  };
  const std::vector<Piece>& barrierPieces() const { return barrierPieces_; }
  template <typename Use>
  void visitBarriers(double xMin, double xMax, double yMin, double yMax, Use&& use) const
  {
    barrierIndex_.visit(
      xMin, xMax, yMin, yMax, [&](int k) { use(barrierPieces_[std::size_t(k)]); });
  }

private:
  /// Throws ParameterError or DataError naming the feature.
  static LyingStem lay(const Tree& tree, const Terrain& terrain);
  static Vec3 lyingCorner(const LyingStem& stem, int corner);
  static bool isIn(const LyingStem& stem, const Vec3& place);

  Structures structures_;
  std::int64_t firstCfe_ = 0;
  ObstacleMesh mesh_;
  std::vector<int> owners_;
  std::vector<std::array<double, 2>> treeEnds_; ///< Elevation of the lower and the upper end, m.
  std::vector<LyingStem> lying_;
  std::vector<int> lyingNumbers_; ///< Of trees in lying_, up to the last that lies; −1: it stands.
  std::vector<Piece> barrierPieces_;
  BoxIndex meshIndex_, treeIndex_, barrierIndex_;
};

} // namespace rockfall
