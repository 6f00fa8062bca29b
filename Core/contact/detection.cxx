#include "contact/Contact.h"

#include "contact/features.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rockfall
{

namespace
{

/// Across an edge that bends by less than this the nearer of the two planes is the exit: the depth is
/// then continuous when a vertex crosses the edge. Across a sharper edge the exit stays the entrance.
constexpr double kSmoothTurn = 0.5; // cosine

bool samePlace(const Contact& a, const Contact& b)
{
  return a.kind == b.kind && a.rockFeature == b.rockFeature &&
    a.surfaceFeature == b.surfaceFeature;
}

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

bool refreshEdgeEdge(const PlacedBlock& rock, const SurfacePatch& patch, Contact& contact)
{
  const Polyhedron::Edge& e = rock.block().shape().edges()[contact.rockFeature];
  const SurfacePatch::Ridge& g = patch.ridges[contact.patchFeature];
  const Vec3& p = rock.vertices()[e.vertices[0]];
  const Vec3& q = patch.nodes[g.nodes[0]].position;
  const Vec3 u = rock.vertices()[e.vertices[1]] - p;
  const Vec3 w = patch.nodes[g.nodes[1]].position - q;
  double s, t;
  if (!closestOnLines(p, u, q, w, s, t))
  {
    // Nearly parallel: the normal of the last step still separates the two lines.
    contact.distance = contact.normal.dot(contact.point - q);
    return std::abs(contact.normal.dot(u)) < 0.1 * u.norm();
  }
  // Past an end the vertex or node there has a contact of its own.
  if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0)
  {
    return false;
  }
  Vec3 n = u.cross(w).normalized();
  if (n.dot(contact.normal) < 0.0)
  {
    n = -n;
  }
  contact.point = p + s * u;
  contact.distance = n.dot(contact.point - (q + t * w));
  contact.normal = n;
  return true;
}

bool refresh(const PlacedBlock& rock, const SurfacePatch& patch, Contact& contact)
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

/// Adds an entrance unless the contacts that are already there stand for it.
void admit(const SurfacePatch& patch, Contact candidate, std::vector<Contact>& contacts)
{
  for (const Contact& c : contacts)
  {
    if (samePlace(c, candidate))
    {
      return;
    }
    if (candidate.kind != ContactKind::VertexFace || c.kind != ContactKind::VertexFace ||
      c.rockFeature != candidate.rockFeature)
    {
      continue;
    }
    // The same vertex on two triangles: both count across a valley, one across a ridge or a flat edge.
    const SurfacePatch::Triangle& t = patch.triangles[candidate.patchFeature];
    bool valley = false, adjacent = false;
    for (int k = 0; k < 3; ++k)
    {
      if (t.neighbours[k] == c.patchFeature)
      {
        adjacent = true;
        valley = t.bends[k] < 0;
      }
    }
    const bool sameNormal = c.normal.dot(candidate.normal) > 1.0 - 1e-12;
    if (sameNormal || (adjacent && !valley))
    {
      return;
    }
    if (!adjacent && c.distance < 0.0 && candidate.distance < c.distance)
    {
      return; // deeper under a triangle further off: not where it came in
    }
  }
  candidate.offset = std::min(0.0, candidate.distance);
  contacts.push_back(candidate);
}

/// Triangles, peaks and ridges that the rock's bounding box can meet, by their own boxes.
bool boxesMeet(const Vec3& lower, const Vec3& upper, const Vec3& a, const Vec3& b, double reach)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (std::min(a[axis], b[axis]) > upper[axis] + reach ||
      std::max(a[axis], b[axis]) < lower[axis] - reach)
    {
      return false;
    }
  }
  return true;
}

} // namespace

void updateContacts(const PlacedBlock& rock, const SurfacePatch& patch, double reach,
  std::vector<Contact>& contacts)
{
  // What carries stays, as long as it is somewhere.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i)
  {
    Contact c = contacts[i];
    if (!c.closed() || !refresh(rock, patch, c))
    {
      continue;
    }
    const bool twin = std::any_of(contacts.begin(), contacts.begin() + kept,
      [&](const Contact& other) { return samePlace(other, c); });
    if (!twin)
    {
      contacts[kept++] = c;
    }
  }
  contacts.resize(kept);

  const Polyhedron& shape = rock.block().shape();
  const Vec3 lower = rock.lower(), upper = rock.upper();
  for (int i = 0; i < int(patch.triangles.size()); ++i)
  {
    const SurfacePatch::Triangle& t = patch.triangles[i];
    if (t.cfe == 0)
    {
      continue;
    }
    // The box's lowest corner along the normal bounds all vertices.
    const Vec3 corner = (t.normal.array() > 0.0).select(lower, upper);
    if (t.normal.dot(corner) - t.offset > reach)
    {
      continue;
    }
    const Vec3& a = patch.nodes[t.nodes[0]].position;
    const Vec3& b = patch.nodes[t.nodes[1]].position;
    const Vec3& d = patch.nodes[t.nodes[2]].position;
    if (!boxesMeet(lower, upper, a.cwiseMin(b).cwiseMin(d), a.cwiseMax(b).cwiseMax(d), reach))
    {
      continue;
    }
    for (int v = 0; v < int(rock.vertices().size()); ++v)
    {
      if (t.normal.dot(rock.vertices()[v]) - t.offset <= reach)
      {
        if (auto c = vertexFace(rock, v, patch, i, reach))
        {
          admit(patch, *c, contacts);
        }
      }
    }
  }
  for (int i = 0; i < int(patch.nodes.size()); ++i)
  {
    const SurfacePatch::Node& q = patch.nodes[i];
    if (!q.peak || !boxesMeet(lower, upper, q.position, q.position, reach))
    {
      continue;
    }
    // Only the face over which the node is farthest out can be the entrance.
    int face = -1;
    double farthest = -1e300;
    for (int f = 0; f < int(shape.faces().size()); ++f)
    {
      const double d = rock.faceDistance(f, q.position);
      if (d > farthest)
      {
        farthest = d;
        face = f;
      }
    }
    if (farthest <= reach)
    {
      if (auto c = faceVertex(rock, face, patch, i, reach))
      {
        admit(patch, *c, contacts);
      }
    }
  }
  for (int i = 0; i < int(patch.ridges.size()); ++i)
  {
    const SurfacePatch::Ridge& g = patch.ridges[i];
    const Vec3& q0 = patch.nodes[g.nodes[0]].position;
    const Vec3& q1 = patch.nodes[g.nodes[1]].position;
    if (!boxesMeet(lower, upper, q0, q1, reach))
    {
      continue;
    }
    // A face of the rock with the whole ridge outside of it separates the two.
    bool apart = false;
    for (int f = 0; f < int(shape.faces().size()) && !apart; ++f)
    {
      apart = rock.faceDistance(f, q0) > reach && rock.faceDistance(f, q1) > reach;
    }
    for (int e = 0; e < int(shape.edges().size()) && !apart; ++e)
    {
      if (auto c = edgeEdge(rock, e, patch, i, reach))
      {
        admit(patch, *c, contacts);
      }
    }
  }
}

void findEntrancesBruteForce(const PlacedBlock& rock, const SurfacePatch& patch, double reach,
  std::vector<Contact>& contacts)
{
  const Polyhedron& shape = rock.block().shape();
  for (int i = 0; i < int(patch.triangles.size()); ++i)
  {
    for (int v = 0; v < int(rock.vertices().size()) && patch.triangles[i].cfe != 0; ++v)
    {
      if (auto c = vertexFace(rock, v, patch, i, reach))
      {
        admit(patch, *c, contacts);
      }
    }
  }
  for (int i = 0; i < int(patch.nodes.size()); ++i)
  {
    for (int f = 0; f < int(shape.faces().size()); ++f)
    {
      if (auto c = faceVertex(rock, f, patch, i, reach))
      {
        admit(patch, *c, contacts);
      }
    }
  }
  for (int i = 0; i < int(patch.ridges.size()); ++i)
  {
    for (int e = 0; e < int(shape.edges().size()); ++e)
    {
      if (auto c = edgeEdge(rock, e, patch, i, reach))
      {
        admit(patch, *c, contacts);
      }
    }
  }
}

} // namespace rockfall
