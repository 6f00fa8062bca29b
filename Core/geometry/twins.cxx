#include "geometry/twins.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace rockfall
{

namespace
{

using Point = Eigen::Vector2d;

double distance(const Point& p, const PlanLine& line)
{
  double least = (p - line.front()).norm();
  for (std::size_t i = 1; i < line.size(); ++i)
  {
    const Point along = line[i] - line[i - 1];
    const double s = std::clamp((p - line[i - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (line[i - 1] + (std::isnan(s) ? 0.0 : s) * along - p).norm());
  }
  return least;
}

bool liesOn(const PlanLine& one, const PlanLine& other)
{
  return std::all_of(
    one.begin(), one.end(), [&](const Point& p) { return distance(p, other) <= kTwinDistance; });
}

} // namespace

std::vector<int> earlierPoints(const std::vector<Point>& points)
{
  // Sorted by cells as wide as the distance: what is near is in the cell or in one beside it.
  using Cell = std::tuple<double, double, int>;
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const Point at = points[i] / kTwinDistance;
    cells.emplace_back(std::floor(at.x()), std::floor(at.y()), int(i));
  }
  std::sort(cells.begin(), cells.end());
  std::vector<int> earlier(points.size(), -1);
  for (const auto& [x, y, i] : cells)
  {
    int& first = earlier[std::size_t(i)];
    for (int beside = 0; beside < 9; ++beside)
    {
      const double column = x + beside % 3 - 1, row = y + beside / 3 - 1;
      // Within a cell in their order: the first that is near is the one.
      for (auto near = std::lower_bound(cells.begin(), cells.end(), Cell(column, row, -1));
           near != cells.end() && std::get<0>(*near) == column && std::get<1>(*near) == row; ++near)
      {
        const int k = std::get<2>(*near);
        const bool before = k < i && (first < 0 || k < first);
        if (!before)
        {
          break;
        }
        if ((points[std::size_t(k)] - points[std::size_t(i)]).norm() <= kTwinDistance)
        {
          first = k;
          break;
        }
      }
    }
  }
  return earlier;
}

std::vector<int> earlierLines(const PlanLines& lines)
{
  // Along x by their westernmost points, so that only those that begin together are compared.
  std::vector<Eigen::AlignedBox2d> boxes(lines.size());
  std::vector<std::pair<double, int>> west;
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    for (const Point& p : lines[i])
    {
      boxes[i].extend(p);
    }
    if (!lines[i].empty())
    {
      west.emplace_back(boxes[i].min().x(), int(i));
    }
  }
  std::sort(west.begin(), west.end());
  const auto alike = [&](int a, int b)
  {
    const Eigen::AlignedBox2d &one = boxes[std::size_t(a)], &other = boxes[std::size_t(b)];
    return (one.min() - other.min()).cwiseAbs().maxCoeff() <= kTwinDistance &&
      (one.max() - other.max()).cwiseAbs().maxCoeff() <= kTwinDistance;
  };
  std::vector<int> earlier(lines.size(), -1);
  std::vector<std::pair<double, int>> firsts; // one of each place
  for (const auto& [x, i] : west)
  {
    bool found = false;
    for (auto near = firsts.rbegin();
         !found && near != firsts.rend() && near->first >= x - kTwinDistance; ++near)
    {
      const PlanLine &one = lines[std::size_t(near->second)], &other = lines[std::size_t(i)];
      found = alike(near->second, i) && liesOn(one, other) && liesOn(other, one);
      if (found)
      {
        const auto [first, second] = std::minmax({ near->second, i });
        earlier[std::size_t(second)] = first;
        near->second = first;
      }
    }
    if (!found)
    {
      firsts.emplace_back(x, i);
    }
  }
  return earlier;
}

} // namespace rockfall
