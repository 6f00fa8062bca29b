#include "contact/ground/detection.h"

#include "contact/ground/contactTransfer.h"
#include "contact/ground/features.h"
#include "contact/ground/roundContact.h"
#include "law/settings.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

bool samePlace(const Contact& a, const Contact& b)
{
  return a.kind == b.kind && a.rockFeature == b.rockFeature && a.surfaceFeature == b.surfaceFeature;
}

/// Whether two ridges are pieces of one straight one.
bool onOneLine(const SurfacePatch& patch, int a, int b)
{
  const SurfacePatch::Ridge& x = patch.ridges[a];
  const SurfacePatch::Ridge& y = patch.ridges[b];
  const bool joined = x.nodes[0] == y.nodes[0] || x.nodes[0] == y.nodes[1] ||
    x.nodes[1] == y.nodes[0] || x.nodes[1] == y.nodes[1];
  const auto direction = [&](const SurfacePatch::Ridge& r) -> Vec3
  { return (patch.nodes[r.nodes[1]].position - patch.nodes[r.nodes[0]].position).normalized(); };
  return joined && std::abs(direction(x).dot(direction(y))) > 0.999;
}

/// A contact that carries stays, and so does one that has opened where the two still overlap: lost
/// and found again some steps later, it would be forgiven all that the rock has sunk meanwhile.
bool stays(const Contact& c)
{
  return c.closed() || c.distance < 0.0;
}

/// A contact that has opened, as if it had just been found: the overlap that it lost stays lost.
void reopen(Contact& c)
{
  c.offset = c.distance;
  c.slip.setZero();
  c.normalForce = c.shearForce = 0.0;
}

/// How far a point is beside a triangle, seen square to it, if by more than `least`, m; else 0.
double besideTriangle(const SurfacePatch& patch, int triangle, const Vec3& point, double least)
{
  const SurfacePatch::Triangle& t = patch.triangles[triangle];
  for (int k = 0; k < 3; ++k)
  {
    const Vec3& a = patch.nodes[t.nodes[k]].position;
    const Vec3 along = patch.nodes[t.nodes[(k + 1) % 3]].position - a;
    const double side = -t.normal.cross(along).dot(point - a);
    if (side > 0.0 && side * side > least * least * along.squaredNorm())
    {
      return side / along.norm();
    }
  }
  return 0.0;
}

} // namespace

void admit(const SurfacePatch& patch, const Contact& candidate, std::vector<Contact>& contacts)
{
  for (const Contact& c : contacts)
  {
    if (samePlace(c, candidate))
    {
      return;
    }
    if (candidate.kind == ContactKind::EdgeEdge && c.kind == ContactKind::EdgeEdge &&
      c.rockFeature == candidate.rockFeature &&
      onOneLine(patch, c.patchFeature, candidate.patchFeature))
    {
      return; // the crossing that carries already, at the joint of two pieces
    }
    if (candidate.kind != ContactKind::VertexFace || c.kind != ContactKind::VertexFace ||
      c.rockFeature != candidate.rockFeature)
    {
      continue;
    }
    // The same vertex on two triangles: both count across a valley, one across a ridge or a flat
    // edge.
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
    const bool alike = (c.patchFeature < patch.slopeTriangles) ==
      (candidate.patchFeature < patch.slopeTriangles); // both of the slope, or both of obstacles
    if (alike && !adjacent && c.distance < 0.0 && candidate.distance < c.distance)
    {
      return; // deeper under a triangle further off: not where it came in
    }
  }
  contacts.push_back(candidate);
  contacts.back().offset = std::min(0.0, candidate.distance);
}

namespace
{

/// Admits the other sides of the valleys in whose bottom a vertex is pressed: it is beside them,
/// seen square to them, and each step would leave it to go deeper under the one or the other.
void findOtherSides(
  const PlacedBlock& rock, const SurfacePatch& patch, double reach, std::vector<Contact>& contacts)
{
  for (std::size_t i = 0; i < contacts.size(); ++i) // grows
  {
    const int side = contacts[i].patchFeature, vertex = contacts[i].rockFeature;
    if (contacts[i].kind != ContactKind::VertexFace || contacts[i].distance >= 0.0 ||
      side >= patch.slopeTriangles)
    {
      continue;
    }
    for (int k = 0; k < 3; ++k)
    {
      const int other = patch.triangles[side].neighbours[k];
      if (patch.triangles[side].bends[k] < 0 && other >= 0 && patch.triangles[other].cfe != 0)
      {
        if (const auto c = vertexFace(rock, vertex, patch, other, reach, side))
        {
          admit(patch, *c, contacts);
        }
      }
    }
  }
}

} // namespace

void updateContacts(const PlacedBlock& rock, const SurfacePatch& patch,
  const CandidatePairs& candidates, double reach, std::vector<Contact>& contacts, double turn)
{
  if (isRound(rock))
  {
    updateRound(rock, patch, candidates, reach, contacts);
    return;
  }
  // A contact that carries stays, as long as it is somewhere.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i)
  {
    Contact& c = contacts[i];
    if (!stays(c) || !refreshContact(rock, patch, c) || !stays(c))
    {
      continue;
    }
    const auto twin = std::find_if(contacts.begin(), contacts.begin() + kept,
      [&](const Contact& other) { return samePlace(other, c); });
    if (twin == contacts.begin() + kept)
    {
      if (!c.closed())
      {
        reopen(c);
      }
      if (kept < i)
      {
        contacts[kept] = c;
      }
      ++kept;
    }
    else
    {
      joinSprings(*twin, c); // both have come to the same place
    }
  }
  contacts.resize(kept);

  // Contacts that are there already are not looked at again.
  const auto isThere = [&](ContactKind kind, int onRock, std::int64_t key)
  {
    return std::any_of(contacts.begin(), contacts.end(),
      [&](const Contact& c)
      { return c.rockFeature == onRock && c.surfaceFeature == key && c.kind == kind; });
  };
  // A hair more than what tolerances take in.
  const double beyond = std::max((1.0 + 1e-6) * reach, 1e-8 * rock.block().radius());
  const double travelled = candidates.travel.to(rock), far = travelled + beyond;
  for (const CandidatePairs::Pair& pair : candidates.vertexFace)
  {
    if (pair.over > far || pair.beside > far)
    {
      continue;
    }
    const SurfacePatch::Triangle& t = patch.triangles[pair.patch];
    const Vec3& p = rock.vertices()[pair.rock];
    const double over = t.normal.dot(p) - t.offset;
    pair.over = travelled + over;
    if (over > reach || isThere(ContactKind::VertexFace, pair.rock, t.key))
    {
      continue;
    }
    if (const double beside = besideTriangle(patch, pair.patch, p, beyond); beside > 0.0)
    {
      pair.beside = travelled + beside;
      continue;
    }
    if (const auto c = vertexFace(rock, pair.rock, patch, pair.patch, reach, -1, turn))
    {
      admit(patch, *c, contacts);
    }
  }
  const double around = reach + kAroundBox * rock.block().radius();
  const Eigen::AlignedBox3d box(rock.lower().array() - around, rock.upper().array() + around);
  for (int node : candidates.peaks)
  {
    if (!box.contains(patch.nodes[node].position))
    {
      continue;
    }
    // Only the face over which the node is farthest out can be the entrance.
    const int face = rock.outermostFace(patch.nodes[node].position, reach);
    if (face >= 0)
    {
      if (auto c = faceVertex(rock, face, patch, node, reach))
      {
        admit(patch, *c, contacts);
      }
    }
  }
  for (const CandidatePairs::Pair& pair : candidates.edgeEdge)
  {
    if (pair.over > far)
    {
      continue;
    }
    const double over = overSide(rock, pair.rock, patch, pair.patch, reach);
    pair.over = travelled + over;
    if (over > 0.0 || isThere(ContactKind::EdgeEdge, pair.rock, patch.ridges[pair.patch].key))
    {
      continue;
    }
    if (const auto c = edgeEdge(rock, pair.rock, patch, pair.patch, reach))
    {
      admit(patch, *c, contacts);
    }
  }
  findOtherSides(rock, patch, reach, contacts);
}

} // namespace rockfall
