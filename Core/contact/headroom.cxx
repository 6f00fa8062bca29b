#include "contact/headroom.h"

#include <algorithm>
#include <limits>

namespace rockfall
{

namespace
{

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Height by which a triangle may rise until it passes the plane with this `normal` (unit, out of
/// the ground) that is `away` (m) from it.
double riseTo(double away, const Vec3& normal)
{
  if (away >= 0.0)
  {
    return normal.z() > 0.0 ? away / normal.z() : kUnlimited;
  }
  return away;
}

} // namespace

double headroom(const PlacedBlock& rock, const SurfacePatch& patch, double enough)
{
  double least = enough;
  const Vec3 lower = rock.lower(), upper = rock.upper();
  const Polyhedron& shape = rock.block().shape();
  for (const SurfacePatch::Triangle& t : patch.triangles)
  {
    if (t.cfe == 0)
    {
      continue;
    }
    const Vec3& a = patch.nodes[t.nodes[0]].position;
    const Vec3& b = patch.nodes[t.nodes[1]].position;
    const Vec3& c = patch.nodes[t.nodes[2]].position;
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    if (low.x() > upper.x() || high.x() < lower.x() || low.y() > upper.y() ||
      high.y() < lower.y())
    {
      continue; // passes it
    }
    double room = lower.z() - high.z();
    if (room < least)
    {
      double along = kUnlimited;
      for (const Vec3& p : rock.vertices())
      {
        along = std::min(along, t.normal.dot(p));
      }
      room = std::max(room, riseTo(along - t.offset, t.normal));
    }
    for (std::size_t f = 0; room < least && f < shape.normals().size(); ++f)
    {
      const Vec3 n = -rock.normal(int(f));
      const double face = n.dot(rock.vertices()[std::size_t(shape.faces()[f][0])]);
      room = std::max(room, riseTo(face - std::max({ n.dot(a), n.dot(b), n.dot(c) }), n));
    }
    least = std::min(least, room);
  }
  return least;
}

} // namespace rockfall
