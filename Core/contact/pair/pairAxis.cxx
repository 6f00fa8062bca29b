#include "contact/pairs.h"

#include "contact/ground/features.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// Where no vertex shows that an axis is best, none is looked for so many times.
constexpr std::int16_t kNoWitness = std::numeric_limits<std::int16_t>::min(), kSearches = 4;

/// Least distance of the other body's vertices over a face.
double overFace(const PairBody& owner, int face, const PairBody& other)
{
  const Vec3 n = owner.normal(face);
  PairBody::Four least = other.alongVertices(n, 0);
  for (int i = 1; i < other.vertexFours(); ++i)
  {
    least = least.min(other.alongVertices(n, i));
  }
  return least.minCoeff() - owner.offset(face);
}

PairAxis faceAxis(const PairBody& first, const PairBody& second, PairAxis::Kind kind, int face)
{
  const bool ofFirst = kind == PairAxis::Kind::FaceOfFirst;
  PairAxis axis;
  axis.kind = kind;
  (ofFirst ? axis.first : axis.second) = face;
  axis.normal = ofFirst ? Vec3(-first.normal(face)) : second.normal(face);
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

/// An edge that can still show a larger gap than others.
struct ArcEdge
{
  int edge;
  Vec3 normals[2];   ///< Of its faces; of the second body turned round.
  Vec3 across;       ///< Out of the plane of their arc.
  Vec3 start, along; ///< Of the edge, from end to end.
};

/// The vertex that is farthest along a direction.
Vec3 farthestAlong(const PairBody& body, const Vec3& n)
{
  int farthest = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < body.vertexFours(); ++i)
  {
    const PairBody::Four along = body.alongVertices(n, i);
    for (int k = 0; k < 4; ++k) // what fills the last four up is no farther than the last vertex
    {
      farthest = along[k] > most ? 4 * i + k : farthest;
      most = std::max(most, along[k]);
    }
  }
  return body.vertex(farthest);
}

/// Edges that can still show a larger gap than `least`. A face of the Minkowski difference that an
/// edge is part of has its normal between those of the edge's faces (turned round, for the first
/// body). The gap in such a direction n is at most n · (edge − other centroid) less the radius of
/// the ball in the other body, and n · (edge − `tip`), a point of the other body; no direction in
/// the arc gives more than this.
void edgesAbove(const PairBody& body, const PairBody& other, const Vec3& tip, double least,
  double sign, std::vector<ArcEdge>& found)
{
  found.clear();
  thread_local std::vector<double> over;
  const int fours = body.faceFours();
  over.resize(std::size_t(8 * fours));
  double* const ofBall = over.data();
  double* const ofTip = ofBall + 4 * fours;
  for (int i = 0; i < fours; ++i)
  {
    Eigen::Map<PairBody::Four>(ofBall + 4 * i) = body.overFaces(other.position, i);
    Eigen::Map<PairBody::Four>(ofTip + 4 * i) = body.overFaces(tip, i);
  }
  const auto isAbove =
    [&](const Polyhedron::Edge& edge, const double* of, const Vec3& point, double most)
  {
    const int f = edge.faces[0], g = edge.faces[1];
    const double overA = of[f], overB = of[g];
    if (std::max(overA, overB) > most)
    {
      return true;
    }
    if (std::max(overA, overB) <= 0.0 && most >= 0.0)
    {
      return false;
    }
    const double between = body.normal(f).dot(body.normal(g));
    if (!(overA > between * overB && overB > between * overA))
    {
      return false;
    }
    // The nearest direction lies within the arc: the distance from the edge's line.
    const Vec3 start = body.vertex(edge.vertices[0]);
    const Vec3 u = body.vertex(edge.vertices[1]) - start;
    return most < 0.0 || (point - start).cross(u).squaredNorm() > most * most * u.squaredNorm();
  };
  const double rounding = 1e-12 * body.radius;
  for (std::size_t e = 0; e < body.edges.size(); ++e)
  {
    const Polyhedron::Edge& edge = body.edges[e];
    if (isAbove(edge, ofBall, other.position, least + other.inside) &&
      isAbove(edge, ofTip, tip, least - rounding))
    {
      const Vec3 a = body.normal(edge.faces[0]), b = body.normal(edge.faces[1]);
      const Vec3 start = body.vertex(edge.vertices[0]);
      found.push_back({ int(e), { sign * a, sign * b }, b.cross(a), start,
        body.vertex(edge.vertices[1]) - start });
    }
  }
}

/// No axis if the edges are nearly parallel or do not face each other.
PairAxis edgeAxis(const PairBody& first, const PairBody& second, int e, int f)
{
  const Polyhedron::Edge& edge = first.edges[std::size_t(e)];
  const Polyhedron::Edge& other = second.edges[std::size_t(f)];
  PairAxis axis;
  if (!arcsCross(first.normal(edge.faces[0]), first.normal(edge.faces[1]),
        -second.normal(other.faces[0]), -second.normal(other.faces[1])))
  {
    return axis;
  }
  const Vec3 p0 = first.vertex(edge.vertices[0]);
  const Vec3 q0 = second.vertex(other.vertices[0]);
  const Vec3 u = first.vertex(edge.vertices[1]) - p0;
  const Vec3 w = second.vertex(other.vertices[1]) - q0;
  Vec3 n = u.cross(w);
  const double square = n.squaredNorm();
  if (square < kParallelEdges * kParallelEdges * u.squaredNorm() * w.squaredNorm())
  {
    return axis;
  }
  n *= 1.0 / std::sqrt(square);
  // Out of the second body, into the first.
  if (n.dot(q0 - second.position) < 0.0)
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

/// Whether a pair of such edges cannot show a gap larger than `least`, by a test without a root.
bool showsLess(const ArcEdge& e, const ArcEdge& f, const Vec3& center, double least)
{
  const double cba = f.normals[0].dot(e.across), dba = f.normals[1].dot(e.across);
  const double adc = e.normals[0].dot(f.across), bdc = e.normals[1].dot(f.across);
  if (!(cba * dba < 0.0 && adc * bdc < 0.0))
  {
    return true;
  }
  const Vec3 n = e.along.cross(f.along);
  const double outward = n.dot(f.start - center), apart = n.dot(e.start - f.start);
  const double gap = outward < 0.0 ? -apart : apart;
  // A case that rounding may turn round is left to the full test.
  const double gap2 = gap * gap, least2 = least * least * n.squaredNorm();
  return gap > 0.0 ? least > 0.0 && gap2 < least2 * (1.0 - 1e-9)
                   : least >= 0.0 || gap2 > least2 * (1.0 + 1e-9);
}

/// The edges' axis, if it shows a larger gap than `least`; along `near` they are near each other.
PairAxis bestCrossing(
  const PairBody& first, const PairBody& second, const PairAxis& near, double least)
{
  PairAxis best;
  best.distance = least;
  thread_local std::vector<ArcEdge> ours, theirs;
  const auto findOurs = [&]
  {
    edgesAbove(first, second, farthestAlong(second, near.normal), least, 1.0, ours);
    return !ours.empty();
  };
  const auto findTheirs = [&]
  {
    edgesAbove(second, first, farthestAlong(first, -near.normal), least, -1.0, theirs);
    return !theirs.empty();
  };
  // Of the rock first whose face it is: mostly none of its edges will do.
  if (near.kind == PairAxis::Kind::FaceOfSecond ? !findTheirs() || !findOurs()
                                                : !findOurs() || !findTheirs())
  {
    return best;
  }
  for (const ArcEdge& e : ours)
  {
    for (const ArcEdge& f : theirs)
    {
      if (showsLess(e, f, second.position, best.distance))
      {
        continue;
      }
      const PairAxis axis = edgeAxis(first, second, e.edge, f.edge);
      if (axis.kind != PairAxis::Kind::None && axis.distance > best.distance)
      {
        best = axis;
      }
    }
  }
  return best;
}

/// The axis of a face, if it shows a larger gap than `best`.
void offerFaces(const PairBody& first, const PairBody& second, PairAxis& best)
{
  const auto offer = [&](const PairBody& owner, const PairBody& other, PairAxis::Kind kind)
  {
    for (int i = 0; i < owner.faceFours(); ++i)
    {
      // No face is farther from a body than from the ball in it.
      const PairBody::Four most = owner.overFaces(other.position, i) - other.inside;
      for (int k = 0; k < 4 && 4 * i + k < owner.faces(); ++k)
      {
        if (most[k] > best.distance)
        {
          const PairAxis axis = faceAxis(first, second, kind, 4 * i + k);
          best = axis.distance > best.distance ? axis : best;
        }
      }
    }
  };
  offer(first, second, PairAxis::Kind::FaceOfFirst);
  offer(second, first, PairAxis::Kind::FaceOfSecond);
}

/// Upper bound of the distance of a point from a body. Where it is over a plane by ε, the body
/// scaled up about its centroid by ε over the radius of the ball in it holds the point.
double farFrom(const PairBody& body, const Vec3& point)
{
  const double over = body.overAll(point);
  return over <= 0.0 ? 0.0 : over * (point - body.position).norm() / body.inside;
}

/// A face's plane, and the rock beyond it.
struct FacePlane
{
  const PairBody& owner;
  const PairBody& other;
  int face;
  Vec3 normal;
  double offset;

  FacePlane(const PairBody& first, const PairBody& second, const PairAxis& axis)
    : FacePlane(axis.kind == PairAxis::Kind::FaceOfFirst ? first : second,
        axis.kind == PairAxis::Kind::FaceOfFirst ? second : first,
        axis.kind == PairAxis::Kind::FaceOfFirst ? axis.first : axis.second)
  {
  }
  FacePlane(const PairBody& itsOwner, const PairBody& theOther, int itsFace)
    : owner(itsOwner)
    , other(theOther)
    , face(itsFace)
    , normal(itsOwner.normal(itsFace))
    , offset(itsOwner.offset(itsFace))
  {
  }
  /// Whether a vertex of the other rock, so far over the face, shows that the two are within
  /// `limit`,
  bool shows(const Vec3& vertex, double over, double limit) const
  {
    if (!(over <= limit))
    {
      return false;
    }
    const double gap = std::max(0.0, over);
    return limit < 0.0 ? owner.overAll(vertex) <= limit
                       : gap + farFrom(owner, vertex - gap * normal) <= limit;
  }
  /// or one of the face.
  bool shows(const Vec3& vertex, double limit) const
  {
    return (limit < 0.0 ? other.overAll(vertex) : farFrom(other, vertex)) <= limit;
  }
  /// Whether what showed it last does so again.
  bool shows(int witness, double limit) const
  {
    if (witness >= 0)
    {
      const Vec3 vertex = other.vertex(witness);
      return this->shows(vertex, alongOf(normal, vertex) - offset, limit);
    }
    return witness < -1 &&
      this->shows(owner.vertex(owner.loop(face)[std::size_t(-2 - witness)]), limit);
  }

private:
  /// As PairBody::alongVertices has it, to the bit.
  static double alongOf(const Vec3& n, const Vec3& x)
  {
    return x.x() * n.x() + x.y() * n.y() + x.z() * n.z();
  }
};

/// Whether the bodies have points no farther from each other than `limit`, or if that is < 0 one
/// has a point as deep in the other: no direction then shows a larger gap. Looked for where they
/// touch along an axis, first where it was found last; false if it is not sure.
bool areWithin(const PairBody& first, const PairBody& second, PairAxis& axis, double limit)
{
  if (axis.kind == PairAxis::Kind::Edges)
  {
    if (limit < 0.0)
    {
      return false;
    }
    const std::array<int, 2>& e = first.edges[std::size_t(axis.first)].vertices;
    const std::array<int, 2>& f = second.edges[std::size_t(axis.second)].vertices;
    const Vec3 p = first.vertex(e[0]);
    const Vec3 q = second.vertex(f[0]);
    const Vec3 u = first.vertex(e[1]) - p, w = second.vertex(f[1]) - q;
    double s, t;
    return closestOnLines(p, u, q, w, s, t) && s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0 &&
      (p + s * u - (q + t * w)).squaredNorm() <= limit * limit;
  }
  if (axis.witness < kNoWitness + kSearches)
  {
    axis.witness = ++axis.witness < kNoWitness + kSearches ? axis.witness : std::int16_t(-1);
    return false;
  }
  const FacePlane plane(first, second, axis);
  if (plane.shows(axis.witness, limit))
  {
    return true;
  }
  // Vertices over the face …
  const PairBody& other = plane.other;
  for (int i = 0; i < other.vertexFours(); ++i)
  {
    const PairBody::Four over = other.alongVertices(plane.normal, i) - plane.offset;
    for (int k = 0; k < 4 && 4 * i + k < other.vertices(); ++k)
    {
      if (over[k] <= limit && plane.shows(other.vertex(4 * i + k), over[k], limit))
      {
        axis.witness = std::int16_t(4 * i + k);
        return true;
      }
    }
  }
  // … or of it, under the other body.
  const std::span<const int> loop = plane.owner.loop(plane.face);
  for (std::size_t i = 0; i < loop.size(); ++i)
  {
    if (plane.shows(plane.owner.vertex(loop[i]), limit))
    {
      axis.witness = std::int16_t(-2 - int(i));
      return true;
    }
  }
  axis.witness = kNoWitness;
  return false;
}

} // namespace

PairAxis findAxis(const PairBody& first, const PairBody& second, const PairAxis& last, double reach)
{
  // The last axis first: most pairs are apart along it still.
  PairAxis kept;
  if (last.kind == PairAxis::Kind::Edges)
  {
    kept = edgeAxis(first, second, last.first, last.second);
  }
  else if (last.kind != PairAxis::Kind::None)
  {
    kept = faceAxis(first, second, last.kind,
      last.kind == PairAxis::Kind::FaceOfFirst ? last.first : last.second);
    kept.witness = last.witness;
  }
  // The axis stays unless another one is better by so much.
  const double better = kAxisHysteresis * std::min(first.radius, second.radius);
  PairAxis best = kept;
  best.distance = -std::numeric_limits<double>::infinity();
  if (kept.kind != PairAxis::Kind::None)
  {
    best.distance = kept.distance + better;
    if (kept.distance > reach || areWithin(first, second, kept, best.distance))
    {
      return kept;
    }
  }
  const double least = best.distance;
  offerFaces(first, second, best);
  const bool stays = kept.kind != PairAxis::Kind::None && best.distance == least;
  best = stays ? kept : best;
  if (best.distance > reach)
  {
    return best;
  }
  // Faces go before edges that are as good, and what was kept before them again.
  const double beaten = best.distance + (stays ? 2.0 : 1.0) * better;
  if (stays || !areWithin(first, second, best, beaten))
  {
    const PairAxis crossing = bestCrossing(first, second, best, beaten);
    best = crossing.kind != PairAxis::Kind::None ? crossing : best;
  }
  return best;
}

PairAxis bestAxis(const PairBody& first, const PairBody& second, const PairAxis& known)
{
  // A face that is known is found again: none that shows less need be looked at.
  const bool isFace =
    known.kind == PairAxis::Kind::FaceOfFirst || known.kind == PairAxis::Kind::FaceOfSecond;
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  PairAxis best;
  best.distance = isFace ? std::nextafter(known.distance, kNone) : kNone;
  offerFaces(first, second, best);
  const PairAxis crossing = bestCrossing(first, second, best, best.distance);
  return crossing.kind != PairAxis::Kind::None ? crossing : best;
}

} // namespace rockfall
