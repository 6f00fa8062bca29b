#include "statistics/DiscSwath.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rockfall
{

void DiscSwath::add(
  const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Maxima& maxima, std::uint32_t angle)
{
  ++step_;
  const auto range = [&](int axis, double start, int count)
  {
    const double low = std::min(a[axis], b[axis]) - radius_ - start;
    const double high = std::max(a[axis], b[axis]) + radius_ - start;
    return std::pair(std::max(0.0, std::floor(low / grid_.cellSize)),
      std::min(count - 1.0, std::floor(high / grid_.cellSize)));
  };
  const auto [left, right] = range(0, grid_.west, grid_.columns);
  const auto [bottom, top] = range(1, grid_.south, grid_.rows);
  for (double row = bottom; row <= top; ++row)
  {
    for (double column = left; column <= right; ++column)
    {
      const Eigen::Vector2d low(
        grid_.west + column * grid_.cellSize, grid_.south + row * grid_.cellSize);
      if (this->touches(low, a, b))
      {
        this->visit(std::int64_t(row) * grid_.columns + std::int64_t(column), maxima, angle);
      }
    }
  }
}

void DiscSwath::stop(std::int64_t cell)
{
  const auto found = cells_.find(cell);
  if (found != cells_.end())
  {
    found->second.passage.stopped = 1;
  }
}

/// Whether the cell with this corner comes as near as the radius to the way. As the radius is more
/// than half a cell, a way across the cell comes as near to a corner of it.
bool DiscSwath::touches(
  const Eigen::Vector2d& low, const Eigen::Vector2d& a, const Eigen::Vector2d& b) const
{
  const double most = radius_ * radius_;
  const Eigen::Vector2d high = low + Eigen::Vector2d::Constant(grid_.cellSize);
  for (const Eigen::Vector2d& end : { a, b })
  {
    const Eigen::Vector2d inside = end.cwiseMax(low).cwiseMin(high);
    if ((end - inside).squaredNorm() <= most)
    {
      return true;
    }
  }
  const Eigen::Vector2d way = b - a;
  const double length2 = way.squaredNorm();
  for (const double x : { low.x(), high.x() })
  {
    for (const double y : { low.y(), high.y() })
    {
      const Eigen::Vector2d corner(x, y);
      const double along =
        length2 > 0.0 ? std::clamp((corner - a).dot(way) / length2, 0.0, 1.0) : 0.0;
      if ((corner - a - along * way).squaredNorm() <= most)
      {
        return true;
      }
    }
  }
  return false;
}

void DiscSwath::visit(std::int64_t cell, const Maxima& maxima, std::uint32_t angle)
{
  const auto [at, isNew] = cells_.try_emplace(cell);
  Visited& visited = at->second;
  if (isNew)
  {
    visited.passage.cell = std::uint32_t(cell);
    visited.passage.maxima = maxima;
  }
  else
  {
    if (visited.step + 1 < step_)
    {
      visited.passage.enter(1);
      visited.before = visited.passage.angle;
    }
    raise(visited.passage.maxima, maxima);
  }
  visited.passage.angle = std::min(visited.before, angle);
  visited.step = step_;
}

} // namespace rockfall
