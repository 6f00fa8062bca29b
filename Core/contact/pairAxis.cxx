#include "contact/pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// An axis must be better than the last one by this share of the smaller radius to take its place.
constexpr double kHysteresis = 1e-3;
/// Edges are a pair only if they are farther from parallel than this sine.
constexpr double kParallel = 1e-3;

/// Least distance of the other body's vertices over a face.
double overFace(const PairBody& owner, int face, const PairBody& other)
{
  const Vec3& n = owner.normals[face];
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& v : other.placed->vertices())
  {
    least = std::min(least, n.dot(v));
  }
  return least - owner.offsets[face];
}

PairAxis faceAxis(const PairBody& first, const PairBody& second, PairAxis::Kind kind, int face)
{
  const bool ofFirst = kind == PairAxis::Kind::FaceOfFirst;
  PairAxis axis;
  axis.kind = kind;
  (ofFirst ? axis.first : axis.second) = face;
  axis.normal = ofFirst ? Vec3(-first.normals[face]) : second.normals[face];
  axis.distance = ofFirst ? overFace(first, face, second) : overFace(second, face, first);
  return axis;
}

/// Whether two edges make a face of the Minkowski difference: the arcs between their faces' normals
/// cross on the Gauss map, those of the second body turned round.
bool arcsCross(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Vec3 bxa = b.cross(a), dxc = d.cross(c);
  const double cba = c.dot(bxa), dba = d.dot(bxa), adc = a.dot(dxc), bdc = b.dot(dxc);
  return cba * dba < 0.0 && adc * bdc < 0.0 && cba * bdc > 0.0;
}

/// Edges that can still show a larger gap than `least`. A face of the Minkowski difference that an
/// edge is part of has its normal between those of the edge's faces (turned round, for the first
/// body). The gap in such a direction n is at most n · (edge − other centroid) less the radius of
/// the ball in the other body; no direction in the arc gives more than this.
struct ArcEdge
{
  int edge;
  std::array<const Vec3*, 2> normals; ///< Of its faces.
};

void edgesAbove(
  const PairBody& body, const PairBody& other, double least, std::vector<ArcEdge>& found)
{
  found.clear();
  const std::vector<Polyhedron::Edge>& edges = body.placed->block().shape().edges();
  const std::vector<Vec3>& vertices = body.placed->vertices();
  const Vec3 center = other.placed->position();
  const double least2 = least + other.inside;
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    const Vec3& a = body.normals[edges[e].faces[0]];
    const Vec3& b = body.normals[edges[e].faces[1]];
    const Vec3& start = vertices[edges[e].vertices[0]];
    const Vec3 v = center - start;
    const double overA = v.dot(a), overB = v.dot(b);
    bool above = std::max(overA, overB) > least2;
    if (!above)
    {
      const double between = a.dot(b);
      if (overA > between * overB && overB > between * overA)
      {
        // The nearest direction lies within the arc: the distance from the edge's line.
        const Vec3 u = vertices[edges[e].vertices[1]] - start;
        above = least2 < 0.0 || v.cross(u).squaredNorm() > least2 * least2 * u.squaredNorm();
      }
    }
    if (above)
    {
      found.push_back({ int(e), { &a, &b } });
    }
  }
}

/// No axis if the edges are nearly parallel or do not face each other.
PairAxis edgeAxis(const PairBody& first, const PairBody& second, int e, int f)
{
  const Polyhedron& p = first.placed->block().shape();
  const Polyhedron& q = second.placed->block().shape();
  const Polyhedron::Edge& edge = p.edges()[e];
  const Polyhedron::Edge& other = q.edges()[f];
  PairAxis axis;
  if (!arcsCross(first.normals[edge.faces[0]], first.normals[edge.faces[1]],
        -second.normals[other.faces[0]], -second.normals[other.faces[1]]))
  {
    return axis;
  }
  const Vec3& p0 = first.placed->vertices()[edge.vertices[0]];
  const Vec3& q0 = second.placed->vertices()[other.vertices[0]];
  const Vec3 u = first.placed->vertices()[edge.vertices[1]] - p0;
  const Vec3 w = second.placed->vertices()[other.vertices[1]] - q0;
  Vec3 n = u.cross(w);
  const double square = n.squaredNorm();
  if (square < kParallel * kParallel * u.squaredNorm() * w.squaredNorm())
  {
    return axis;
  }
  n *= 1.0 / std::sqrt(square);
  // Out of the second body, into the first.
  if (n.dot(q0 - second.placed->position()) < 0.0)
  {
    n = -n;
  }
  axis.kind = PairAxis::Kind::Edges;
  axis.first = e;
  axis.second = f;
  axis.normal = n;
  axis.distance = n.dot(p0 - q0);
  return axis;
}

} // namespace

void PairBody::update(const PlacedBlock& block)
{
  placed = &block;
  position = block.position();
  rotation = block.rotation();
  const Polyhedron& shape = block.block().shape();
  const std::size_t faces = shape.normals().size();
  normals.resize(faces);
  offsets.resize(faces);
  inside = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < faces; ++f)
  {
    normals[f] = block.rotation() * shape.normals()[f];
    offsets[f] = shape.offsets()[f] + normals[f].dot(block.position());
    inside = std::min(inside, shape.offsets()[f]);
  }
}

PairAxis findAxis(const PairBody& first, const PairBody& second, const PairAxis& last, double reach)
{
  const double smaller = std::min(first.placed->block().radius(), second.placed->block().radius());
  PairAxis best;
  best.distance = -std::numeric_limits<double>::infinity();
  // The last axis first: most pairs are apart along it still.
  if (last.kind == PairAxis::Kind::Edges)
  {
    const PairAxis again = edgeAxis(first, second, last.first, last.second);
    best = again.kind != PairAxis::Kind::None ? again : best;
  }
  else if (last.kind != PairAxis::Kind::None)
  {
    best = faceAxis(first, second, last.kind,
      last.kind == PairAxis::Kind::FaceOfFirst ? last.first : last.second);
  }
  if (best.kind != PairAxis::Kind::None)
  {
    if (best.distance > reach)
    {
      return best;
    }
    best.distance += kHysteresis * smaller;
  }
  const PairAxis kept = best;
  const auto offer = [&](const PairAxis& axis)
  { best = axis.distance > best.distance ? axis : best; };
  // No face is farther from a body than from the ball in it.
  const auto mayBeat = [&](const PairBody& owner, int f, const PairBody& other)
  {
    return owner.normals[f].dot(other.placed->position()) - owner.offsets[f] - other.inside >
      best.distance;
  };
  for (int f = 0; f < int(first.normals.size()); ++f)
  {
    if (mayBeat(first, f, second))
    {
      offer(faceAxis(first, second, PairAxis::Kind::FaceOfFirst, f));
    }
  }
  for (int f = 0; f < int(second.normals.size()); ++f)
  {
    if (mayBeat(second, f, first))
    {
      offer(faceAxis(first, second, PairAxis::Kind::FaceOfSecond, f));
    }
  }
  if (best.distance <= reach)
  {
    // Faces go before edges that are as good.
    PairAxis crossing;
    crossing.distance = best.distance + kHysteresis * smaller;
    thread_local std::vector<ArcEdge> ours, theirs;
    edgesAbove(first, second, crossing.distance, ours);
    if (!ours.empty())
    {
      edgesAbove(second, first, crossing.distance, theirs);
      for (const ArcEdge& e : ours)
      {
        const Vec3 plane = e.normals[1]->cross(*e.normals[0]);
        for (const ArcEdge& f : theirs)
        {
          // The arc of the other one must pass from one side of this one's plane to the other.
          if (f.normals[0]->dot(plane) * f.normals[1]->dot(plane) >= 0.0)
          {
            continue;
          }
          const PairAxis axis = edgeAxis(first, second, e.edge, f.edge);
          if (axis.kind != PairAxis::Kind::None && axis.distance > crossing.distance)
          {
            crossing = axis;
          }
        }
      }
    }
    best = crossing.kind != PairAxis::Kind::None ? crossing : best;
  }
  if (best.kind == kept.kind && best.first == kept.first && best.second == kept.second &&
    kept.kind != PairAxis::Kind::None && best.distance == kept.distance)
  {
    best.distance -= kHysteresis * smaller;
  }
  return best;
}

} // namespace rockfall
