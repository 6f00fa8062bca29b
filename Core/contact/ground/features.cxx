#include "contact/ground/features.h"

#include "law/settings.h"

#include <algorithm>

namespace rockfall
{

namespace
{

/// Deeper, a feature belongs to the far side of what has come in elsewhere, m.
double deepestEntrance(const Block& block)
{
  return std::min(kDeepestEntrance * block.radius(), kDeepestEntranceOfThin * block.thickness());
}

} // namespace

bool projectsInside(const SurfacePatch& patch, int triangle, const Vec3& point, double reach,
  double tolerance, int from)
{
  const SurfacePatch::Triangle& t = patch.triangles[triangle];
  for (int k = 0; k < 3; ++k)
  {
    const Vec3& a = patch.nodes[t.nodes[k]].position;
    const Vec3& b = patch.nodes[t.nodes[(k + 1) % 3]].position;
    const Vec3 along = b - a;
    const Vec3 inward = t.normal.cross(along);
    const double side = inward.dot(point - a); // distance from the edge times its length
    if (side >= 0.0)
    {
      continue;
    }
    const double length = along.norm();
    if (side < -tolerance * length && !(t.bends[k] < 0 && side > -reach * length) &&
      !(from >= 0 && t.neighbours[k] == from))
    {
      return false;
    }
  }
  return true;
}

bool isStraightOver(const SurfacePatch& patch, const SurfacePatch::Triangle& t, const Vec3& p)
{
  for (int k = 0; k < 3; ++k)
  {
    const Vec3& a = patch.nodes[t.nodes[k]].position;
    const Vec3& b = patch.nodes[t.nodes[(k + 1) % 3]].position;
    if ((b.x() - a.x()) * (p.y() - a.y()) < (b.y() - a.y()) * (p.x() - a.x()))
    {
      return false;
    }
  }
  return true;
}

bool cameThrough(
  const Vec3& from, const SurfacePatch& patch, int triangle, const Vec3& point, double distance)
{
  const int walls = patch.slopeTriangles + patch.wallTriangles;
  if (distance >= 0.0)
  {
    return true;
  }
  if (triangle >= walls)
  {
    // A rock before a thin obstacle is behind the far side of it, too.
    const SurfacePatch::Triangle& t = patch.triangles[triangle];
    return t.normal.dot(from) > t.offset;
  }
  if (patch.wallTriangles == 0)
  {
    return true;
  }
  const int ground = patch.triangleAt(point.x(), point.y());
  if (ground < 0)
  {
    return false;
  }
  if (patch.isWall(triangle))
  {
    const SurfacePatch::Triangle& t = patch.triangles[ground];
    return t.normal.dot(point) - t.offset <= distance;
  }
  for (int i = patch.slopeTriangles; i < walls; ++i)
  {
    const SurfacePatch::Triangle& t = patch.triangles[i];
    const double beside = t.normal.dot(point) - t.offset;
    if (beside > distance && beside <= 0.0 && projectsInside(patch, i, point, 0.0, 0.0))
    {
      return false;
    }
  }
  return true;
}

bool cameAcross(const PlacedBlock& rock, const SurfacePatch& patch, int ridge, double distance)
{
  const SurfacePatch::Ridge& g = patch.ridges[ridge];
  if (distance >= 0.0 || !patch.isWall(g.triangles[0]) || !patch.isWall(g.triangles[1]))
  {
    return true;
  }
  // All of the ridge is farther from a face that looks down than its top is.
  const Vec3& top = patch.nodes[g.nodes[0]].position;
  const int faces = int(rock.block().shape().faces().size());
  for (int f = 0; f < faces; ++f)
  {
    if (rock.normal(f).z() < 0.0 && rock.faceDistance(f, top) > distance)
    {
      return false;
    }
  }
  return true;
}

bool inVertexCone(const PlacedBlock& rock, int vertex, const Vec3& normal, double slack)
{
  // The vertex must be the lowest of its surroundings along the normal.
  const Vec3& p = rock.vertices()[vertex];
  for (int n : rock.block().shape().neighbours(vertex))
  {
    const Vec3 arm = rock.vertices()[n] - p;
    if (normal.dot(arm) < -slack * arm.norm())
    {
      return false;
    }
  }
  return true;
}

bool inPeakCone(const SurfacePatch& patch, int node, const Vec3& normal, double slack)
{
  // All of the slope around the node must fall away from the plane of the face.
  const SurfacePatch::Node& q = patch.nodes[node];
  for (int n : q.neighbours)
  {
    const Vec3 arm = patch.nodes[n].position - q.position;
    if (normal.dot(arm) > slack * arm.norm())
    {
      return false;
    }
  }
  return true;
}

bool inEdgeCones(const PlacedBlock& rock, int edge, const SurfacePatch& patch, int ridge,
  const Vec3& normal, double slack)
{
  const Polyhedron::Edge& e = rock.block().shape().edges()[edge];
  const SurfacePatch::Ridge& g = patch.ridges[ridge];
  const Vec3& q = patch.nodes[g.nodes[0]].position;
  // Cone of the ridge: both triangles fall away. Cone of the rock's edge: both faces rise.
  for (int wing : g.wings)
  {
    const Vec3 arm = patch.nodes[wing].position - q;
    if (normal.dot(arm) > slack * arm.norm())
    {
      return false;
    }
  }
  const Vec3 direction =
    (rock.vertices()[e.vertices[1]] - rock.vertices()[e.vertices[0]]).normalized();
  for (int k = 0; k < 2; ++k)
  {
    // In-face direction away from the edge; the edge runs as in the loop of faces[0].
    const Vec3 inward = rock.normal(e.faces[k]).cross(direction) * (k == 0 ? 1.0 : -1.0);
    if (normal.dot(inward) < -slack)
    {
      return false;
    }
  }
  return true;
}

Contact vertexFaceAt(
  const PlacedBlock& rock, int vertex, const SurfacePatch& patch, int triangle, double distance)
{
  const SurfacePatch::Triangle& t = patch.triangles[triangle];
  Contact c;
  c.kind = ContactKind::VertexFace;
  c.rockFeature = vertex;
  c.patchFeature = triangle;
  c.surfaceFeature = t.key;
  c.cfe = t.cfe;
  c.normal = t.normal;
  c.point = rock.vertices()[vertex];
  c.distance = distance;
  return c;
}

Contact faceVertexAt(
  const PlacedBlock& rock, int face, const SurfacePatch& patch, int node, double distance)
{
  const SurfacePatch::Node& q = patch.nodes[node];
  Contact c;
  c.kind = ContactKind::FaceVertex;
  c.rockFeature = face;
  c.patchFeature = node;
  c.surfaceFeature = q.key;
  c.cfe = q.cfe;
  c.normal = -rock.normal(face);
  c.point = q.position;
  c.distance = distance;
  return c;
}

std::optional<Contact> vertexFace(const PlacedBlock& rock, int vertex, const SurfacePatch& patch,
  int triangle, double reach, int from, double turn)
{
  const SurfacePatch::Triangle& t = patch.triangles[triangle];
  const Vec3& p = rock.vertices()[vertex];
  const double distance = t.normal.dot(p) - t.offset;
  const double depth = deepestEntrance(rock.block());
  if (distance > reach || distance < -depth ||
    !projectsInside(patch, triangle, p, reach, 1e-9 * rock.block().radius(), from))
  {
    return std::nullopt;
  }
  if (!inVertexCone(rock, vertex, t.normal, kConeSlack + turn) ||
    !cameThrough(rock.position(), patch, triangle, p, distance))
  {
    return std::nullopt;
  }
  return vertexFaceAt(rock, vertex, patch, triangle, distance);
}

bool insideRockFace(const PlacedBlock& rock, int face, const Vec3& world, double tolerance)
{
  const Polyhedron& shape = rock.block().shape();
  const Vec3 x = rock.materialPoint(world);
  const Vec3& n = shape.normals()[face];
  const std::vector<int>& loop = shape.faces()[face];
  for (std::size_t k = 0; k < loop.size(); ++k)
  {
    const Vec3& a = shape.vertices()[loop[k]];
    const Vec3 along = shape.vertices()[loop[(k + 1) % loop.size()]] - a;
    if (n.cross(along).dot(x - a) < -tolerance * along.norm())
    {
      return false;
    }
  }
  return true;
}

std::optional<Contact> faceVertex(
  const PlacedBlock& rock, int face, const SurfacePatch& patch, int node, double reach)
{
  const SurfacePatch::Node& q = patch.nodes[node];
  if (!q.peak)
  {
    return std::nullopt;
  }
  const double distance = rock.faceDistance(face, q.position);
  const double depth = deepestEntrance(rock.block());
  if (distance > reach || distance < -depth ||
    !insideRockFace(rock, face, q.position, 1e-9 * rock.block().radius()))
  {
    return std::nullopt;
  }
  if (!inPeakCone(patch, node, -rock.normal(face), kConeSlack))
  {
    return std::nullopt;
  }
  return faceVertexAt(rock, face, patch, node, distance);
}

Vec3 betweenSegments(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& w)
{
  const Vec3 r = p - q;
  const double uu = u.squaredNorm(), ww = w.squaredNorm(), uw = u.dot(w), ur = u.dot(r),
               wr = w.dot(r);
  const double across = uu * ww - uw * uw;
  double s = across > 0.0 ? std::clamp((uw * wr - ur * ww) / across, 0.0, 1.0) : 0.0;
  const double t = std::clamp((uw * s + wr) / ww, 0.0, 1.0);
  s = std::clamp((uw * t - ur) / uu, 0.0, 1.0);
  return r + s * u - t * w;
}

bool closestOnLines(
  const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& w, double& s, double& t)
{
  const double a = u.squaredNorm(), b = u.dot(w), c = w.squaredNorm();
  const double determinant = a * c - b * b;
  if (determinant < kParallelOnSlope * kParallelOnSlope * a * c)
  {
    return false;
  }
  const Vec3 r = p - q;
  const double d = u.dot(r), e = w.dot(r);
  s = (b * e - c * d) / determinant;
  t = (a * e - b * d) / determinant;
  return true;
}

double overSide(
  const PlacedBlock& rock, int edge, const SurfacePatch& patch, int ridge, double reach)
{
  const std::array<int, 2>& ends = rock.block().shape().edges()[edge].vertices;
  const Vec3 &p = rock.vertices()[ends[0]], &q = rock.vertices()[ends[1]];
  for (int i : patch.ridges[ridge].triangles)
  {
    const SurfacePatch::Triangle& side = patch.triangles[i];
    const double a = side.normal.dot(p), b = side.normal.dot(q), least = reach + side.offset;
    if (a > least && b > least)
    {
      return std::min(a, b) - side.offset;
    }
  }
  return 0.0;
}

std::optional<Contact> edgeEdge(
  const PlacedBlock& rock, int edge, const SurfacePatch& patch, int ridge, double reach)
{
  return edgeEdge(rock, edge, patch, ridge, reach, { rock.position() });
}

std::optional<Contact> edgeEdge(const PlacedBlock& rock, int edge, const SurfacePatch& patch,
  int ridge, double reach, const CameFrom& from)
{
  const Polyhedron& shape = rock.block().shape();
  const Polyhedron::Edge& e = shape.edges()[edge];
  const SurfacePatch::Ridge& g = patch.ridges[ridge];
  const Vec3& p = rock.vertices()[e.vertices[0]];
  const Vec3& q = patch.nodes[g.nodes[0]].position;
  const Vec3 u = rock.vertices()[e.vertices[1]] - p;
  const Vec3 w = patch.nodes[g.nodes[1]].position - q;
  double s, t;
  if (!closestOnLines(p, u, q, w, s, t) || s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0)
  {
    return std::nullopt;
  }
  Vec3 n = u.cross(w).normalized();
  const Vec3& n0 = patch.triangles[g.triangles[0]].normal;
  const Vec3& n1 = patch.triangles[g.triangles[1]].normal;
  if (n.dot(n0 + n1) < 0.0)
  {
    n = -n;
  }
  const Vec3 onRock = p + s * u;
  const double distance = n.dot(onRock - (q + t * w));
  const double depth = std::max(from.way, deepestEntrance(rock.block()));
  if (distance > reach || distance < -depth || (distance < 0.0 && n.dot(from.position - q) <= 0.0))
  {
    return std::nullopt;
  }
  if (!inEdgeCones(rock, edge, patch, ridge, n, kConeSlack) ||
    !cameAcross(rock, patch, ridge, distance))
  {
    return std::nullopt;
  }
  Contact c;
  c.kind = ContactKind::EdgeEdge;
  c.rockFeature = edge;
  c.patchFeature = ridge;
  c.surfaceFeature = g.key;
  c.cfe = patch.triangles[g.triangles[0]].cfe;
  c.normal = n;
  c.point = onRock;
  c.distance = distance;
  setRidge(patch, ridge, c);
  return c;
}

void setRidge(const SurfacePatch& patch, int ridge, Contact& contact)
{
  const SurfacePatch::Ridge& g = patch.ridges[ridge];
  const Vec3& q = patch.nodes[g.nodes[0]].position;
  contact.ridge = { q, patch.nodes[g.nodes[1]].position - q };
}

} // namespace rockfall
