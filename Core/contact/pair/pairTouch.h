#pragma once

/// @file
/// A point on which two rocks touch, before it is a contact.

#include "contact/pairs.h"

#include <limits>
#include <span>

namespace rockfall
{

/// A point of touch.
struct Touch
{
  Vec3 point;
  double distance; ///< m
  int feature;     ///< Of the corner's rock: a vertex, or < 0: where an edge is cut.
};

/// The points of touch along an axis, valid until the next call on this thread.
std::span<const Touch> touchesAlong(
  const PairBody& first, const PairBody& second, const PairAxis& axis, double reach);
/// Result of a search along an axis; an overlap that shows none there is looked at along the best
/// axis, and `axis` is it then; for those with gaps under `below` (m) only.
std::span<const Touch> orAlongBest(std::span<const Touch> found, const PairBody& first,
  const PairBody& second, PairAxis& axis, double reach,
  double below = std::numeric_limits<double>::infinity());

/// The features that touch.
struct TouchFeatures
{
  ContactKind kind;
  int first, second; ///< Of the rocks.

  TouchFeatures(const Touch& touch, const PairAxis& axis)
    : kind(axis.kind == PairAxis::Kind::Edges        ? ContactKind::EdgeEdge
          : axis.kind == PairAxis::Kind::FaceOfFirst ? ContactKind::FaceVertex
                                                     : ContactKind::VertexFace)
    , first(kind == ContactKind::VertexFace ? touch.feature : axis.first)
    , second(kind == ContactKind::FaceVertex ? touch.feature : axis.second)
  {
  }
  bool are(const Contact& c) const
  {
    return c.kind == kind && c.rockFeature == first && c.surfaceFeature == second;
  }
};

/// Where a touch is: all of a contact that is not its springs'.
inline void putTouch(const Touch& touch, const PairBody& second, const PairAxis& axis, Contact& c)
{
  c.normal = axis.normal;
  c.point = touch.point;
  c.distance = touch.distance;
  const bool edges = axis.kind == PairAxis::Kind::Edges;
  if (edges)
  {
    const std::array<int, 2>& f = second.edges[std::size_t(axis.second)].vertices;
    const Vec3 q = second.vertex(f[0]);
    c.ridge = { q, second.vertex(f[1]) - q };
  }
  else if (c.kind == ContactKind::EdgeEdge)
  {
    c.ridge = { Vec3::Zero(), Vec3::Zero() };
  }
  const TouchFeatures features(touch, axis);
  c.kind = features.kind;
  c.rockFeature = features.first;
  c.surfaceFeature = features.second;
}

} // namespace rockfall
