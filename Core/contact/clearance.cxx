#include "contact/Contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// Smallest t ≥ 0 with rate·t + ½ g t² = distance (rate may be negative: receding).
double timeToCover(double distance, double rate, double acceleration)
{
  if (distance <= 0.0)
  {
    return 0.0;
  }
  if (acceleration <= 0.0)
  {
    return rate > 0.0 ? distance / rate : std::numeric_limits<double>::infinity();
  }
  const double root = std::sqrt(rate * rate + 2.0 * acceleration * distance);
  return rate > 0.0 ? 2.0 * distance / (rate + root) : (root - rate) / acceleration;
}

} // namespace

Clearance clearance(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  double gravity)
{
  Clearance result;
  result.distance = std::numeric_limits<double>::infinity();
  result.time = std::numeric_limits<double>::infinity();
  const Vec3& v = state.velocity;
  const double speed = v.norm();
  // |ω| is not constant for unequal moments, but bounded by |L| / Imin.
  const double spin = rock.block().isotropic()
    ? state.spin.norm()
    : (rock.block().inertia() * state.spin).norm() * rock.block().inverseInertia().norm();
  const double rim = spin * rock.block().radius();
  const Polyhedron& shape = rock.block().shape();
  for (const SurfacePatch::Triangle& t : patch.triangles)
  {
    if (t.cfe == 0)
    {
      continue;
    }
    double distance = std::numeric_limits<double>::infinity();
    for (const Vec3& p : rock.vertices())
    {
      distance = std::min(distance, t.normal.dot(p) - t.offset);
    }
    double time =
      timeToCover(distance, rim - t.normal.dot(v), gravity * std::max(0.0, t.normal.z()));
    if (distance <= 0.0 || time < 1.0)
    {
      // Perhaps a face of the rock, or its bounding box, separates better.
      Vec3 nodes[3];
      double farthest = 0.0;
      for (int k = 0; k < 3; ++k)
      {
        nodes[k] = patch.nodes[t.nodes[k]].position;
        farthest = std::max(farthest, (nodes[k] - rock.position()).norm());
      }
      for (int f = 0; f < int(shape.faces().size()); ++f)
      {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& q : nodes)
        {
          nearest = std::min(nearest, rock.faceDistance(f, q));
        }
        // Seen from the rock a node moves with −v and the rock's rotation.
        const double other = timeToCover(nearest, speed + spin * farthest, gravity);
        time = std::max(time, other);
        distance = std::max(distance, nearest);
      }
      for (int axis = 0; axis < 3; ++axis)
      {
        const double low = std::min({ nodes[0][axis], nodes[1][axis], nodes[2][axis] });
        const double high = std::max({ nodes[0][axis], nodes[1][axis], nodes[2][axis] });
        const double pull = axis == 2 ? gravity : 0.0;
        time = std::max(time, timeToCover(rock.lower()[axis] - high, rim - v[axis], pull));
        time = std::max(time, timeToCover(low - rock.upper()[axis], rim + v[axis], 0.0));
        distance = std::max({ distance, rock.lower()[axis] - high, low - rock.upper()[axis] });
      }
    }
    result.distance = std::min(result.distance, distance);
    result.time = std::min(result.time, time);
  }
  return result;
}

namespace
{

/// Calls visit(vertex, triangle, distance) for every rock vertex straight above or below a triangle,
/// and visit of a peak with the face of the rock that it is least deep under.
template <typename Vertex, typename Peak>
void visitOverlaps(
  const PlacedBlock& rock, const SurfacePatch& patch, Vertex&& onVertex, Peak&& onPeak)
{
  for (int i = 0; i < int(patch.triangles.size()); ++i)
  {
    const SurfacePatch::Triangle& t = patch.triangles[i];
    if (t.cfe == 0)
    {
      continue;
    }
    const Vec3& a = patch.nodes[t.nodes[0]].position;
    const Vec3& b = patch.nodes[t.nodes[1]].position;
    const Vec3& c = patch.nodes[t.nodes[2]].position;
    for (int v = 0; v < int(rock.vertices().size()); ++v)
    {
      const Vec3& p = rock.vertices()[v];
      const auto side = [&](const Vec3& u, const Vec3& w)
      { return (w.x() - u.x()) * (p.y() - u.y()) - (w.y() - u.y()) * (p.x() - u.x()); };
      if (side(a, b) >= 0.0 && side(b, c) >= 0.0 && side(c, a) >= 0.0)
      {
        onVertex(v, i, t.normal.dot(p) - t.offset);
      }
    }
  }
  for (int n = 0; n < int(patch.nodes.size()); ++n)
  {
    if (!patch.nodes[n].peak)
    {
      continue;
    }
    double outside = -std::numeric_limits<double>::infinity();
    int face = 0;
    for (int f = 0; f < int(rock.normals().size()); ++f)
    {
      const double d = rock.faceDistance(f, patch.nodes[n].position);
      if (d > outside)
      {
        outside = d;
        face = f;
      }
    }
    onPeak(n, face, outside);
  }
}

} // namespace

double penetration(const PlacedBlock& rock, const SurfacePatch& patch)
{
  double deepest = 0.0;
  const auto deeper = [&](int, int, double distance) { deepest = std::max(deepest, -distance); };
  visitOverlaps(rock, patch, deeper, deeper);
  return deepest;
}

void holdOverlap(
  const PlacedBlock& rock, const SurfacePatch& patch, std::vector<Contact>& contacts)
{
  const auto add = [&](ContactKind kind, int onRock, int onPatch, double distance)
  {
    if (distance >= 0.0)
    {
      return;
    }
    Contact c;
    c.kind = kind;
    c.rockFeature = onRock;
    c.patchFeature = onPatch;
    c.distance = distance;
    c.offset = distance;
    if (kind == ContactKind::VertexFace)
    {
      c.cfe = patch.triangles[onPatch].cfe;
      c.surfaceFeature = c.cfe;
      c.normal = patch.triangles[onPatch].normal;
      c.point = rock.vertices()[onRock];
    }
    else
    {
      c.cfe = patch.nodes[onPatch].cfe;
      c.surfaceFeature = patch.nodes[onPatch].key;
      c.normal = -rock.normals()[onRock];
      c.point = patch.nodes[onPatch].position;
    }
    const bool known = std::any_of(contacts.begin(), contacts.end(), [&](const Contact& o)
      { return o.kind == c.kind && o.rockFeature == c.rockFeature; });
    if (!known)
    {
      contacts.push_back(c);
    }
  };
  visitOverlaps(
    rock, patch, [&](int v, int t, double d) { add(ContactKind::VertexFace, v, t, d); },
    [&](int n, int f, double d)
    {
      // A face that looks up is no way out of the ground.
      if (rock.normals()[f].z() < 0.0)
      {
        add(ContactKind::FaceVertex, f, n, d);
      }
    });
}

} // namespace rockfall
