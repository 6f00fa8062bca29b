#include "contact/pair/pairTouch.h"

#include "contact/ground/features.h"
#include "contact/pair/pairClip.h"
#include "law/settings.h"

#include <algorithm>
#include <array>

namespace rockfall
{

namespace
{

/// Room for as many as there can be, which never shrinks: kept by thread.
template <class T>
T* roomFor(std::vector<T>& kept, std::size_t count)
{
  if (kept.size() < count)
  {
    kept.resize(count);
  }
  return kept.data();
}

} // namespace

std::span<const Touch> touchesAlong(
  const PairBody& first, const PairBody& second, const PairAxis& axis, double reach)
{
  thread_local std::vector<Touch> kept;
  if (axis.kind == PairAxis::Kind::Edges)
  {
    const std::array<int, 2>& e = first.edges[std::size_t(axis.first)].vertices;
    const std::array<int, 2>& f = second.edges[std::size_t(axis.second)].vertices;
    const Vec3 p = first.vertex(e[0]), q = second.vertex(f[0]);
    const Vec3 u = first.vertex(e[1]) - p, w = second.vertex(f[1]) - q;
    double s = 0.5, t = 0.5;
    if (axis.distance > reach || !closestOnLines(p, u, q, w, s, t))
    {
      return {};
    }
    Touch* touch = roomFor(kept, 1);
    touch->point = p + std::clamp(s, 0.0, 1.0) * u;
    touch->distance = axis.distance;
    touch->feature = axis.first;
    return { touch, 1 };
  }
  const bool faceOfFirst = axis.kind == PairAxis::Kind::FaceOfFirst;
  const PairBody& owner = faceOfFirst ? first : second;
  const PairBody& body = faceOfFirst ? second : first;
  const int face = faceOfFirst ? axis.first : axis.second;
  const double smaller = std::min(first.radius, second.radius);
  const SharedPolygon polygon(body, owner, face, axis.distance, 1e-6 * smaller);
  Touch* touches = roomFor(kept, polygon.size());
  std::size_t count = 0;
  const double one = kOnePoint * smaller;
  const Vec3 normal = owner.normal(face);
  const double offset = owner.offset(face);
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Corner& corner = polygon[i];
    const double distance = normal.dot(corner.point) - offset;
    bool isNew = distance <= reach;
    for (std::size_t k = 0; isNew && k < count; ++k)
    {
      isNew = !((touches[k].point - corner.point).squaredNorm() < one * one);
    }
    if (isNew)
    {
      touches[count++] = { corner.point, distance, corner.feature };
    }
  }
  return { touches, count };
}

std::span<const Touch> orAlongBest(std::span<const Touch> found, const PairBody& first,
  const PairBody& second, PairAxis& axis, double reach, double below)
{
  if (!found.empty() || axis.distance >= 0.0)
  {
    return found;
  }
  axis = bestAxis(first, second, axis);
  return axis.distance < below ? touchesAlong(first, second, axis, reach)
                               : std::span<const Touch>();
}

void findTouches(const PairBody& first, const PairBody& second, PairAxis& axis, double reach,
  std::vector<Contact>& contacts, double below)
{
  contacts.clear();
  const std::span<const Touch> touches =
    orAlongBest(touchesAlong(first, second, axis, reach), first, second, axis, reach, below);
  for (const Touch& touch : touches)
  {
    if (touch.distance < below)
    {
      putTouch(touch, second, axis, contacts.emplace_back());
    }
  }
}

} // namespace rockfall
