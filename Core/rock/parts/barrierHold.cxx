#include "rock/parts/barrierHold.h"

#include "contact/ground/roundContact.h"
#include "law/settings.h"
#include "terrain/Obstacles.h"

#include <algorithm>

namespace rockfall
{

namespace
{

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

/// Of a rock, from its centroid, m.
struct Outline
{
  double left = 0.0, right = 0.0; ///< Along a line.
  double bottom = 0.0, top = 0.0;
};

Outline outlineAlong(const Vec2& line, const Block& block, const BlockState& at)
{
  Outline o;
  PlacedBlock placed;
  placed.place(block, at);
  if (isRound(placed))
  {
    const Mat3 axes = roundAxes(placed);
    o.right = roundReach(axes, Vec3(line.x(), line.y(), 0.0));
    o.top = roundReach(axes, Vec3::UnitZ());
    return { -o.right, o.right, -o.top, o.top };
  }
  for (const Vec3& vertex : placed.vertices())
  {
    const Vec3 from = vertex - at.position;
    const double along = line.dot(from.head<2>());
    o.left = std::min(o.left, along);
    o.right = std::max(o.right, along);
    o.bottom = std::min(o.bottom, from.z());
    o.top = std::max(o.top, from.z());
  }
  return o;
}

} // namespace

BarrierMeets meetsOutline(const Obstacles& obstacles, int piece, const BarrierState& state,
  std::span<const int> broken, const Block& block, const BlockState& at, double height)
{
  const Obstacles::Piece& own = obstacles.barrierPieces()[std::size_t(piece)];
  const std::vector<Barrier>& barriers = obstacles.structures().barriers;
  const Barrier& barrier = barriers[std::size_t(own.barrier)];
  const Vec2 line = (own.to - own.from).normalized(), normal(-line.y(), line.x());
  const Outline o = outlineAlong(line, block, at);
  const double share = barrier.overhang;
  const double lifted = std::max(height, state.fill - o.bottom);
  if (!(lifted + o.bottom < state.rope))
  {
    return BarrierMeets::Nothing;
  }
  const double length = (own.to - own.from).norm(), end = kPieceEnd * length;
  const double centre = line.dot(at.position.head<2>() - own.from);
  const auto onPiece = [&](double place) { return place >= -end && place <= length + end; };
  /// Whether another piece of its kind stands before a place along the line, m.
  const auto othersHold = [&](double place)
  {
    const Vec2 half = 2.0 * block.radius() * normal, from = own.from + place * line - half;
    const Vec2 to = from + 2.0 * half;
    bool any = false;
    obstacles.visitBarriers(std::min(from.x(), to.x()), std::max(from.x(), to.x()),
      std::min(from.y(), to.y()), std::max(from.y(), to.y()),
      [&](const Obstacles::Piece& other)
      {
        const Vec2 way = other.to - other.from, ray = to - from, between = from - other.from;
        const double det = cross(way, ray);
        const double onWay = cross(between, ray) / det, onRay = cross(between, way) / det;
        any = any ||
          (&other != &own && barriers[std::size_t(other.barrier)].records == barrier.records &&
            std::find(broken.begin(), broken.end(), other.barrier) == broken.end() &&
            onWay >= -kPieceEnd && onWay <= 1.0 + kPieceEnd && onRay >= 0.0 && onRay <= 1.0);
      });
    return any;
  };
  if (!onPiece(centre) && othersHold(centre))
  {
    return BarrierMeets::Nothing; // it meets that one
  }
  if (centre + o.right < -end || centre + o.left > length + end)
  {
    return BarrierMeets::Nothing;
  }
  const double mayStandOut = share * (o.right - o.left);
  const auto isHeld = [&](double place) { return onPiece(place) || othersHold(place); };
  const bool under = lifted + o.top - share * (o.top - o.bottom) <= state.rope;
  return under && isHeld(centre + o.left + mayStandOut) && isHeld(centre + o.right - mayStandOut)
    ? BarrierMeets::Holds
    : BarrierMeets::Strikes;
}

} // namespace rockfall
