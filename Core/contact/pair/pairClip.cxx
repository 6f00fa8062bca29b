#include "contact/pair/pairClip.h"

#include <algorithm>
#include <limits>

namespace rockfall
{

namespace
{

using Two = Eigen::Array2d;

/// A number for the place where the side between two corners is cut by side k of the other face.
int cutFeature(int from, int to, int k)
{
  std::uint64_t hash = std::uint64_t(std::uint32_t(from)) << 32 | std::uint32_t(to);
  hash = (hash ^ std::uint64_t(k + 1) * 0x9e3779b97f4a7c15ull) * 0xff51afd7ed558ccdull;
  hash = (hash ^ hash >> 32) * 0xff51afd7ed558ccdull;
  return -1 - int(hash >> 34);
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

} // namespace

inline void SharedPolygon::Sides::set(
  const Vec3& normal, const Vec3 (&starts)[4], const Vec3 (&along)[4], double tolerance)
{
  for (int i = 0; i < 2; ++i)
  {
    const Vec3 &p = starts[2 * i], &q = starts[2 * i + 1];
    const Vec3 &u = along[2 * i], &w = along[2 * i + 1];
    const Two dx(u.x(), w.x()), dy(u.y(), w.y()), dz(u.z(), w.z());
    const Two nx = dy * normal.z() - dz * normal.y();
    const Two ny = dz * normal.x() - dx * normal.z();
    const Two nz = dx * normal.y() - dy * normal.x();
    const Two length = (nx * nx + ny * ny + nz * nz).sqrt();
    x[i] = nx / length;
    y[i] = ny / length;
    z[i] = nz / length;
    offset[i] =
      x[i] * Two(p.x(), q.x()) + y[i] * Two(p.y(), q.y()) + z[i] * Two(p.z(), q.z()) + tolerance;
  }
}

inline void SharedPolygon::Sides::look(Corner& corner) const
{
  const Vec3& p = corner.point;
  for (int i = 0; i < 2; ++i)
  {
    Eigen::Map<Two, Eigen::Aligned16>(corner.out + 2 * i) =
      x[i] * p.x() + y[i] * p.y() + z[i] * p.z() - offset[i];
  }
}

SharedPolygon::SharedPolygon(
  const PairBody& body, const PairBody& owner, int ownerFace, double gap, double tolerance)
{
  const Vec3 normal = owner.normal(ownerFace);
  const double lowest = owner.offset(ownerFace) + gap + tolerance;
  const std::span<const int> cut = body.loop(mostOpposed(body, normal, lowest));
  const std::span<const int> loop = owner.loop(ownerFace);
  const int sides = int(loop.size());
  size_ = cut.size();
  // Each side adds two corners and takes one at least, unless rounding bends what is nearly
  // straight.
  room_ = std::max(kFew, 2 * size_ + 2 * loop.size());
  corners_ = corner_.of(room_);
  order_ = orders_[0].of(room_);
  other_ = orders_[1].of(room_);
  made_ = int(size_);
  for (int i = 0; i < made_; ++i)
  {
    const int v = cut[std::size_t(i)];
    corners_[i].point = body.vertex(v);
    corners_[i].feature = v;
    order_[i] = i;
  }
  Sides four;
  Vec3 end = owner.vertex(loop[0]), start = end, along = Vec3::Zero();
  for (int first = 0; first < sides && size_ > 0; first += 4)
  {
    // Four sides next to each other, the last one repeated to fill them up.
    Vec3 starts[4], ways[4];
    for (int k = 0; k < 4; ++k)
    {
      const int next = first + k + 1;
      if (next <= sides)
      {
        start = end;
        end = owner.vertex(loop[next < sides ? std::size_t(next) : 0]);
        along = end - start;
      }
      starts[k] = start;
      ways[k] = along;
    }
    four.set(normal, starts, ways, tolerance);
    Two farthest[2] = { Two::Zero(), Two::Zero() };
    for (std::size_t i = 0; i < size_; ++i)
    {
      Corner& corner = corners_[order_[i]];
      four.look(corner);
      farthest[0] = farthest[0].max(Eigen::Map<const Two>(corner.out));
      farthest[1] = farthest[1].max(Eigen::Map<const Two>(corner.out + 2));
    }
    // Cutting takes nothing out of sides that all are within.
    int last = std::min(4, sides - first) - 1;
    while (last >= 0 && !(farthest[last / 2][last % 2] > 0.0))
    {
      --last;
    }
    for (int k = 0; k <= last && size_ > 0; ++k)
    {
      if (farthest[k / 2][k % 2] > 0.0)
      {
        this->clip(four, first + k, k, k == last);
      }
    }
  }
}

inline void SharedPolygon::clip(const Sides& sides, int side, int lane, bool last)
{
  const std::size_t size = size_, most = std::size_t(made_) + size;
  if (most > room_)
  {
    corners_ = corner_.more(corners_, std::size_t(made_), 2 * most);
    order_ = orders_[at_].more(order_, size, 2 * most);
    other_ = orders_[1 - at_].of(2 * most);
    room_ = 2 * most;
  }
  Corner* const corners = corners_;
  int* const order = order_;
  int* const left = other_;
  int made = made_;
  std::size_t count = 0;
  order[size] = order[0];
  const Corner* here = corners + order[0];
  double d0 = here->out[lane];
  for (std::size_t i = 0; i < size; ++i)
  {
    const Corner* const next = corners + order[i + 1];
    const double d1 = next->out[lane];
    if (d0 <= 0.0)
    {
      left[count++] = order[i];
    }
    if ((d0 < 0.0 && d1 > 0.0) || (d0 > 0.0 && d1 < 0.0))
    {
      Corner& corner = corners[made];
      corner.point = here->point + (d0 / (d0 - d1)) * (next->point - here->point);
      corner.feature = cutFeature(here->feature, next->feature, side);
      if (!last)
      {
        sides.look(corner);
      }
      left[count++] = made++;
    }
    here = next;
    d0 = d1;
  }
  other_ = order;
  order_ = left;
  at_ = 1 - at_;
  made_ = made;
  size_ = count;
}

} // namespace rockfall
