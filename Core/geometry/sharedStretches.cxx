#include "base/abort.h"
#include "geometry/twins.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

namespace rockfall
{

namespace
{

using Point = Eigen::Vector2d;

/// From one place along a line to another one, m.
struct Interval
{
  double from, to;

  bool any() const { return to > from; }
};

constexpr Interval kNoInterval{ 1.0, 0.0 };

/// A straight part of a line, with the way along the line to it.
struct Piece
{
  int line;
  Point start, along;    ///< Unit vector `along`.
  double before, length; ///< m

  Point at(double way) const { return start + (way - before) * along; }
};

/// The ways along a piece that are within a distance of a point.
Interval withinDisc(const Piece& piece, const Point& centre, double radius)
{
  const Point to = centre - piece.start;
  const double way = to.dot(piece.along);
  const double half = radius * radius - (to - way * piece.along).squaredNorm();
  return half <= 0.0 ? kNoInterval : Interval{ way - std::sqrt(half), way + std::sqrt(half) };
}

/// Narrows an interval of x to that of low ≤ offset + slope x ≤ high.
Interval narrowed(Interval interval, double offset, double slope, double low, double high)
{
  if (slope == 0.0)
  {
    return offset >= low && offset <= high ? interval : kNoInterval;
  }
  const auto [from, to] = std::minmax({ (low - offset) / slope, (high - offset) / slope });
  return { std::max(interval.from, from), std::min(interval.to, to) };
}

/// The part of a piece that is within `kTwinDistance` of another one: that is convex, two discs and
/// the band between them.
Interval sharedPart(const Piece& piece, const Piece& other)
{
  const Point across(-other.along.y(), other.along.x());
  const Point between = piece.start - other.start;
  Interval band{ 0.0, piece.length };
  band = narrowed(band, between.dot(other.along), piece.along.dot(other.along), 0.0, other.length);
  band =
    narrowed(band, between.dot(across), piece.along.dot(across), -kTwinDistance, kTwinDistance);
  Interval all{ std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity() };
  for (const Interval& part : { band, withinDisc(piece, other.start, kTwinDistance),
         withinDisc(piece, other.start + other.length * other.along, kTwinDistance) })
  {
    if (part.any())
    {
      all = { std::min(all.from, part.from), std::max(all.to, part.to) };
    }
  }
  all = { std::max(all.from, 0.0), std::min(all.to, piece.length) };
  if (piece.line == other.line)
  {
    // Of its own line only what is a way apart: where a line bends, it is near itself.
    const double offset = piece.before - other.before - between.dot(other.along);
    all = narrowed(all, offset, 1.0 - piece.along.dot(other.along), kSharedLength,
      std::numeric_limits<double>::infinity());
  }
  return all.any() ? Interval{ piece.before + all.from, piece.before + all.to } : kNoInterval;
}

/// Where a piece crosses an earlier one of its line. The ends of the line are none: a ring closes.
std::optional<Point> crossing(const Piece& piece, const Piece& other)
{
  const Point between = other.start - piece.start;
  const auto cross = [](const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); };
  const double turn = cross(piece.along, other.along);
  const double own = cross(between, other.along) / turn,
               earlier = cross(between, piece.along) / turn;
  const bool meet = own >= 0.0 && own < piece.length && earlier >= 0.0 && earlier < other.length;
  const double way = other.before + earlier, loop = piece.before + own - way;
  return meet && way > 0.0 && loop >= kSharedLength ? std::optional(piece.at(piece.before + own))
                                                    : std::nullopt;
}

std::vector<Piece> piecesOf(const PlanLines& parts, int line)
{
  std::vector<Piece> pieces;
  double before = 0.0;
  for (const PlanLine& part : parts)
  {
    for (std::size_t k = 1; k < part.size(); ++k)
    {
      const Point way = part[k] - part[k - 1];
      const double length = way.norm();
      const bool there = part[k - 1].norm() < kFarthest && part[k].norm() < kFarthest;
      if (length > 0.0 && there)
      {
        pieces.push_back({ line, part[k - 1], way / length, before, length });
        before += length;
      }
    }
    before += 2.0 * kSharedLength; // parts are apart
  }
  return pieces;
}

/// Pieces by the squares that they pass.
class Squares
{
public:
  explicit Squares(double side)
    : side_(side)
  {
  }

  /// Calls `use(square)` for each that is within `kTwinDistance` of a piece, and for few others.
  template <class Use>
  void along(const Piece& piece, Use&& use)
  {
    const Point end = piece.start + piece.length * piece.along;
    const auto [south, north] = std::minmax({ piece.start.y(), end.y() });
    const double lastRow = std::floor((north + kTwinDistance) / side_);
    for (double row = std::floor((south - kTwinDistance) / side_); row <= lastRow; ++row)
    {
      const double low = row * side_ - kTwinDistance, high = low + side_ + 2.0 * kTwinDistance;
      const Interval ways =
        narrowed({ 0.0, piece.length }, piece.start.y(), piece.along.y(), low, high);
      const auto [west, east] = std::minmax({ piece.start.x() + ways.from * piece.along.x(),
        piece.start.x() + ways.to * piece.along.x() });
      const double lastColumn = std::floor((east + kTwinDistance) / side_);
      for (double c = std::floor((west - kTwinDistance) / side_); ways.any() && c <= lastColumn;
           ++c)
      {
        use(squares_[{ c, row }]);
      }
    }
  }

private:
  double side_; ///< m
  std::map<std::pair<double, double>, std::vector<std::int32_t>> squares_;
};

/// The union of intervals, m; sorts them.
double lengthOf(std::vector<Interval>& intervals)
{
  std::sort(intervals.begin(), intervals.end(),
    [](const Interval& a, const Interval& b) { return a.from < b.from; });
  double length = 0.0, reached = -std::numeric_limits<double>::infinity();
  for (const Interval& x : intervals)
  {
    length += std::max(0.0, x.to - std::max(x.from, reached));
    reached = std::max(reached, x.to);
  }
  return length;
}

Point placeAt(const std::vector<Piece>& pieces, double way)
{
  auto after = std::upper_bound(pieces.begin(), pieces.end(), way,
    [](double w, const Piece& piece) { return w < piece.before; });
  return (after == pieces.begin() ? *after : *--after).at(way);
}

} // namespace

std::vector<SharedStretch> sharedStretches(const std::vector<PlanLines>& lines, const Alike& alike)
{
  constexpr std::size_t mostOfSquare = 32;
  PlanLines whole;
  double length = 0.0;
  std::size_t count = 0;
  for (const PlanLines& parts : lines)
  {
    PlanLine& all = whole.emplace_back();
    for (const PlanLine& part : parts)
    {
      all.insert(all.end(), part.begin(), part.end());
    }
    for (const Piece& piece : piecesOf(parts, 0))
    {
      length += piece.length;
      ++count;
    }
  }
  const std::vector<int> twins = earlierLines(whole);
  Squares squares(std::max(1.0, length / double(std::max<std::size_t>(count, 1))));
  std::vector<Piece> all;
  std::vector<std::int32_t> seen; // by which piece
  std::vector<SharedStretch> stretches(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    if (twins[i] >= 0 && (!alike || alike(twins[i], int(i))))
    {
      continue;
    }
    stayWanted();
    const std::vector<Piece> pieces = piecesOf(lines[i], int(i));
    std::map<int, std::vector<Interval>> shared; // by line
    for (const Piece& piece : pieces)
    {
      const auto number = std::int32_t(all.size());
      squares.along(piece,
        [&](std::vector<std::int32_t>& square)
        {
          for (const std::int32_t other : square)
          {
            const int line = all[std::size_t(other)].line;
            if (std::exchange(seen[std::size_t(other)], number) == number ||
              (line != int(i) && alike && !alike(line, int(i))))
            {
              continue;
            }
            if (line == int(i) && !stretches[i].crossing)
            {
              stretches[i].crossing = crossing(piece, all[std::size_t(other)]);
            }
            const Interval part = sharedPart(piece, all[std::size_t(other)]);
            if (part.any())
            {
              shared[line].push_back(part);
            }
          }
          if (square.size() < mostOfSquare)
          {
            square.push_back(number);
          }
        });
      all.push_back(piece);
      seen.push_back(number);
    }
    SharedStretch& stretch = stretches[i];
    for (auto& [line, intervals] : shared)
    {
      const double of = lengthOf(intervals);
      if (of >= kSharedLength && of > stretch.length)
      {
        const auto last = std::max_element(intervals.begin(), intervals.end(),
          [](const Interval& a, const Interval& b) { return a.to < b.to; });
        stretch = { line, of, placeAt(pieces, intervals.front().from), placeAt(pieces, last->to),
          stretch.crossing };
      }
    }
  }
  return stretches;
}

} // namespace rockfall
