#include "contact/ground/contactTransfer.h"

#include "contact/ground/features.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// The spring keeps its compression, and so its force and energy, when a contact goes over to a
/// neighbouring feature.
void handOver(Contact& contact, double newDistance)
{
  const double gap = contact.gap();
  contact.distance = newDistance;
  contact.offset = newDistance - gap;
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
      return match(patch.triangles, [](const SurfacePatch::Triangle& t) { return t.key; });
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
        return false; // beyond the edge of the patch
      }
      // In a valley a vertex that is under this wall is beside it, seen square, and may be over the
      // plane of the other one, which does not hold it.
      const auto isUnder = [&]
      {
        return contact.distance < 0.0 && contact.patchFeature < patch.slopeTriangles &&
          isStraightOver(patch, t, p);
      };
      if (outside && (t.bends[k] >= 0 || (distanceTo(g) > 0.0 && !isUnder())))
      {
        next = g;
      }
      else if (!outside && g >= 0 && t.bends[k] > 0 && contact.distance < 0.0)
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
    contact.surfaceFeature = t1.key;
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
  const double compression = std::max(0.0, -contact.gap());
  contact.point = q;
  contact.distance = rock.faceDistance(contact.rockFeature, q);
  for (std::size_t f = 0; f < rock.block().shape().faces().size(); ++f)
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
    else if (d > kRunOff * compression)
    {
      return false; // left the rock through its side
    }
  }
  contact.normal = -rock.normal(contact.rockFeature);
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
  double lengths[2] = { 0.0, 0.0 }; ///< Of the edge and of the ridge, m.

  /// How far the crossing is past an end, m; ≤ 0 within both.
  double beyond() const
  {
    return std::max(std::max(-this->s, this->s - 1.0) * this->lengths[0],
      std::max(-this->t, this->t - 1.0) * this->lengths[1]);
  }
};

Crossing crossing(
  const PlacedBlock& rock, int edge, const SurfacePatch& patch, int ridge, const Vec3& towards)
{
  const Polyhedron::Edge& e = rock.block().shape().edges()[edge];
  const SurfacePatch::Ridge& g = patch.ridges[ridge];
  const Vec3& p = rock.vertices()[e.vertices[0]];
  const Vec3& q = patch.nodes[g.nodes[0]].position;
  const Vec3 u = rock.vertices()[e.vertices[1]] - p;
  const Vec3 w = patch.nodes[g.nodes[1]].position - q;
  Crossing c;
  c.lengths[0] = u.norm();
  c.lengths[1] = w.norm();
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

/// The way out of an overlap at an edge–edge contact. The pairs of the ridge's wedge with the edges
/// and vertices of the rock around it are faces of one Minkowski difference of convex bodies; the
/// one that is least deep is the shortest exit and takes the load over as soon as it is no deeper
/// than the old one, so that the depth is continuous. Until then the old crossing serves, even
/// somewhat past the end of its edge.
class WayOut
{
public:
  WayOut(
    const PlacedBlock& rock, const SurfacePatch& patch, const Crossing& at, const Contact& contact)
    : rock_(rock)
    , patch_(patch)
    , at_(at)
    , contact_(contact)
    , edge_(rock.block().shape().edges()[contact.rockFeature])
    , ridge_(patch.ridges[contact.patchFeature])
    , same_(1e-9 * rock.block().radius())
    , reach_(-kEdgeExtension * contact.distance)
    , best_(contact)
  {
  }

  /// Takes the best one; false if nothing holds the contact any longer.
  bool take(Contact& contact)
  {
    this->offerEdges();
    this->offerVertices();
    if (at_.t < 0.0 || at_.t > 1.0)
    {
      this->offerBeyondEnd();
    }
    const bool better = highest_ > contact.distance + same_;
    const bool goesOn = highest_ > contact.distance - same_ && beyond_ < at_.beyond();
    if (!better && !goesOn && at_.beyond() <= reach_)
    {
      contact.normal = at_.normal;
      contact.point = at_.point;
      return true;
    }
    if (std::isinf(highest_) || highest_ > 0.0)
    {
      // Nothing takes it over: it goes on along the lines produced until its spring has given way.
      contact.normal = at_.normal;
      contact.point = at_.point;
      return at_.beyond() <= kRunOff * std::max(0.0, -contact.gap());
    }
    contact = best_;
    return true;
  }

private:
  /// A pair that may take over, with its gap and how far it is past the end of a feature, m.
  struct Offer
  {
    ContactKind kind;
    int onRock, onPatch;
    std::int64_t key, cfe;
    Vec3 normal, point;
    double distance, beyond;
  };

  void offer(const Offer& of)
  {
    const bool tie = std::abs(of.distance - highest_) <= same_ && of.beyond < beyond_;
    const bool onSlope = contact_.patchFeature < patch_.slopeRidges; // obstacles have upright sides
    if ((onSlope && of.normal.z() <= 0.0) || of.normal.dot(contact_.normal) < kSmoothTurn ||
      !(of.distance > highest_ + same_ || tie))
    {
      return;
    }
    highest_ = of.distance;
    beyond_ = of.beyond;
    best_ = contact_;
    best_.kind = of.kind;
    best_.rockFeature = of.onRock;
    best_.patchFeature = of.onPatch;
    best_.surfaceFeature = of.key;
    best_.cfe = of.cfe;
    best_.normal = of.normal;
    best_.point = of.point;
    if (of.kind == ContactKind::EdgeEdge)
    {
      setRidge(patch_, of.onPatch, best_);
    }
    handOver(best_, of.distance);
  }
  void offerCrossing(int edge, int ridge)
  {
    const Crossing c = crossing(rock_, edge, patch_, ridge, contact_.normal);
    if (c.skew && c.beyond() <= reach_ && inEdgeCones(rock_, edge, patch_, ridge, c.normal, 0.0))
    {
      const SurfacePatch::Ridge& r = patch_.ridges[ridge];
      this->offer({ ContactKind::EdgeEdge, edge, ridge, r.key, patch_.triangles[r.triangles[0]].cfe,
        c.normal, c.point, c.distance, c.beyond() });
    }
  }
  /// Other edges of the rock, at the ends of this one.
  void offerEdges()
  {
    const std::vector<Polyhedron::Edge>& edges = rock_.block().shape().edges();
    const std::array<int, 2>& ends = edge_.vertices;
    for (int i = 0; i < int(edges.size()); ++i)
    {
      const std::array<int, 2>& v = edges[i].vertices;
      if (i != contact_.rockFeature &&
        (v[0] == ends[0] || v[1] == ends[0] || v[0] == ends[1] || v[1] == ends[1]))
      {
        this->offerCrossing(i, contact_.patchFeature);
      }
    }
  }
  /// Ends of the edge on the sides of the ridge.
  void offerVertices()
  {
    for (int vertex : edge_.vertices)
    {
      const Vec3& p = rock_.vertices()[vertex];
      for (int i : ridge_.triangles)
      {
        const SurfacePatch::Triangle& t = patch_.triangles[i];
        if (inVertexCone(rock_, vertex, t.normal, 0.0) &&
          projectsInside(patch_, i, p, 0.0, 1e-9 * rock_.block().radius()) &&
          cameThrough(rock_.position(), patch_, i, p, t.normal.dot(p) - t.offset))
        {
          this->offer({ ContactKind::VertexFace, vertex, i, t.key, t.cfe, t.normal, p,
            t.normal.dot(p) - t.offset, 0.0 });
        }
      }
    }
  }
  /// Other features of the slope only where this one ends: around a saddle a ridge that is clear of
  /// the rock says nothing of its neighbour.
  void offerBeyondEnd()
  {
    const int node = ridge_.nodes[at_.t < 0.0 ? 0 : 1];
    for (int i = 0; i < int(patch_.ridges.size()); ++i)
    {
      const std::array<int, 2>& n = patch_.ridges[i].nodes;
      if (i != contact_.patchFeature && (n[0] == node || n[1] == node))
      {
        this->offerCrossing(contact_.rockFeature, i);
      }
    }
    const SurfacePatch::Node& q = patch_.nodes[node];
    for (int f : edge_.faces)
    {
      if (q.peak && inPeakCone(patch_, node, -rock_.normal(f), 0.0) &&
        insideRockFace(rock_, f, q.position, 0.0))
      {
        this->offer({ ContactKind::FaceVertex, f, node, q.key, q.cfe, -rock_.normal(f), q.position,
          rock_.faceDistance(f, q.position), 0.0 });
      }
    }
  }

  const PlacedBlock& rock_;
  const SurfacePatch& patch_;
  const Crossing& at_;
  const Contact contact_; ///< The contact as it was.
  const Polyhedron::Edge& edge_;
  const SurfacePatch::Ridge& ridge_;
  double same_;  ///< Depths that differ by rounding only, m.
  double reach_; ///< Past the end of an edge, m.
  Contact best_;
  double highest_ = -std::numeric_limits<double>::infinity(); ///< Gap of the best, m.
  double beyond_ = 0.0;                                       ///< Way past the end of the edge, m.
};

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
  if (c.distance < 0.0)
  {
    return WayOut(rock, patch, c, contact).take(contact);
  }
  contact.normal = c.normal;
  contact.point = c.point;
  return c.beyond() <= 0.0;
}

} // namespace

bool refreshContact(const PlacedBlock& rock, const SurfacePatch& patch, Contact& contact)
{
  if (!relocate(patch, contact))
  {
    return false;
  }
  // The step has conserved energy with the gap that it predicted; what the turning of edges and
  // faces makes different from it must not change the spring.
  const double gap = contact.gap();
  bool there = false;
  switch (contact.kind)
  {
    case ContactKind::VertexFace:
      there = refreshVertexFace(rock, patch, contact);
      break;
    case ContactKind::FaceVertex:
      there = refreshFaceVertex(rock, patch, contact);
      break;
    case ContactKind::EdgeEdge:
      there = refreshEdgeEdge(rock, patch, contact);
      break;
  }
  contact.offset = contact.distance - gap;
  return there;
}

void joinSprings(Contact& contact, const Contact& other)
{
  const double ratio =
    contact.stiffness > 0.0 ? std::sqrt(other.stiffness / contact.stiffness) : 1.0;
  contact.offset =
    contact.distance + std::hypot(std::min(0.0, contact.gap()), std::min(0.0, other.gap()) * ratio);
}

} // namespace rockfall
