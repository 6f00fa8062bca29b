#include "contact/features.h"

#include <cmath>

namespace rockfall
{

namespace
{

/// Whether the boxes of two segments or points come within `distance`.
bool boxesMeet(const Vec3& lower, const Vec3& upper, const Vec3& a, const Vec3& b, double distance)
{
  return ((a.cwiseMin(b).array() <= upper.array() + distance) &&
    (a.cwiseMax(b).array() >= lower.array() - distance))
    .all();
}

} // namespace

bool CandidatePairs::serve(const BlockState& state, double radius, double reach) const
{
  const double c = orientation.dot(state.orientation);
  const double turned = 2.0 * radius * std::sqrt(std::max(0.0, 1.0 - c * c));
  return (state.position - position).norm() + turned + reach <= distance;
}

void gatherCandidates(const PlacedBlock& rock, const BlockState& state, const SurfacePatch& patch,
  double distance, CandidatePairs& candidates)
{
  candidates.vertexFace.clear();
  candidates.edgeEdge.clear();
  candidates.peaks.clear();
  candidates.distance = distance;
  candidates.position = state.position;
  candidates.orientation = state.orientation;
  const Polyhedron& shape = rock.block().shape();
  const std::vector<Vec3>& vertices = rock.vertices();
  const Vec3 lower = rock.lower(), upper = rock.upper();
  // As far as the rock may turn while the candidates serve, sine.
  const double turn = kConeSlack + distance / rock.block().radius();
  for (int i = 0; i < int(patch.triangles.size()); ++i)
  {
    const SurfacePatch::Triangle& t = patch.triangles[i];
    if (t.cfe == 0)
    {
      continue;
    }
    // The box's lowest corner along the normal bounds all vertices.
    const Vec3 corner = (t.normal.array() > 0.0).select(lower, upper);
    if (t.normal.dot(corner) - t.offset > distance)
    {
      continue;
    }
    const Vec3& a = patch.nodes[t.nodes[0]].position;
    const Vec3& b = patch.nodes[t.nodes[1]].position;
    const Vec3& c = patch.nodes[t.nodes[2]].position;
    // Beyond a concave edge a plane serves a little further: twice the distance takes that in.
    const Vec3 least = a.cwiseMin(b).cwiseMin(c), most = a.cwiseMax(b).cwiseMax(c);
    if (!boxesMeet(Vec3(lower.x(), lower.y(), std::min(lower.z(), least.z())),
          Vec3(upper.x(), upper.y(), std::max(upper.z(), least.z())), least, most, 2.0 * distance))
    {
      continue;
    }
    for (int v = 0; v < int(vertices.size()); ++v)
    {
      const Vec3& p = vertices[v];
      // No bound below: what has slipped under the slope must be found (holdOverlap).
      const Vec3 raised(p.x(), p.y(), std::max(p.z(), least.z()));
      const double over = t.normal.dot(p) - t.offset;
      if (over <= distance && boxesMeet(least, most, raised, raised, 2.0 * distance) &&
        (over < 0.0 || inVertexCone(rock, v, t.normal, turn)))
      {
        candidates.vertexFace.push_back({ v, i });
      }
    }
  }
  for (int i = 0; i < int(patch.nodes.size()); ++i)
  {
    const SurfacePatch::Node& q = patch.nodes[i];
    if (q.peak && boxesMeet(lower, upper, q.position, q.position, distance) &&
      rock.faceDistance(rock.outermostFace(q.position), q.position) <= distance)
    {
      candidates.peaks.push_back(i);
    }
  }
  for (int i = 0; i < int(patch.ridges.size()); ++i)
  {
    const SurfacePatch::Ridge& g = patch.ridges[i];
    const Vec3& q0 = patch.nodes[g.nodes[0]].position;
    const Vec3& q1 = patch.nodes[g.nodes[1]].position;
    if (!boxesMeet(lower, upper, q0, q1, distance))
    {
      continue;
    }
    // The whole edge above either plane of the ridge: no crossing is near.
    const SurfacePatch::Triangle& t0 = patch.triangles[g.triangles[0]];
    const SurfacePatch::Triangle& t1 = patch.triangles[g.triangles[1]];
    const auto above = [&](const Vec3& p)
    { return std::min(t0.normal.dot(p) - t0.offset, t1.normal.dot(p) - t1.offset) > distance; };
    const Vec3 least = q0.cwiseMin(q1), most = q0.cwiseMax(q1);
    for (int e = 0; e < int(shape.edges().size()); ++e)
    {
      const Vec3& p0 = vertices[shape.edges()[e].vertices[0]];
      const Vec3& p1 = vertices[shape.edges()[e].vertices[1]];
      if (!boxesMeet(least, most, p0, p1, distance) || (above(p0) && above(p1)))
      {
        continue;
      }
      // The normal of the crossing turns faster than the edge, the more so the nearer to parallel.
      Vec3 n = (p1 - p0).cross(q1 - q0);
      const double size = n.norm(), all = (p1 - p0).norm() * (q1 - q0).norm();
      const double slack = turn * all / size;
      n *= (n.dot(t0.normal + t1.normal) < 0.0 ? -1.0 : 1.0) / size;
      if (!(slack < 0.5) || inEdgeCones(rock, e, patch, i, n, slack))
      {
        candidates.edgeEdge.push_back({ e, i });
      }
    }
  }
}

} // namespace rockfall
