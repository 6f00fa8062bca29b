#include "contact/handover.h"

#include "contact/features.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// Across an edge that bends by less than this the nearer of the two planes is the exit: the depth is
/// then continuous when a vertex crosses the edge. Across a sharper edge the exit stays the entrance.
constexpr double kSmoothTurn = 0.5; // cosine

/// Keeps the force continuous when a contact goes over to a neighbouring feature where it would be
/// deeper; where it would be less deep the spring just gives way.
void handOver(Contact& contact, double newDistance)
{
  const double gap = contact.gap();
  contact.distance = newDistance;
  contact.offset = std::min(0.0, newDistance - std::min(gap, 0.0));
}

/// The same feature in the patch at hand; false if it is not in it.
bool relocate(const SurfacePatch& patch, Contact& contact)
{
  const auto match = [&](const auto& list, auto keyOf)
  {
    if (contact.patchFeature >= 0 && contact.patchFeature < int(list.size()) &&
      keyOf(list[contact.patchFeature]) == contact.surfaceFeature)
    {
      return true;
    }
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      if (keyOf(list[i]) == contact.surfaceFeature)
      {
        contact.patchFeature = int(i);
        return true;
      }
    }
    return false;
  };
  switch (contact.kind)
  {
    case ContactKind::VertexFace:
      return match(patch.triangles, [](const SurfacePatch::Triangle& t) { return t.cfe; });
    case ContactKind::FaceVertex:
      return match(patch.nodes, [](const SurfacePatch::Node& n) { return n.key; });
    case ContactKind::EdgeEdge:
      return match(patch.ridges, [](const SurfacePatch::Ridge& r) { return r.key; });
  }
  return false;
}

/// A rock vertex walks over the triangles that it has come to.
bool refreshVertexFace(const PlacedBlock& rock, const SurfacePatch& patch, Contact& contact)
{
  const Vec3& p = rock.vertices()[contact.rockFeature];
  contact.point = p;
  const auto distanceTo = [&](int triangle)
  { return patch.triangles[triangle].normal.dot(p) - patch.triangles[triangle].offset; };
  contact.distance = distanceTo(contact.patchFeature);
  for (int hop = 0; hop < 16; ++hop)
  {
    const SurfacePatch::Triangle& t = patch.triangles[contact.patchFeature];
    int next = -1;
    for (int k = 0; k < 3 && next < 0; ++k)
    {
      const Vec3& a = patch.nodes[t.nodes[k]].position;
      const Vec3& b = patch.nodes[t.nodes[(k + 1) % 3]].position;
      const bool outside = t.normal.cross(b - a).dot(p - a) < 0.0;
      const int g = t.neighbours[k];
      if (outside && g < 0)
      {
        return false; // beyond the edge of the slope
      }
      if (outside && (t.bends[k] >= 0 || distanceTo(g) > 0.0))
      {
        next = g;
      }
      else if (!outside && t.bends[k] > 0 && contact.distance < 0.0)
      {
        const SurfacePatch::Triangle& other = patch.triangles[g];
        const double d = distanceTo(g);
        if (d > contact.distance && d <= 0.0 && other.normal.dot(t.normal) > kSmoothTurn &&
          projectsInside(patch, g, p, 0.0, 0.0))
        {
          next = g;
        }
      }
    }
    if (next < 0)
    {
      break;
    }
    contact.patchFeature = next;
    const SurfacePatch::Triangle& t1 = patch.triangles[next];
    contact.surfaceFeature = t1.cfe;
    contact.cfe = t1.cfe;
    handOver(contact, distanceTo(next));
    contact.normal = t1.normal;
  }
  return true;
}

/// A peak of the slope moves over the faces of the rock.
bool refreshFaceVertex(const PlacedBlock& rock, const SurfacePatch& patch, Contact& contact)
{
  const Polyhedron& shape = rock.block().shape();
  const Vec3& q = patch.nodes[contact.patchFeature].position;
  contact.point = q;
  contact.distance = rock.faceDistance(contact.rockFeature, q);
  for (std::size_t f = 0; f < rock.normals().size(); ++f)
  {
    const double d = rock.faceDistance(int(f), q);
    if (int(f) == contact.rockFeature || d <= contact.distance)
    {
      continue;
    }
    // The least deep face is the exit, if it is not too far a turn from the entrance.
    if (shape.normals()[f].dot(shape.normals()[contact.rockFeature]) > kSmoothTurn)
    {
      contact.rockFeature = int(f);
      handOver(contact, d);
    }
    else if (d > 0.0)
    {
      return false; // left the rock through its side
    }
  }
  contact.normal = -rock.normals()[contact.rockFeature];
  return true;
}

/// Where a rock edge and a ridge stand to each other.
struct Crossing
{
  bool skew = false; ///< Not nearly parallel.
  double s = 0.0, t = 0.0;
  Vec3 normal = Vec3::UnitZ();
  Vec3 point = Vec3::Zero();
  double distance = 0.0;

  bool within() const
  {
    return this->skew && this->s >= 0.0 && this->s <= 1.0 && this->t >= 0.0 && this->t <= 1.0;
  }
};

Crossing crossing(const PlacedBlock& rock, int edge, const SurfacePatch& patch, int ridge,
  const Vec3& towards)
{
  const Polyhedron::Edge& e = rock.block().shape().edges()[edge];
  const SurfacePatch::Ridge& g = patch.ridges[ridge];
  const Vec3& p = rock.vertices()[e.vertices[0]];
  const Vec3& q = patch.nodes[g.nodes[0]].position;
  const Vec3 u = rock.vertices()[e.vertices[1]] - p;
  const Vec3 w = patch.nodes[g.nodes[1]].position - q;
  Crossing c;
  c.skew = closestOnLines(p, u, q, w, c.s, c.t);
  if (c.skew)
  {
    c.normal = u.cross(w).normalized();
    if (c.normal.dot(towards) < 0.0)
    {
      c.normal = -c.normal;
    }
    c.point = p + c.s * u;
    c.distance = c.normal.dot(c.point - (q + c.t * w));
  }
  return c;
}

/// A crossing that has run off the end of the rock's edge or of the ridge goes on along the features
/// that meet there: the next ridge, the next edge, the vertex in a CFE, the node in a face. The one
/// whose depth is nearest takes the load over.
bool continueEdgeEdge(const PlacedBlock& rock, const SurfacePatch& patch, const Crossing& at,
  Contact& contact)
{
  const Polyhedron& shape = rock.block().shape();
  const Polyhedron::Edge& e = shape.edges()[contact.rockFeature];
  const SurfacePatch::Ridge& g = patch.ridges[contact.patchFeature];
  const double before = contact.distance;
  Contact best = contact;
  double nearest = std::numeric_limits<double>::infinity();
  const auto offer = [&](ContactKind kind, int onRock, int onPatch, std::int64_t key,
                       std::int64_t cfe, const Vec3& normal, const Vec3& point, double distance)
  {
    const double miss = std::abs(distance - before);
    if (distance > 0.0 || normal.dot(contact.normal) < kSmoothTurn || miss >= nearest)
    {
      return;
    }
    nearest = miss;
    best = contact;
    best.kind = kind;
    best.rockFeature = onRock;
    best.patchFeature = onPatch;
    best.surfaceFeature = key;
    best.cfe = cfe;
    best.normal = normal;
    best.point = point;
    handOver(best, distance);
  };
  const auto offerCrossing = [&](int edge, int ridge)
  {
    const Crossing c = crossing(rock, edge, patch, ridge, contact.normal);
    if (c.within())
    {
      const SurfacePatch::Ridge& r = patch.ridges[ridge];
      offer(ContactKind::EdgeEdge, edge, ridge, r.key, patch.triangles[r.triangles[0]].cfe,
        c.normal, c.point, c.distance);
    }
  };
  if (at.t < 0.0 || at.t > 1.0)
  {
    const int node = g.nodes[at.t < 0.0 ? 0 : 1];
    for (int i = 0; i < int(patch.ridges.size()); ++i)
    {
      const SurfacePatch::Ridge& other = patch.ridges[i];
      if (i != contact.patchFeature && (other.nodes[0] == node || other.nodes[1] == node))
      {
        offerCrossing(contact.rockFeature, i);
      }
    }
    const SurfacePatch::Node& q = patch.nodes[node];
    for (int f : e.faces)
    {
      if (insideRockFace(rock, f, q.position, 0.0))
      {
        offer(ContactKind::FaceVertex, f, node, q.key, q.cfe, -rock.normals()[f], q.position,
          rock.faceDistance(f, q.position));
      }
    }
  }
  if (at.s < 0.0 || at.s > 1.0)
  {
    const int vertex = e.vertices[at.s < 0.0 ? 0 : 1];
    for (int i = 0; i < int(shape.edges().size()); ++i)
    {
      const Polyhedron::Edge& other = shape.edges()[i];
      if (i != contact.rockFeature && (other.vertices[0] == vertex || other.vertices[1] == vertex))
      {
        offerCrossing(i, contact.patchFeature);
      }
    }
    const Vec3& p = rock.vertices()[vertex];
    for (int i : g.triangles)
    {
      const SurfacePatch::Triangle& t = patch.triangles[i];
      if (projectsInside(patch, i, p, 0.0, 1e-9 * rock.block().radius()))
      {
        offer(ContactKind::VertexFace, vertex, i, t.cfe, t.cfe, t.normal, p,
          t.normal.dot(p) - t.offset);
      }
    }
  }
  contact = best;
  return !std::isinf(nearest);
}

bool refreshEdgeEdge(const PlacedBlock& rock, const SurfacePatch& patch, Contact& contact)
{
  const Crossing c =
    crossing(rock, contact.rockFeature, patch, contact.patchFeature, contact.normal);
  if (!c.skew)
  {
    // Nearly parallel: the normal of the last step still separates the two lines.
    const Polyhedron::Edge& e = rock.block().shape().edges()[contact.rockFeature];
    const Vec3 u = rock.vertices()[e.vertices[1]] - rock.vertices()[e.vertices[0]];
    const Vec3& q = patch.nodes[patch.ridges[contact.patchFeature].nodes[0]].position;
    contact.distance = contact.normal.dot(rock.vertices()[e.vertices[0]] - q);
    return std::abs(contact.normal.dot(u)) < 0.1 * u.norm();
  }
  contact.distance = c.distance;
  if (!c.within())
  {
    return continueEdgeEdge(rock, patch, c, contact);
  }
  contact.normal = c.normal;
  contact.point = c.point;
  return true;
}

} // namespace

bool refreshContact(const PlacedBlock& rock, const SurfacePatch& patch, Contact& contact)
{
  if (!relocate(patch, contact))
  {
    return false;
  }
  switch (contact.kind)
  {
    case ContactKind::VertexFace:
      return refreshVertexFace(rock, patch, contact);
    case ContactKind::FaceVertex:
      return refreshFaceVertex(rock, patch, contact);
    case ContactKind::EdgeEdge:
      return refreshEdgeEdge(rock, patch, contact);
  }
  return false;
}

} // namespace rockfall
