#include "gis/raster/contourCrossings.h"

#include "base/abort.h"

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace rockfall::gis
{

namespace
{

namespace bg = boost::geometry;
using Place = bg::model::d2::point_xy<double>;
using PlanBox = bg::model::box<Place>;

/// Segments of one line that are looked for together.
constexpr std::size_t kOfRun = 8;

/// Segments from each vertex to the next one, from `first` to `last`.
struct Run
{
  std::size_t first, last;
  double low = 0.0, high = 0.0; ///< Heights, m.
};

struct Crossing
{
  double x, y, low, high;
};

class Crossings
{
public:
  explicit Crossings(const Contours& contours)
    : x_(contours.x)
    , y_(contours.y)
    , z_(contours.z)
  {
    for (const Line& line : contours.lines)
    {
      const std::size_t end = line.first + line.count; // after the last vertex
      for (std::size_t k = line.first; k + 1 < end; k += kOfRun)
      {
        Run run{ k, std::min(k + kOfRun, end - 1) };
        const auto [low, high] = std::minmax_element(
          z_.begin() + std::ptrdiff_t(run.first), z_.begin() + std::ptrdiff_t(run.last) + 1);
        run.low = *low;
        run.high = *high;
        runs_.push_back(run);
      }
    }
  }

  std::string note()
  {
    std::vector<std::pair<PlanBox, std::uint32_t>> boxes;
    for (std::size_t r = 0; r < runs_.size(); ++r)
    {
      boxes.emplace_back(this->boxOf(runs_[r].first, runs_[r].last), std::uint32_t(r));
    }
    const bg::index::rtree<std::pair<PlanBox, std::uint32_t>, bg::index::linear<16>> tree(boxes);
    std::vector<std::pair<PlanBox, std::uint32_t>> near;
    for (const auto& [box, number] : boxes)
    {
      stayWanted();
      near.clear();
      tree.query(bg::index::intersects(box), std::back_inserter(near));
      std::sort(
        near.begin(), near.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
      const Run& run = runs_[number];
      for (const auto& [otherBox, other] : near)
      {
        const Run& of = runs_[other];
        if (other > number && (run.low != of.high || run.high != of.low))
        {
          this->compare(run, of, otherBox);
        }
      }
    }
    if (count_ == 0)
    {
      return {};
    }
    return "Contours of different heights cross at " + std::to_string(count_) +
      " places, the first of " + number(first_->low) + " m and " + number(first_->high) + " m at " +
      number(first_->x) + ", " + number(first_->y) +
      "; the slope has steps there that no ground has. Correct the lines.";
  }

private:
  PlanBox boxOf(std::size_t first, std::size_t last) const
  {
    const auto range = [&](const std::vector<double>& of)
    {
      return std::minmax_element(
        of.begin() + std::ptrdiff_t(first), of.begin() + std::ptrdiff_t(last) + 1);
    };
    const auto [x0, x1] = range(x_);
    const auto [y0, y1] = range(y_);
    return { { *x0, *y0 }, { *x1, *y1 } };
  }

  void compare(const Run& run, const Run& other, const PlanBox& otherBox)
  {
    for (std::size_t i = run.first; i < run.last; ++i)
    {
      if (!bg::intersects(this->boxOf(i, i + 1), otherBox))
      {
        continue;
      }
      for (std::size_t k = other.first; k < other.last; ++k)
      {
        const std::optional<Crossing> found = this->crossing(i, k);
        count_ += found ? 1 : 0;
        if (found && (!first_ || i < firstSegment_))
        {
          first_ = found;
          firstSegment_ = i;
        }
      }
    }
  }

  /// The crossing of two segments. A vertex on the other line counts to its left, so that a line which crosses
  /// there does so once.
  std::optional<Crossing> crossing(std::size_t i, std::size_t k) const
  {
    const auto left = [&](std::size_t a, std::size_t b, std::size_t c)
    { return (x_[b] - x_[a]) * (y_[c] - y_[a]) - (y_[b] - y_[a]) * (x_[c] - x_[a]); };
    const double from = left(k, k + 1, i), to = left(k, k + 1, i + 1);
    if ((from >= 0.0) == (to >= 0.0) ||
      (left(i, i + 1, k) >= 0.0) == (left(i, i + 1, k + 1) >= 0.0))
    {
      return std::nullopt;
    }
    for (const std::size_t own : { i, i + 1 })
    {
      for (const std::size_t other : { k, k + 1 })
      {
        if (x_[own] == x_[other] && y_[own] == y_[other])
        {
          return std::nullopt;
        }
      }
    }
    const double s = from / (from - to);
    const double x = x_[i] + s * (x_[i + 1] - x_[i]), y = y_[i] + s * (y_[i + 1] - y_[i]);
    const double length = std::hypot(x_[k + 1] - x_[k], y_[k + 1] - y_[k]);
    const double t = std::hypot(x - x_[k], y - y_[k]) / length;
    const double own = z_[i] + s * (z_[i + 1] - z_[i]);
    const double other = z_[k] + t * (z_[k + 1] - z_[k]);
    const double fall = std::abs(z_[i + 1] - z_[i]) + std::abs(z_[k + 1] - z_[k]);
    if (!(std::abs(own - other) > fall))
    {
      return std::nullopt;
    }
    return Crossing{ x, y, std::min(own, other), std::max(own, other) };
  }

  const std::vector<double>&x_, &y_, &z_;
  std::vector<Run> runs_;
  std::int64_t count_ = 0;
  std::optional<Crossing> first_;
  std::size_t firstSegment_ = 0; ///< Segment of the earlier line at the first.
};

} // namespace

std::string crossingsNote(const Contours& contours)
{
  return Crossings(contours).note();
}

} // namespace rockfall::gis
