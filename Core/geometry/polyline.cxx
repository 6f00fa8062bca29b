#include "geometry/polyline.h"

#include <algorithm>
#include <limits>

namespace rockfall
{

double lengthOf(std::span<const Eigen::Vector2d> line)
{
  double length = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k)
  {
    length += (line[k] - line[k - 1]).norm();
  }
  return length;
}

double distanceTo(std::span<const Eigen::Vector2d> line, const Eigen::Vector2d& place)
{
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < line.size(); ++k)
  {
    const Eigen::Vector2d way = line[k] - line[k - 1], there = place - line[k - 1];
    const double square = way.squaredNorm();
    const double along = square > 0.0 ? std::clamp(way.dot(there) / square, 0.0, 1.0) : 0.0;
    least = std::min(least, (there - along * way).norm());
  }
  return least;
}

} // namespace rockfall
