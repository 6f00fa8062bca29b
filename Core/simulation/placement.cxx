#include "simulation/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

constexpr double none = -std::numeric_limits<double>::infinity();

/// z of the underside of a convex body at (x, y) over its centroid; −∞ outside of its outline.
double underside(const std::vector<Vec3>& normals, const std::vector<double>& offsets, double x,
  double y, double tolerance)
{
  double lower = none, upper = -none;
  for (std::size_t face = 0; face < normals.size(); ++face)
  {
    const Vec3& n = normals[face];
    const double rest = offsets[face] - n.x() * x - n.y() * y;
    if (std::abs(n.z()) < 1e-12)
    {
      if (rest < -tolerance)
      {
        return none;
      }
    }
    else if (n.z() < 0.0)
    {
      lower = std::max(lower, rest / n.z());
    }
    else
    {
      upper = std::min(upper, rest / n.z());
    }
  }
  return lower <= upper + tolerance ? lower : none;
}

/// How much b's segment is over a's where they cross in plan; −∞ if they do not.
double above(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1)
{
  const double ax = a1.x() - a0.x(), ay = a1.y() - a0.y();
  const double bx = b1.x() - b0.x(), by = b1.y() - b0.y();
  const double det = ax * by - ay * bx;
  if (det == 0.0)
  {
    return none; // parallel: their ends are looked at by the other two
  }
  const double dx = b0.x() - a0.x(), dy = b0.y() - a0.y();
  const double s = (dx * by - dy * bx) / det, t = (dx * ay - dy * ax) / det;
  if (!(s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0))
  {
    return none;
  }
  return b0.z() + t * (b1.z() - b0.z()) - (a0.z() + s * (a1.z() - a0.z()));
}

} // namespace

double touchingHeight(
  const Surface& surface, const Polyhedron& shape, const Quat& orientation, double x, double y)
{
  const double ground = surface.elevation(x, y);
  if (std::isnan(ground))
  {
    return ground;
  }
  const Vec3 place(x, y, 0.0);
  const Mat3 turn = orientation.toRotationMatrix();
  std::vector<Vec3> vertices, normals;
  for (const Vec3& v : shape.vertices())
  {
    vertices.push_back(turn * v + place);
  }
  for (const Vec3& n : shape.normals())
  {
    normals.push_back(turn * n);
  }
  const double tolerance = 1e-9 * shape.radius();
  // How far the body, with its centroid at height 0, has to be raised for each pair of features.
  double lift = ground - underside(normals, shape.offsets(), 0.0, 0.0, tolerance);
  for (const Vec3& v : vertices)
  {
    const double below = surface.elevation(v.x(), v.y());
    if (!std::isnan(below))
    {
      lift = std::max(lift, below - v.z());
    }
  }
  SurfacePatch patch;
  const double r = shape.radius();
  gatherPatch(surface, x - r, x + r, y - r, y + r, patch);
  for (const SurfacePatch::Node& node : patch.nodes)
  {
    const Vec3& p = node.position;
    if (node.cfe != 0 && std::hypot(p.x() - x, p.y() - y) <= r)
    {
      const double under = underside(normals, shape.offsets(), p.x() - x, p.y() - y, tolerance);
      lift = under > none ? std::max(lift, p.z() - under) : lift;
    }
  }
  for (const SurfacePatch::Ridge& ridge : patch.ridges)
  {
    for (const Polyhedron::Edge& edge : shape.edges())
    {
      lift = std::max(lift,
        above(vertices[std::size_t(edge.vertices[0])], vertices[std::size_t(edge.vertices[1])],
          patch.nodes[std::size_t(ridge.nodes[0])].position,
          patch.nodes[std::size_t(ridge.nodes[1])].position));
    }
  }
  return lift;
}

} // namespace rockfall
