#include "contact/pairTouch.h"

#include "contact/features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// Points nearer than this share of the smaller radius are one.
constexpr double kOnePoint = 1e-3;

/// A corner of the polygon that two faces share, and how far out it is of the side at hand.
struct Corner
{
  Vec3 point;
  int feature; ///< Of the face that is cut: a vertex, or < 0: where a side of it is cut.
  double out;  ///< m
};

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

/// A number for the place where the side between two corners is cut by side k of the other face.
int cutFeature(int from, int to, int k)
{
  std::uint64_t hash = 0x9e3779b97f4a7c15ull;
  for (int part : { from, to, k })
  {
    hash = (hash ^ std::uint32_t(part)) * 0xff51afd7ed558ccdull;
    hash ^= hash >> 32;
  }
  return -1 - int(hash & 0x3fffffff);
}

/// The face that is most against `normal`, of those that reach as low along it as the body does
/// (`lowest`, m, with its tolerance): a splinter may turn another one towards it from behind its
/// point.
int mostOpposed(const PairBody& body, const Vec3& normal, double lowest)
{
  const auto reachesDown = [&](int face)
  {
    const std::span<const int> loop = body.loop(face);
    return std::any_of(
      loop.begin(), loop.end(), [&](int v) { return normal.dot(body.vertex(v)) <= lowest; });
  };
  int face = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < body.faceFours(); ++i)
  {
    const PairBody::Four along = body.alongNormals(normal, i);
    for (int k = 0; k < 4; ++k) // what fills the last four up is no better than the last face
    {
      if (along[k] < least)
      {
        least = along[k];
        face = 4 * i + k;
      }
    }
  }
  if (reachesDown(face))
  {
    return face;
  }
  least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < body.faces(); ++i)
  {
    const double along = normal.dot(body.normal(i));
    if (along < least && reachesDown(i))
    {
      least = along;
      face = i;
    }
  }
  return face;
}

/// The face of `body` that lies towards a face of `owner`, cut by the prism over that (Sutherland &
/// Hodgman 1974). `gap` (m): of the body's lowest vertex over it.
std::span<const Corner> clipFace(
  const PairBody& body, const PairBody& owner, int ownerFace, double gap, double tolerance)
{
  thread_local std::vector<Corner> keptA, keptB;
  const Vec3 normal = owner.normal(ownerFace);
  const double lowest = owner.offset(ownerFace) + gap + tolerance;
  const std::span<const int> cut = body.loop(mostOpposed(body, normal, lowest));
  const std::span<const int> loop = owner.loop(ownerFace);
  std::vector<Corner>*from = &keptA, *to = &keptB;
  Corner* polygon = roomFor(*from, cut.size());
  std::size_t size = 0;
  for (int v : cut)
  {
    polygon[size].point = body.vertex(v);
    polygon[size++].feature = v;
  }
  Vec3 a = owner.vertex(loop[0]);
  for (std::size_t k = 0; k < loop.size() && size > 0; ++k)
  {
    const Vec3 b = owner.vertex(loop[k + 1 < loop.size() ? k + 1 : 0]);
    const Vec3 out = (b - a).cross(normal).normalized();
    const double offset = out.dot(a) + tolerance;
    a = b;
    bool any = false;
    for (std::size_t i = 0; i < size; ++i)
    {
      polygon[i].out = out.dot(polygon[i].point) - offset;
      any = any || polygon[i].out > 0.0;
    }
    if (!any)
    {
      continue;
    }
    // One more than there were, unless rounding bends what is nearly straight.
    Corner* work = roomFor(*to, 2 * size);
    std::size_t left = 0;
    for (std::size_t i = 0; i < size; ++i)
    {
      const Corner& here = polygon[i];
      const Corner& next = polygon[i + 1 < size ? i + 1 : 0];
      const double d0 = here.out, d1 = next.out;
      if (d0 <= 0.0)
      {
        work[left++] = here;
      }
      if ((d0 < 0.0 && d1 > 0.0) || (d0 > 0.0 && d1 < 0.0))
      {
        const double s = d0 / (d0 - d1);
        work[left].point = here.point + s * (next.point - here.point);
        work[left++].feature = cutFeature(here.feature, next.feature, int(k));
      }
    }
    std::swap(from, to);
    polygon = work;
    size = left;
  }
  return { polygon, size };
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
  const std::span<const Corner> polygon =
    clipFace(body, owner, face, axis.distance, 1e-6 * smaller);
  Touch* touches = roomFor(kept, polygon.size());
  std::size_t count = 0;
  const double one = kOnePoint * smaller;
  const Vec3 normal = owner.normal(face);
  const double offset = owner.offset(face);
  for (const Corner& corner : polygon)
  {
    const double distance = normal.dot(corner.point) - offset;
    if (distance <= reach &&
      std::none_of(touches, touches + count,
        [&](const Touch& o) { return (o.point - corner.point).squaredNorm() < one * one; }))
    {
      touches[count++] = { corner.point, distance, corner.feature };
    }
  }
  return { touches, count };
}

std::span<const Touch> orAlongBest(std::span<const Touch> found, const PairBody& first,
  const PairBody& second, PairAxis& axis, double reach)
{
  if (!found.empty() || axis.distance >= 0.0)
  {
    return found;
  }
  axis = bestAxis(first, second);
  return touchesAlong(first, second, axis, reach);
}

void findTouches(const PairBody& first, const PairBody& second, PairAxis& axis, double reach,
  std::vector<Contact>& contacts)
{
  const std::span<const Touch> touches =
    orAlongBest(touchesAlong(first, second, axis, reach), first, second, axis, reach);
  contacts.assign(touches.size(), Contact());
  for (std::size_t i = 0; i < touches.size(); ++i)
  {
    putTouch(touches[i], second, axis, contacts[i]);
  }
}

} // namespace rockfall
