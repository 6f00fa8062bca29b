#include "contact/pairs.h"

#include "contact/features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

/// Points nearer than this share of the smaller radius are one, and a point that has moved by less
/// on its rock since the last step is the same.
constexpr double kOnePoint = 1e-3;
constexpr double kSamePoint = 0.05;
/// What is deeper than reckoned by more than this share of the smaller radius is no compression.
constexpr double kMisreckoned = 1e-4;

/// A corner of the polygon that two faces share.
struct Corner
{
  Vec3 point;
  int feature; ///< Of the face that is cut: a vertex, or < 0: where a side of it is cut.
};

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

int mostOpposed(const PairBody& body, const Vec3& normal)
{
  int face = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int f = 0; f < body.faces(); ++f)
  {
    const double along = body.normal(f).dot(normal);
    if (along < least)
    {
      least = along;
      face = f;
    }
  }
  return face;
}

/// The face of `body` that is most against `normal`, cut by the prism over a face of `owner`
/// (Sutherland & Hodgman 1974).
void clipFace(const PairBody& body, const PairBody& owner, int ownerFace, double tolerance,
  std::vector<Corner>& polygon, std::vector<Corner>& work)
{
  const Vec3 normal = owner.normal(ownerFace);
  polygon.clear();
  const int facing = mostOpposed(body, normal);
  for (int v : body.placed->block().shape().faces()[facing])
  {
    polygon.push_back({ body.placed->vertices()[v], v });
  }
  const std::vector<int>& loop = owner.placed->block().shape().faces()[ownerFace];
  for (std::size_t k = 0; k < loop.size() && !polygon.empty(); ++k)
  {
    const Vec3& a = owner.placed->vertices()[loop[k]];
    const Vec3& b = owner.placed->vertices()[loop[(k + 1) % loop.size()]];
    const Vec3 out = (b - a).cross(normal).normalized();
    const double offset = out.dot(a) + tolerance;
    work.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
      const Corner& from = polygon[i];
      const Corner& to = polygon[(i + 1) % polygon.size()];
      const double d0 = out.dot(from.point) - offset, d1 = out.dot(to.point) - offset;
      if (d0 <= 0.0)
      {
        work.push_back(from);
      }
      if ((d0 < 0.0 && d1 > 0.0) || (d0 > 0.0 && d1 < 0.0))
      {
        const double s = d0 / (d0 - d1);
        work.push_back({ from.point + s * (to.point - from.point),
          cutFeature(from.feature, to.feature, int(k)) });
      }
    }
    polygon.swap(work);
  }
}

/// Whether the point is where an edge is cut, and no vertex.
bool isCut(const Contact& c)
{
  return c.kind == ContactKind::VertexFace
    ? c.rockFeature < 0
    : c.kind == ContactKind::FaceVertex && c.surfaceFeature < 0;
}

/// What was in springs that are gone goes into those that are new, or else into those that stay.
void handOver(const std::vector<char>& taken, const std::vector<char>& known,
  const std::vector<Contact>& before, std::vector<Contact>& now)
{
  double energy = 0.0;
  const Contact* strongest = nullptr;
  for (std::size_t k = 0; k < before.size(); ++k)
  {
    const Contact& c = before[k];
    if (!taken[k] && c.closed())
    {
      const double compressed = std::min(0.0, c.gap());
      energy += 0.5 * c.stiffness * compressed * compressed;
      strongest = !strongest || c.normalForce > strongest->normalForce ? &c : strongest;
    }
  }
  if (energy <= 0.0)
  {
    return;
  }
  const auto fresh = std::count(known.begin(), known.end(), char(0));
  const double share =
    energy / double(fresh > 0 ? fresh : std::max<std::ptrdiff_t>(1, known.size()));
  for (std::size_t i = 0; i < now.size(); ++i)
  {
    Contact& c = now[i];
    if (fresh > 0 && known[i])
    {
      continue;
    }
    if (!known[i])
    {
      c.state = strongest->state;
      c.stiffness = strongest->stiffness;
      c.shearStiffness = strongest->shearStiffness;
      c.dashpot = strongest->dashpot;
      c.shearDashpot = strongest->shearDashpot;
      c.frequency2 = strongest->frequency2;
    }
    const double compressed = std::min(0.0, c.gap());
    if (c.stiffness > 0.0)
    {
      c.offset = c.distance + std::sqrt(compressed * compressed + 2.0 * share / c.stiffness);
      c.state = c.closed() ? c.state : ContactState::Sliding;
    }
  }
}

} // namespace

void findTouches(const PairBody& first, const PairBody& second, const PairAxis& axis, double reach,
  std::vector<Contact>& contacts)
{
  contacts.clear();
  const double smaller = std::min(first.placed->block().radius(), second.placed->block().radius());
  Contact c;
  c.normal = axis.normal;
  if (axis.kind == PairAxis::Kind::Edges)
  {
    const std::array<int, 2>& e = first.placed->block().shape().edges()[axis.first].vertices;
    const std::array<int, 2>& f = second.placed->block().shape().edges()[axis.second].vertices;
    const Vec3& p = first.placed->vertices()[e[0]];
    const Vec3& q = second.placed->vertices()[f[0]];
    const Vec3 u = first.placed->vertices()[e[1]] - p, w = second.placed->vertices()[f[1]] - q;
    double s = 0.5, t = 0.5;
    if (axis.distance > reach || !closestOnLines(p, u, q, w, s, t))
    {
      return;
    }
    c.kind = ContactKind::EdgeEdge;
    c.rockFeature = axis.first;
    c.surfaceFeature = axis.second;
    c.point = p + std::clamp(s, 0.0, 1.0) * u;
    c.ridge = { q, w };
    c.distance = axis.distance;
    contacts.push_back(c);
    return;
  }
  const bool faceOfFirst = axis.kind == PairAxis::Kind::FaceOfFirst;
  const PairBody& owner = faceOfFirst ? first : second;
  const PairBody& body = faceOfFirst ? second : first;
  const int face = faceOfFirst ? axis.first : axis.second;
  thread_local std::vector<Corner> polygon, work;
  clipFace(body, owner, face, 1e-6 * smaller, polygon, work);
  c.kind = faceOfFirst ? ContactKind::FaceVertex : ContactKind::VertexFace;
  const double one = kOnePoint * smaller;
  for (const Corner& corner : polygon)
  {
    c.distance = owner.normal(face).dot(corner.point) - owner.offset(face);
    c.point = corner.point;
    c.rockFeature = faceOfFirst ? face : corner.feature;
    c.surfaceFeature = faceOfFirst ? corner.feature : face;
    if (c.distance > reach)
    {
      continue;
    }
    const bool known = std::any_of(contacts.begin(), contacts.end(),
      [&](const Contact& o) { return (o.point - c.point).squaredNorm() < one * one; });
    if (!known)
    {
      contacts.push_back(c);
    }
  }
}

void updatePair(const PairBody& first, const PairBody& second, double reach, RockPair& pair)
{
  const PairAxis last = pair.known || pair.seen ? pair.before : pair.axis;
  const auto closed = [&]
  {
    return std::any_of(
      pair.contacts.begin(), pair.contacts.end(), [](const Contact& c) { return c.closed(); });
  };
  const bool stands = pair.seen && (pair.axis.distance <= 0.0 || pair.axis.distance > reach);
  if (!pair.known && !stands)
  {
    pair.axis = findAxis(first, second, pair.axis, reach);
  }
  pair.known = pair.seen = false;
  if (pair.axis.distance > reach)
  {
    // A spring that is still compressed, as it was found or handed over so, opens by itself.
    if (!closed())
    {
      pair.contacts.clear();
      pair.touched = false;
    }
    return;
  }
  const bool turned =
    last.kind != pair.axis.kind || last.first != pair.axis.first || last.second != pair.axis.second;
  thread_local std::vector<Contact> found;
  findTouches(first, second, pair.axis, reach, found);
  if (found.empty() && closed())
  {
    pair.axis = last; // past the end of a feature, with no other one there
    return;
  }
  const double same =
    kSamePoint * std::min(first.placed->block().radius(), second.placed->block().radius());
  const double far =
    kMisreckoned * std::min(first.placed->block().radius(), second.placed->block().radius());
  thread_local std::vector<char> taken, known;
  taken.assign(pair.contacts.size(), 0);
  known.assign(found.size(), 0);
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    Contact& c = found[i];
    int nearest = -1;
    double least = same * same;
    bool itself = false;
    for (int k = 0; k < int(pair.contacts.size()); ++k)
    {
      // The old point is where its rock has carried it since (see the solver's write-back).
      const Contact& old = pair.contacts[k];
      const double away = (old.point - c.point).squaredNorm();
      const bool equal = old.kind == c.kind && old.rockFeature == c.rockFeature &&
        old.surfaceFeature == c.surfaceFeature;
      if (!taken[k] && (equal || (!itself && away < least)))
      {
        itself = equal;
        least = away;
        nearest = k;
      }
    }
    if (nearest >= 0)
    {
      const Contact& old = pair.contacts[nearest];
      taken[nearest] = known[i] = 1;
      const bool near = least < same * same;
      c.state = old.state;
      c.slip = old.slip - old.slip.dot(c.normal) * c.normal;
      c.offset = old.offset;
      if (itself && near && isCut(c))
      {
        // Where an edge leaves a face is no point of a rock: the point that was there stays.
        c.distance += (pair.axis.kind == PairAxis::Kind::FaceOfFirst ? -1.0 : 1.0) *
          c.normal.dot(old.point - c.point);
        c.point = old.point;
      }
      else if (old.closed() && (turned || !itself || isCut(c)))
      {
        // Seen elsewhere the gap is another one: the spring keeps its compression.
        c.offset = c.distance - old.gap();
      }
      // A step reckons with levers of its middle; where the rocks have turned far they end up
      // deeper than reckoned, and that is no compression.
      const double reckoned = std::min(0.0, old.gap());
      c.offset = c.gap() < reckoned - far ? c.distance - reckoned : c.offset;
      c.stiffness = old.stiffness;
      c.shearStiffness = old.shearStiffness;
      c.dashpot = old.dashpot;
      c.shearDashpot = old.shearDashpot;
      c.frequency2 = old.frequency2;
      c.normalForce = old.normalForce;
    }
    else
    {
      // Found overlapping: finding it makes no energy.
      c.offset = std::min(0.0, c.distance);
    }
  }
  handOver(taken, known, pair.contacts, found);
  pair.contacts.swap(found);
}

} // namespace rockfall
