// What is too deep under the slope, without a contact or with one (detection.h).

#include "contact/ground/detection.h"
#include "contact/ground/features.h"
#include "contact/ground/roundContact.h"
#include "law/settings.h"

#include <algorithm>
#include <limits>
#include <span>

namespace rockfall
{

namespace
{

/// How deep a point of the ground is behind the nearest wall, m; ∞ if it is behind none.
double depthInWalls(const SurfacePatch& patch, const Vec3& p)
{
  double depth = std::numeric_limits<double>::infinity();
  for (int i = patch.slopeTriangles; i < patch.slopeTriangles + patch.wallTriangles; ++i)
  {
    const SurfacePatch::Triangle& t = patch.triangles[i];
    const double behind = t.offset - t.normal.dot(p);
    if (behind >= 0.0 && behind < depth && projectsInside(patch, i, p, 0.0, 0.0))
    {
      depth = behind;
    }
  }
  return depth;
}

} // namespace

double penetration(const PlacedBlock& rock, const SurfacePatch& patch)
{
  if (isRound(rock))
  {
    return roundPenetration(rock, patch);
  }
  double deepest = 0.0;
  const Vec3 lower = rock.lower(), upper = rock.upper();
  for (const SurfacePatch::Triangle& t : std::span(patch.triangles).first(patch.slopeTriangles))
  {
    const Vec3& a = patch.nodes[t.nodes[0]].position;
    const Vec3& b = patch.nodes[t.nodes[1]].position;
    const Vec3& c = patch.nodes[t.nodes[2]].position;
    const Vec3 most = a.cwiseMax(b).cwiseMax(c), least = a.cwiseMin(b).cwiseMin(c);
    if (t.cfe == 0 || (most.head<2>().array() < lower.head<2>().array()).any() ||
      (least.head<2>().array() > upper.head<2>().array()).any())
    {
      continue;
    }
    for (const Vec3& p : rock.vertices())
    {
      const double depth = t.offset - t.normal.dot(p);
      if (depth > deepest && isStraightOver(patch, t, p))
      {
        deepest = std::max(deepest, std::min(depth, depthInWalls(patch, p)));
      }
    }
  }
  for (const SurfacePatch::Node& n : std::span(patch.nodes).first(patch.slopeNodes))
  {
    if (n.peak && (n.position.array() >= lower.array()).all() &&
      (n.position.array() <= upper.array()).all())
    {
      deepest = std::max(deepest, -rock.faceDistance(rock.outermostFace(n.position), n.position));
    }
  }
  return deepest;
}

namespace
{

/// visit(kind, feature of the rock, of the patch, distance) of each candidate vertex and peak that
/// is too deep, until it returns false. Returns whether it never did.
template <class Visit>
bool visitOverlaps(const PlacedBlock& rock, const SurfacePatch& patch,
  const CandidatePairs& candidates, double allowed, Visit&& visit)
{
  if (isRound(rock))
  {
    return true; // updateContacts finds it at any depth
  }
  const double travelled = candidates.travel.to(rock);
  for (const CandidatePairs::Pair& pair : candidates.vertexFace)
  {
    if (pair.over > travelled - allowed)
    {
      continue;
    }
    const SurfacePatch::Triangle& t = patch.triangles[pair.patch];
    const Vec3& p = rock.vertices()[pair.rock];
    const double distance = t.normal.dot(p) - t.offset;
    pair.over = travelled + distance;
    if (distance < -allowed &&
      (pair.patch < patch.slopeTriangles ? isStraightOver(patch, t, p)
                                         : projectsInside(patch, pair.patch, p, 0.0, 0.0) &&
            inVertexCone(rock, pair.rock, t.normal, kConeSlack)) &&
      cameThrough(rock, patch, pair.patch, p, distance) &&
      !visit(ContactKind::VertexFace, pair.rock, pair.patch, distance))
    {
      return false;
    }
  }
  for (int node : candidates.peaks)
  {
    const Vec3& q = patch.nodes[node].position;
    const int face = rock.outermostFace(q, -allowed);
    if (face < 0)
    {
      continue;
    }
    const double distance = rock.faceDistance(face, q);
    // A face that looks up is no way out of the ground.
    if (distance < -allowed && (node >= patch.slopeNodes || rock.normal(face).z() < 0.0) &&
      !visit(ContactKind::FaceVertex, face, node, distance))
    {
      return false;
    }
  }
  return true;
}

} // namespace

void guardPenetration(const PlacedBlock& rock, const SurfacePatch& patch,
  const CandidatePairs& candidates, double allowed, std::vector<Contact>& contacts)
{
  const auto add = [&](ContactKind kind, int onRock, int onPatch, double distance)
  {
    Contact c;
    c.kind = kind;
    c.rockFeature = onRock;
    c.patchFeature = onPatch;
    c.distance = distance;
    c.offset = distance;
    if (kind == ContactKind::VertexFace)
    {
      c.cfe = patch.triangles[onPatch].cfe;
      c.surfaceFeature = patch.triangles[onPatch].key;
      c.normal = patch.triangles[onPatch].normal;
      c.point = rock.vertices()[onRock];
    }
    else
    {
      c.cfe = patch.nodes[onPatch].cfe;
      c.surfaceFeature = patch.nodes[onPatch].key;
      c.normal = -rock.normal(onRock);
      c.point = patch.nodes[onPatch].position;
    }
    const bool known = std::any_of(contacts.begin(), contacts.end(),
      [&](const Contact& o)
      {
        if (o.kind != c.kind || c.kind != ContactKind::VertexFace)
        {
          return o.kind == c.kind && o.surfaceFeature == c.surfaceFeature;
        }
        // The plane of a triangle is produced beyond a concave edge: a contact that lives on there
        // knows of no depth under the triangle that rises behind it.
        return o.rockFeature == c.rockFeature &&
          (o.surfaceFeature == c.surfaceFeature || o.distance <= c.distance + allowed);
      });
    if (!known)
    {
      contacts.push_back(c);
    }
  };
  visitOverlaps(rock, patch, candidates, allowed,
    [&](ContactKind kind, int onRock, int onPatch, double distance)
    {
      add(kind, onRock, onPatch, distance);
      return true;
    });
}

bool overlaps(const PlacedBlock& rock, const SurfacePatch& patch, const CandidatePairs& candidates,
  double allowed)
{
  return !visitOverlaps(rock, patch, candidates, allowed, [](auto&&...) { return false; });
}

bool passed(const PlacedBlock& rock, const SurfacePatch& patch, const CandidatePairs& candidates,
  double allowed, std::vector<Contact>& contacts)
{
  const std::size_t held = contacts.size();
  guardPenetration(rock, patch, candidates, allowed, contacts);
  const bool more = contacts.size() > held;
  contacts.resize(held);
  if (more || isRound(rock))
  {
    return more;
  }
  double deepest = 0.0;
  for (const Contact& c : contacts)
  {
    deepest = std::min(deepest, c.distance);
  }
  const double travelled = candidates.travel.to(rock);
  return std::any_of(candidates.edgeEdge.begin(), candidates.edgeEdge.end(),
    [&](const CandidatePairs::Pair& pair)
    {
      return pair.over <= travelled &&
        edgeEdge(rock, pair.rock, patch, pair.patch, deepest - allowed);
    });
}

} // namespace rockfall
