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

/// visit(contact) of each candidate that is too deep, until it returns false. Returns whether it
/// never did.
template <class Visit>
bool visitOverlaps(const PlacedBlock& rock, const SurfacePatch& patch,
  const CandidatePairs& candidates, double allowed, const CameFrom& from, Visit&& visit)
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
      cameThrough(from.position, patch, pair.patch, p, distance) &&
      !visit(vertexFaceAt(rock, pair.rock, patch, pair.patch, distance)))
    {
      return false;
    }
  }
  for (int node : candidates.peaks)
  {
    const SurfacePatch::Node& q = patch.nodes[node];
    const int face = rock.outermostFace(q.position, -allowed);
    if (face < 0)
    {
      continue;
    }
    const double distance = rock.faceDistance(face, q.position);
    // A face that looks up is no way out of the ground.
    if (distance < -allowed && (node >= patch.slopeNodes || rock.normal(face).z() < 0.0) &&
      !visit(faceVertexAt(rock, face, patch, node, distance)))
    {
      return false;
    }
  }
  if (from.way <= 0.0)
  {
    return true; // edges have been looked at where it stands
  }
  for (const CandidatePairs::Pair& pair : candidates.edgeEdge)
  {
    if (pair.over > travelled)
    {
      continue;
    }
    const double over = overSide(rock, pair.rock, patch, pair.patch, 0.0);
    pair.over = travelled + over;
    if (over > 0.0)
    {
      continue;
    }
    const auto c = edgeEdge(rock, pair.rock, patch, pair.patch, -allowed, from);
    if (c && !visit(*c))
    {
      return false;
    }
  }
  return true;
}

} // namespace

void guardPenetration(const PlacedBlock& rock, const SurfacePatch& patch,
  const CandidatePairs& candidates, double allowed, const CameFrom& from,
  std::vector<Contact>& contacts)
{
  const auto isKnownBy = [&](const Contact& c, const Contact& o)
  {
    const bool same = o.kind == c.kind && o.surfaceFeature == c.surfaceFeature;
    switch (c.kind)
    {
      case ContactKind::FaceVertex:
        return same;
      case ContactKind::EdgeEdge:
        return same && o.rockFeature == c.rockFeature;
      default:
        // The plane of a triangle is produced beyond a concave edge: a contact that lives on there
        // knows of no depth under the triangle that rises behind it.
        return o.kind == c.kind && o.rockFeature == c.rockFeature &&
          (same || o.distance <= c.distance + allowed);
    }
  };
  const auto add = [&](Contact c)
  {
    c.offset = c.distance;
    if (std::none_of(
          contacts.begin(), contacts.end(), [&](const Contact& o) { return isKnownBy(c, o); }))
    {
      contacts.push_back(c);
    }
    return true;
  };
  visitOverlaps(rock, patch, candidates, allowed, from, add);
}

bool overlaps(const PlacedBlock& rock, const SurfacePatch& patch, const CandidatePairs& candidates,
  double allowed, const CameFrom& from)
{
  return !visitOverlaps(
    rock, patch, candidates, allowed, from, [](const Contact&) { return false; });
}

bool passed(const PlacedBlock& rock, const SurfacePatch& patch, const CandidatePairs& candidates,
  double allowed, const CameFrom& from, std::vector<Contact>& contacts)
{
  const std::size_t held = contacts.size();
  guardPenetration(rock, patch, candidates, allowed, { from.position }, contacts);
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
        edgeEdge(rock, pair.rock, patch, pair.patch, deepest - allowed, from);
    });
}

} // namespace rockfall
