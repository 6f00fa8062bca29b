#include "rock/placement.h"

#include "contact/ground/features.h"
#include "contact/ground/roundContact.h"
#include "geometry/roundBody.h"
#include "law/settings.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

constexpr double none = -std::numeric_limits<double>::infinity();

/// A convex body where it is to stand, its centroid at height 0.
struct Body
{
  const Polyhedron& shape;
  double x, y;
  std::vector<Vec3> vertices;
  std::vector<Vec3> normals;
  std::vector<double> offsets;

  /// `scale`: about its centroid.
  Body(const Polyhedron& polyhedron, const Mat3& turn, double atX, double atY, double scale)
    : shape(polyhedron)
    , x(atX)
    , y(atY)
  {
    for (const Vec3& v : shape.vertices())
    {
      vertices.push_back(turn * (scale * v) + Vec3(x, y, 0.0));
    }
    for (const Vec3& n : shape.normals())
    {
      normals.push_back(turn * n);
    }
    for (const double offset : shape.offsets())
    {
      offsets.push_back(scale * offset);
    }
  }

  /// z of the underside at a place; −∞ outside of the outline.
  double underside(double atX, double atY) const
  {
    const double tolerance = 1e-9 * shape.radius();
    double lower = none, upper = -none;
    for (std::size_t face = 0; face < normals.size(); ++face)
    {
      const Vec3& n = normals[face];
      const double rest = offsets[face] - n.x() * (atX - x) - n.y() * (atY - y);
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
};

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

/// How far the body has to be raised for its edges over the straight line between two points of the
/// ground; −∞ if there are none over it.
double liftOverLine(const Body& body, const Vec3& a, const Vec3& b)
{
  double lift = none;
  const double r = body.shape.radius();
  if (std::min(a.x(), b.x()) > body.x + r || std::max(a.x(), b.x()) < body.x - r ||
    std::min(a.y(), b.y()) > body.y + r || std::max(a.y(), b.y()) < body.y - r)
  {
    return lift;
  }
  for (const Polyhedron::Edge& edge : body.shape.edges())
  {
    lift = std::max(lift,
      above(body.vertices[std::size_t(edge.vertices[0])],
        body.vertices[std::size_t(edge.vertices[1])], a, b));
  }
  return lift;
}

/// How far the body has to be raised for its faces over the nodes of a patch and for its edges over
/// the ridges, which the rims of holes are, too; −∞ if there are none under it.
double liftOverNodesAndEdges(const Body& body, const SurfacePatch& patch)
{
  double lift = none;
  const double r = body.shape.radius();
  for (const SurfacePatch::Node& node : patch.nodes)
  {
    const Vec3& p = node.position;
    if (node.cfe != 0 && std::hypot(p.x() - body.x, p.y() - body.y) <= r)
    {
      const double under = body.underside(p.x(), p.y());
      lift = under > none ? std::max(lift, p.z() - under) : lift;
    }
  }
  for (const SurfacePatch::Ridge& ridge : patch.ridges)
  {
    lift = std::max(lift,
      liftOverLine(body, patch.nodes[std::size_t(ridge.nodes[0])].position,
        patch.nodes[std::size_t(ridge.nodes[1])].position));
  }
  return lift;
}

/// The same for its vertices over the triangles.
double liftOverTriangles(const Body& body, const SurfacePatch& patch)
{
  double lift = none;
  const double r = body.shape.radius();
  for (const SurfacePatch::Triangle& t : patch.triangles)
  {
    if (t.cfe == 0 || t.normal.z() < kUpright)
    {
      continue;
    }
    const Vec3& a = patch.nodes[std::size_t(t.nodes[0])].position;
    const Vec3& b = patch.nodes[std::size_t(t.nodes[1])].position;
    const Vec3& c = patch.nodes[std::size_t(t.nodes[2])].position;
    const Vec3 most = a.cwiseMax(b).cwiseMax(c), least = a.cwiseMin(b).cwiseMin(c);
    if (least.x() > body.x + r || most.x() < body.x - r || least.y() > body.y + r ||
      most.y() < body.y - r)
    {
      continue;
    }
    for (const Vec3& v : body.vertices)
    {
      if (isStraightOver(patch, t, v))
      {
        const double z = a.z() - (t.normal.head<2>().dot((v - a).head<2>())) / t.normal.z();
        lift = std::max(lift, std::clamp(z, least.z(), most.z()) - v.z());
      }
    }
  }
  return lift;
}

/// How high the centre of a round body with these axes is where it touches; −∞ if it misses all.
double roundHeight(const Mat3& axes, double x, double y, const SurfacePatch& patch)
{
  double height = none;
  for (const SurfacePatch::Triangle& t : patch.triangles)
  {
    if (t.cfe != 0)
    {
      const auto corner = [&](int k) { return patch.nodes[std::size_t(t.nodes[k])].position; };
      height = std::max(height, -roundDrop(axes, Vec3(x, y, 0.0), corner(0), corner(1), corner(2)));
    }
  }
  return height;
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
  SurfacePatch patch;
  const double r = shape.radius();
  gatherPatch(surface, x - r, x + r, y - r, y + r, patch);
  if (isRound(shape.layout()))
  {
    return roundHeight(orientation.toRotationMatrix() * roundAxes(shape.layout()), x, y, patch);
  }
  const Body body(shape, orientation.toRotationMatrix(), x, y, 1.0);
  double lift = ground - body.underside(x, y);
  for (const Vec3& v : body.vertices)
  {
    const double below = surface.elevation(v.x(), v.y());
    if (!std::isnan(below))
    {
      lift = std::max(lift, below - v.z());
    }
  }
  return std::max(lift, liftOverNodesAndEdges(body, patch));
}

double startRounding(double z, double radius)
{
  // Half a unit in the last place for the slope and one for the rock, and as much again.
  return std::min(2.0 * FLT_EPSILON * std::max(1.0, std::abs(z)), 1e-3 * radius);
}

double liftOut(const PlacedBlock& rock, const SurfacePatch& patch)
{
  // Beside an upright wall rounding must not decide between nothing and all of its height, so the
  // rock is taken a hair smaller than it is.
  const double x = rock.position().x(), y = rock.position().y();
  double height = none;
  if (isRound(rock))
  {
    height = roundHeight((1.0 - kTouch) * roundAxes(rock), x, y, patch);
  }
  else
  {
    const Body body(rock.block().shape(), rock.rotation(), x, y, 1.0 - kTouch);
    height = std::max(liftOverNodesAndEdges(body, patch), liftOverTriangles(body, patch));
  }
  const double lift = height - rock.position().z();
  return lift > kTouch * rock.block().radius() ? lift : 0.0;
}

} // namespace rockfall
