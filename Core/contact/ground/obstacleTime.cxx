#include "contact/ground/clearance.h"
#include "contact/ground/motion.h"
#include "contact/ground/timeToTouch.h"
#include "terrain/Obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// The bounding sphere in flight towards convex bodies: along every fixed axis that tells them
/// apart the gap is covered no sooner than this; the longest of these times counts.
struct Ball
{
  Vec3 position, velocity;
  double radius, gravity;
  Vec3 beside; ///< Level and square to the way: the gap along it does not change.

  double time(const Vec3& axis, double gap) const
  {
    return gap <= 0.0 ? 0.0
                      : timeToCover(gap, -axis.dot(velocity), gravity * std::max(0.0, axis.z()));
  }

  /// To a convex body with these corners, some of whose normals are given.
  template <typename Corners, typename Normals>
  double toBody(const Corners& corners, const Normals& normals) const
  {
    double longest = 0.0;
    const auto along = [&](const Vec3& n)
    {
      double most = n.dot(corners[0]);
      for (const Vec3& q : corners)
      {
        most = std::max(most, n.dot(q));
      }
      longest = std::max(longest, this->time(n, n.dot(position) - most - radius));
    };
    for (const Vec3& normal : normals)
    {
      along(normal);
    }
    along(Vec3::UnitZ());
    for (const Vec3& n : { Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), beside })
    {
      along(n);
      along(-n);
    }
    return longest;
  }

  double toStem(const Vec3& top, double stem) const
  {
    const double over = this->time(Vec3::UnitZ(), position.z() - top.z() - radius);
    Vec3 off = position - top;
    off.z() = 0.0;
    const double distance = off.norm();
    const double apart = distance - stem - radius;
    const double radial = apart > 0.0 ? this->time(off / distance, apart) : 0.0;
    const double passes =
      std::abs(beside.dot(off)) > stem + radius ? std::numeric_limits<double>::infinity() : 0.0;
    return std::max({ over, radial, passes });
  }
};

double toLying(const Ball& ball, const Obstacles& obstacles, int tree)
{
  thread_local std::vector<Vec3> corners, normals;
  corners.clear();
  normals.clear();
  const ObstacleMesh& shape = obstacles.shapeOf(tree);
  for (int k = 0; k < int(shape.nodes.size()); ++k)
  {
    corners.push_back(obstacles.treeCorner(tree, k));
  }
  for (int k = 0; k < int(shape.triangles.size()); ++k)
  {
    normals.push_back(obstacles.treeNormal(tree, k));
  }
  return ball.toBody(corners, normals);
}

} // namespace

double timeToObstacle(PlacedBlock& rock, const BlockState& state, const Block& block,
  const Obstacles& obstacles, std::span<const int> gone, double gravity, double close,
  double horizon)
{
  const double r = block.radius();
  const Vec3& p = state.position;
  const Vec3 end = p + horizon * state.velocity;
  const double lowest = std::min(p.z(), end.z() - 0.5 * gravity * horizon * horizon) - r;
  const double x0 = std::min(p.x(), end.x()) - r, x1 = std::max(p.x(), end.x()) + r;
  const double y0 = std::min(p.y(), end.y()) - r, y1 = std::max(p.y(), end.y()) + r;
  if (obstacles.maxHeight(x0, x1, y0, y1) < lowest)
  {
    return horizon;
  }
  Ball ball{ p, state.velocity, r, gravity, Vec3::Zero() };
  const double across = state.velocity.head<2>().norm();
  if (across > 0.0)
  {
    ball.beside = Vec3(-state.velocity.y(), state.velocity.x(), 0.0) / across;
  }
  thread_local std::vector<int> triangles, trees;
  triangles.clear();
  trees.clear();
  double time = horizon;
  const ObstacleMesh& mesh = obstacles.mesh();
  obstacles.visitTriangles(x0, x1, y0, y1,
    [&](int k)
    {
      const ObstacleMesh::Triangle& t = mesh.triangles[std::size_t(k)];
      const std::array<Vec3, 3> q = { mesh.nodes[std::size_t(t.nodes[0])].position,
        mesh.nodes[std::size_t(t.nodes[1])].position,
        mesh.nodes[std::size_t(t.nodes[2])].position };
      const double at = ball.toBody(q, std::span<const Vec3, 1>(&t.normal, 1));
      if (at < close)
      {
        triangles.push_back(k);
      }
      else
      {
        time = std::min(time, at);
      }
    });
  obstacles.visitTrees(x0, x1, y0, y1,
    [&](int k)
    {
      const Eigen::Vector2d& place = obstacles.structures().trees[std::size_t(k)].position;
      const double at = obstacles.lyingOf(k)
        ? toLying(ball, obstacles, k)
        : ball.toStem(Vec3(place.x(), place.y(), obstacles.treeTop(k)), obstacles.treeRadius(k));
      if (at >= close)
      {
        time = std::min(time, at);
      }
      else if (!std::binary_search(gone.begin(), gone.end(), k))
      {
        trees.push_back(k);
      }
    });
  if (triangles.empty() && trees.empty())
  {
    return time;
  }
  // Near enough for the rock's own shape to count.
  std::sort(triangles.begin(), triangles.end());
  std::sort(trees.begin(), trees.end());
  thread_local SurfacePatch patch;
  patch.nodes.clear();
  patch.triangles.clear();
  patch.ridges.clear();
  obstacles.append(triangles, trees, patch);
  rock.place(block, state);
  return std::min(time, clearance(rock, state, patch, gravity, time).time);
}

} // namespace rockfall
