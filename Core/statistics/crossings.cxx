#include "statistics/crossings.h"

#include "terrain/Terrain.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace rockfall
{

namespace
{

/// A path whose end is no further from a line ends on it, m.
constexpr double kOnLine = 1e-6;

using Vec2 = Eigen::Vector2d;

struct Segment
{
  Vec2 from, to;
  Vec2 along;  ///< Unit.
  Vec2 normal; ///< Unit, to the left.
  double length;
  double before; ///< Of the line up to here, m.
  bool last;

  /// Distance to the left of the segment's plane, m.
  double side(double x, double y) const
  {
    return normal.x() * (x - from.x()) + normal.y() * (y - from.y());
  }
};

std::vector<Segment> segmentsOf(const CollectorLine& line)
{
  std::vector<Segment> segments;
  double before = 0.0;
  for (std::size_t k = 1; k < line.points.size(); ++k)
  {
    const Vec2 &from = line.points[k - 1], &to = line.points[k];
    const double length = (to - from).norm();
    if (length > 0.0)
    {
      const Vec2 along = (to - from) / length;
      segments.push_back({ from, to, along, Vec2(-along.y(), along.x()), length, before, false });
      before += length;
    }
  }
  if (!segments.empty())
  {
    segments.back().last = true;
  }
  return segments;
}

bool near(const PathPiece& piece, const Segment& segment)
{
  for (int axis = 0; axis < 2; ++axis)
  {
    const auto [low, high] = piece.bounds(axis);
    const auto [a, b] = std::minmax(segment.from[axis], segment.to[axis]);
    if (high < a || low > b)
    {
      return false;
    }
  }
  return true;
}

double heightAt(const PathPiece& piece, double s, const Terrain* terrain)
{
  if (terrain)
  {
    const auto ground = [&](double t)
    { return terrain->elevation(piece.along(0)(t), piece.along(1)(t)); };
    const double height = piece.height(ground(0.0), ground(1.0))(s) - ground(s);
    if (!std::isnan(height))
    {
      return height;
    }
  }
  return piece.height()(s);
}

Crossing crossingAt(
  const PathPiece& piece, double s, const Segment& segment, int direction, const Terrain* terrain)
{
  Crossing crossing;
  crossing.time = piece.time(s);
  crossing.position = piece.position(s);
  crossing.distance =
    segment.before + segment.along.dot(crossing.position.head<2>() - segment.from);
  crossing.direction = direction;
  crossing.velocity = piece.velocity(s);
  crossing.rotationRate = piece.rotationRate(s);
  crossing.kineticEnergy = piece.kineticEnergy(s);
  crossing.translationalEnergy = piece.translationalEnergy(s);
  crossing.heightOverGround = heightAt(piece, s, terrain);
  const Vec2 v = crossing.velocity.head<2>();
  crossing.horizontalAngle = std::atan2(segment.along.dot(v), direction * segment.normal.dot(v));
  crossing.verticalAngle = std::atan2(crossing.velocity.z(), v.norm());
  return crossing;
}

void appendOf(const RockPath& path, const Segment& segment, const Terrain* terrain,
  std::vector<Crossing>& crossings)
{
  const auto sideOf = [&segment](const PathPoint& p)
  { return segment.side(p.position.x(), p.position.y()); };
  double previous = sideOf(path.points.front()); // the last side that was not 0
  for (std::size_t k = 1; k < path.points.size(); ++k)
  {
    const PathPoint &a = path.points[k - 1], &b = path.points[k];
    // What ends on the line, caught by a net there, has not crossed it.
    const bool last = k + 1 == path.points.size();
    const double side = sideOf(b);
    const double end = last && std::abs(side) < kOnLine ? 0.0 : side;
    if (!(b.time > a.time))
    {
      previous = end != 0.0 ? end : previous;
      continue;
    }
    const PathPiece piece(a, b, path.mass);
    if (!near(piece, segment))
    {
      previous = end != 0.0 ? end : previous;
      continue;
    }
    Cubic distance;
    for (std::size_t i = 0; i < 4; ++i)
    {
      distance.c[i] =
        segment.normal.x() * piece.along(0).c[i] + segment.normal.y() * piece.along(1).c[i];
    }
    distance.c[0] -= segment.normal.dot(segment.from);
    // Where the side turns; the ends' sides are those of the points themselves, so that what one
    // piece ends with is what the next begins with.
    const Roots turns = extremes(distance, 0.0, 1.0);
    double from = 0.0;
    double valueFrom = sideOf(a);
    for (int t = 0; t <= turns.count; ++t)
    {
      const bool whole = t == turns.count;
      const double to = whole ? 1.0 : turns.at[std::size_t(t)];
      const double value = whole ? end : distance(to);
      if (previous * value < 0.0)
      {
        // At its beginning if it came to the plane there and lay in it.
        const Roots roots = signChanges(distance, from, to);
        const double s = valueFrom == 0.0 ? from : roots.count > 0 ? roots.at[0] : to;
        const double place =
          segment.along.dot(Vec2(piece.along(0)(s), piece.along(1)(s)) - segment.from);
        if (place >= 0.0 && (place < segment.length || (segment.last && place == segment.length)))
        {
          crossings.push_back(crossingAt(piece, s, segment, value > 0.0 ? 1 : -1, terrain));
        }
      }
      previous = value != 0.0 ? value : previous;
      from = to;
      valueFrom = value;
    }
  }
}

} // namespace

void appendCrossings(const RockPath& path, const CollectorLine& line, int lineNumber,
  const Terrain* terrain, std::vector<Crossing>& crossings)
{
  checkPath(path);
  if (path.points.size() < 2)
  {
    return;
  }
  std::vector<Crossing> found;
  for (const Segment& segment : segmentsOf(line))
  {
    appendOf(path, segment, terrain, found);
  }
  std::stable_sort(found.begin(), found.end(),
    [](const Crossing& a, const Crossing& b) { return a.time < b.time; });
  int number = 0;
  for (Crossing& crossing : found)
  {
    crossing.line = lineNumber;
    crossing.iteration = path.iteration;
    crossing.rock = path.rock;
    crossing.blockId = path.blockId;
    crossing.number = number++;
    crossings.push_back(crossing);
  }
}

LineSummary summarizeLine(const CollectorLine& line, int lineNumber,
  std::span<const Crossing> crossings, std::int64_t released)
{
  LineSummary summary;
  std::vector<const Crossing*> first;
  for (const Crossing& crossing : crossings)
  {
    if (crossing.line == lineNumber)
    {
      ++summary.crossings;
      if (crossing.number == 0)
      {
        first.push_back(&crossing);
      }
    }
  }
  std::sort(first.begin(), first.end(),
    [](const Crossing* a, const Crossing* b)
    { return std::tie(a->iteration, a->rock) < std::tie(b->iteration, b->rock); });
  std::vector<double> speeds;
  for (const Crossing* crossing : first)
  {
    summary.energies.push_back(crossing->kineticEnergy);
    speeds.push_back(crossing->velocity.norm());
    if (!std::isnan(crossing->heightOverGround))
    {
      summary.heights.push_back(crossing->heightOverGround);
    }
    summary.caught += crossing->heightOverGround <= line.barrierHeight &&
      crossing->kineticEnergy <= line.barrierCapacity;
  }
  summary.rocks = int(first.size());
  summary.share = released > 0 ? double(summary.rocks) / double(released)
                               : std::numeric_limits<double>::quiet_NaN();
  summary.shareError = binomialError(summary.share, double(released));
  summary.energy = statisticsOf(summary.energies);
  summary.height = statisticsOf(summary.heights);
  summary.speed = statisticsOf(speeds);
  summary.caughtShare = summary.rocks > 0 ? double(summary.caught) / summary.rocks
                                          : std::numeric_limits<double>::quiet_NaN();
  summary.caughtShareError = binomialError(summary.caughtShare, summary.rocks);
  return summary;
}

} // namespace rockfall
