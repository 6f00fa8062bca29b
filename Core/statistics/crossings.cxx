#include "statistics/crossings.h"

#include "base/abort.h"
#include "statistics/design.h"
#include "terrain/Terrain.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace rockfall
{

namespace
{

/// A path whose end is no further from a line ends on it, m.
constexpr double kOnLine = 1e-6;
/// A path that begins on a line is off it when it is farther than this, m: cubics between samples,
/// up to a touch, swing to the other side by millimetres.
constexpr double kOffLine = 1e-2;

/// A path that passes a vertex of a line nearer than this is looked at from this far, where it is
/// clear on which side of the line it is, m.
constexpr double kAtVertex = 1e-6;

/// As far from a line as rounding leaves what lies in it, m.
constexpr double kInLine = 1e-12;

using Vec2 = Eigen::Vector2d;

struct Segment
{
  Vec2 from, to;
  Vec2 along;  ///< Unit.
  Vec2 normal; ///< Unit, to the left.
  double length;
  double before; ///< Of the line up to here, m.
  const Segment *previous = nullptr,
                *next = nullptr; ///< None at the ends of an open line.

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
  std::size_t last = 0; // of the points that count
  for (std::size_t k = 1; k < line.points.size(); ++k)
  {
    const Vec2 &from = line.points[last], &to = line.points[k];
    const double length = (to - from).norm();
    if (length > 4.0 * kAtVertex)
    {
      const Vec2 along = (to - from) / length;
      segments.push_back({ from, to, along, Vec2(-along.y(), along.x()), length, before });
      before += length;
      last = k;
    }
  }
  for (std::size_t k = 1; k < segments.size(); ++k)
  {
    segments[k].previous = &segments[k - 1];
    segments[k - 1].next = &segments[k];
  }
  if (segments.size() > 2 && segments.front().from == segments.back().to)
  {
    segments.front().previous = &segments.back();
    segments.back().next = &segments.front();
  }
  return segments;
}

bool near(const PathPiece& piece, const Segment& segment)
{
  for (int axis = 0; axis < 2; ++axis)
  {
    const auto [low, high] = piece.bounds(axis);
    const auto [a, b] = std::minmax(segment.from[axis], segment.to[axis]);
    if (high < a - kAtVertex || low > b + kAtVertex)
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
  if (terrain)
  {
    crossing.centreOverGround =
      crossing.position.z() - terrain->elevation(crossing.position.x(), crossing.position.y());
  }
  const Vec2 v = crossing.velocity.head<2>();
  crossing.horizontalAngle = std::atan2(segment.along.dot(v), direction * segment.normal.dot(v));
  crossing.verticalAngle = std::atan2(crossing.velocity.z(), v.norm());
  return crossing;
}

Vec2 planAt(const PathPiece& piece, double s)
{
  return { piece.along(0)(s), piece.along(1)(s) };
}

/// Where on a path: on the piece that ends with this point, at s.
using PathPlace = std::pair<std::size_t, double>;

/// Goes along the path, on or back, to where it comes out of the surroundings of a vertex; nothing
/// if it ends in them.
std::optional<Vec2> wayOut(const RockPath& path, PathPlace& place, const Vec2& vertex, bool onwards)
{
  const std::size_t first = place.first;
  for (std::size_t k = first; k > 0 && k < path.points.size(); onwards ? ++k : --k)
  {
    const PathPoint &a = path.points[k - 1], &b = path.points[k];
    if (!(b.time > a.time))
    {
      continue;
    }
    const PathPiece piece(a, b, path.mass);
    const auto isAt = [&](double s) { return (planAt(piece, s) - vertex).norm() <= kAtVertex; };
    const double end = onwards ? 1.0 : 0.0;
    double in = k == first ? place.second : 1.0 - end;
    for (double step = 1e-9; in != end; step *= 2.0)
    {
      double out = onwards ? std::min(in + step, 1.0) : std::max(in - step, 0.0);
      if (isAt(out))
      {
        in = out;
        continue;
      }
      for (int halving = 0; halving < 50; ++halving)
      {
        const double middle = 0.5 * (in + out);
        (isAt(middle) ? in : out) = middle;
      }
      place = { k, out };
      return planAt(piece, out);
    }
  }
  return std::nullopt;
}

/// The segment that a place near a vertex lies in, if it does. `in` ends at the vertex.
const Segment* segmentUnder(const Vec2& place, const Segment& in, const Segment& out)
{
  const Vec2 from = place - out.from;
  if (in.along.dot(from) < 0.0 && std::abs(in.normal.dot(from)) <= kInLine)
  {
    return &in;
  }
  return out.along.dot(from) > 0.0 && std::abs(out.normal.dot(from)) <= kInLine ? &out : nullptr;
}

/// On which side of the line a place near a vertex is.
bool isLeft(const Vec2& place, const Segment& in, const Segment& out)
{
  const Vec2 from = place - out.from;
  const bool ofIn = in.normal.dot(from) > 0.0, ofOut = out.normal.dot(from) > 0.0;
  return in.normal.dot(out.along) > 0.0 ? ofIn && ofOut : ofIn || ofOut;
}

/// A stay of the path in the surroundings of a vertex.
struct Visit
{
  const Segment* in;
  PathPlace first, last;
};

/// 1 if a path that is at the vertex between two segments at `place` goes to the left of the line
/// there, −1 if to its right, 0 if it stays on its side, begins or ends there, or goes on in the
/// line. Each stay counts once, whichever of the segments it was found with.
int passingOf(const RockPath& path, const PathPlace& place, const Segment& in, const Segment& out,
  std::vector<Visit>& visits)
{
  for (const Visit& visit : visits)
  {
    if (visit.in == &in && visit.first <= place && place <= visit.last)
    {
      return 0;
    }
  }
  Visit visit{ &in, place, place };
  const auto from = wayOut(path, visit.first, out.from, false);
  const auto to = wayOut(path, visit.last, out.from, true);
  visits.push_back(visit);
  if (!from || !to || segmentUnder(*to, in, out))
  {
    return 0;
  }
  bool wasLeft = isLeft(*from, in, out);
  if (const Segment* under = segmentUnder(*from, in, out))
  {
    // A path that comes in the line: where it was before.
    std::size_t k = visit.first.first;
    const auto sideOf = [&](std::size_t point)
    { return under->side(path.points[point].position.x(), path.points[point].position.y()); };
    do
    {
      --k;
    } while (k > 0 && std::abs(sideOf(k)) <= kOnLine);
    if (std::abs(sideOf(k)) <= kOnLine)
    {
      return 0; // nowhere else
    }
    wasLeft = sideOf(k) > 0.0;
  }
  const bool goesLeft = isLeft(*to, in, out);
  return goesLeft == wasLeft ? 0 : goesLeft ? 1 : -1;
}

/// The crossing where the path comes through the plane of a segment, if it does in the segment.
void appendAt(const RockPath& path, const PathPiece& piece, const PathPlace& place,
  const Segment& segment, int direction, const Terrain* terrain, std::vector<Visit>& visits,
  std::vector<Crossing>& crossings)
{
  const double s = place.second;
  const Vec2 at = planAt(piece, s);
  // Rounding would have it in both of the segments at a vertex or in none.
  for (const auto& [in, out] :
    { std::pair(segment.previous, &segment), std::pair(&segment, segment.next) })
  {
    if (in && out && (at - out->from).norm() <= kAtVertex)
    {
      if (const int passing = passingOf(path, place, *in, *out, visits))
      {
        const Vec2 v = piece.velocity(s).head<2>();
        const bool ofIn = passing * in->normal.dot(v) >= passing * out->normal.dot(v);
        crossings.push_back(crossingAt(piece, s, ofIn ? *in : *out, passing, terrain));
      }
      return;
    }
  }
  const double along = segment.along.dot(at - segment.from);
  if (along >= 0.0 && along <= segment.length)
  {
    crossings.push_back(crossingAt(piece, s, segment, direction, terrain));
  }
}

void appendOf(const RockPath& path, const Segment& segment, const Terrain* terrain,
  std::vector<Visit>& visits, std::vector<Crossing>& crossings)
{
  const auto sideOf = [&segment](const PathPoint& p)
  { return segment.side(p.position.x(), p.position.y()); };
  double previous = 0.0; // the last side that was not 0
  // A path that begins on the line has not crossed it: until it is off, it has no side.
  const bool begins = std::abs(sideOf(path.points.front())) < kOnLine;
  const auto beyond = [&](double side)
  { return begins && previous == 0.0 && std::abs(side) < kOffLine ? 0.0 : side; };
  previous = beyond(sideOf(path.points.front()));
  for (std::size_t k = 1; k < path.points.size(); ++k)
  {
    const PathPoint &a = path.points[k - 1], &b = path.points[k];
    // A path that ends on the line, caught by a net there, has not crossed it.
    const bool last = k + 1 == path.points.size();
    const double side = sideOf(b);
    const double end = last && std::abs(side) < kOnLine ? 0.0 : beyond(side);
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
      const double value = whole ? end : beyond(distance(to));
      if (previous * value < 0.0)
      {
        // At its beginning if it came to the plane there and lay in it.
        const Roots roots = signChanges(distance, from, to);
        // Without a root an end is on the other side by rounding only.
        const double nearer = std::abs(distance(from)) < std::abs(distance(to)) ? from : to;
        const double s = valueFrom == 0.0 ? from : roots.count > 0 ? roots.at[0] : nearer;
        appendAt(path, piece, { k, s }, segment, value > 0.0 ? 1 : -1, terrain, visits, crossings);
      }
      previous = value != 0.0 ? value : previous;
      from = to;
      valueFrom = value;
    }
  }
}

} // namespace

double topOverGround(const Crossing& crossing, double width)
{
  return std::isnan(crossing.centreOverGround)
    ? crossing.heightOverGround + width
    : 2.0 * crossing.centreOverGround - crossing.heightOverGround;
}

void appendCrossings(const RockPath& path, const CollectorLine& line, int lineNumber,
  const Terrain* terrain, std::vector<Crossing>& crossings)
{
  stayWanted();
  checkPath(path);
  if (path.points.size() < 2)
  {
    return;
  }
  std::vector<Crossing> found;
  std::vector<Visit> visits;
  const std::vector<Segment> segments = segmentsOf(line);
  for (const Segment& segment : segments)
  {
    appendOf(path, segment, terrain, visits, found);
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
    crossing.piece = path.piece;
    crossing.number = number++;
    crossing.top = topOverGround(crossing, path.width);
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
    {
      return std::tie(a->iteration, a->rock, a->blockId, a->piece) <
        std::tie(b->iteration, b->rock, b->blockId, b->piece);
    });
  const auto rockOf = [](const Crossing& c) { return std::tie(c.iteration, c.rock, c.blockId); };
  std::vector<double> speeds;
  for (std::size_t k = 0; k < first.size();)
  {
    const Crossing& rock = *first[k];
    DesignPassing largest;
    largest.top = rock.top;
    double height = std::numeric_limits<double>::quiet_NaN();
    for (; k < first.size() && rockOf(*first[k]) == rockOf(rock); ++k)
    {
      const Crossing& piece = *first[k];
      largest.takeLarger(piece.kineticEnergy, piece.velocity.norm(), piece.top);
      height = std::fmax(height, piece.heightOverGround);
    }
    summary.frequencies.add(rock.weight);
    summary.energies.push_back(largest.energy);
    speeds.push_back(largest.speed);
    if (!std::isnan(height))
    {
      summary.heights.push_back(height);
    }
    summary.caught +=
      outcomeOf({ &largest, 1 }, line.barrierHeight, line.barrierCapacity).caught.rocks;
  }
  summary.rocks = int(summary.energies.size());
  summary.highestQuantile = highestQuantile(summary.energies.size());
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
