#include "statistics/dispersion.h"

#include "base/require.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

double meanAzimuth(std::span<const std::vector<Vec3>> paths)
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const std::vector<Vec3>& path : paths)
  {
    if (path.size() > 1)
    {
      sum += (path.back() - path.front()).head<2>();
    }
  }
  return sum.norm() > 0.0 ? std::atan2(sum.y(), sum.x()) : 0.0;
}

std::vector<std::vector<Vec3>> endsOfRocks(
  std::span<const std::vector<Vec3>> paths, std::span<const std::size_t> rockOf)
{
  std::vector<std::vector<Vec3>> ends;
  for (std::size_t k = 0; k < paths.size(); ++k)
  {
    if (paths[k].empty())
    {
      continue;
    }
    const bool begins = rockOf.empty() || rockOf[k] == k || ends.empty();
    const auto way = [&](const Vec3& end)
    { return Vec3(end - ends.back().front()).head<2>().norm(); };
    if (begins)
    {
      ends.push_back({ paths[k].front(), paths[k].back() });
    }
    else if (way(paths[k].back()) > way(ends.back().back()))
    {
      ends.back().back() = paths[k].back();
    }
  }
  return ends;
}

Dispersion measureDispersion(std::span<const std::vector<Vec3>> paths, double azimuth,
  double length, bool fromOwnStart, std::span<const std::size_t> rockOf)
{
  require(length >= 0.0 && std::isfinite(length), "Length", length, "",
    "a finite number of metres, not negative");
  require(std::isfinite(azimuth), "Direction", azimuth, "", "finite");
  Dispersion result;
  const Vec3 along(std::cos(azimuth), std::sin(azimuth), 0.0);
  const Vec3 across(-along.y(), along.x(), 0.0);
  const auto firstOf = [&](std::size_t k) { return rockOf.empty() ? k : rockOf[k]; };
  for (std::size_t k = 0; k < paths.size(); ++k)
  {
    if (!paths[k].empty() && firstOf(k) == k)
    {
      ++result.trajectories;
      result.apex += paths[k].front();
    }
  }
  if (result.trajectories == 0)
  {
    return result;
  }
  result.apex /= result.trajectories;

  const auto originOf = [&](std::size_t k)
  { return fromOwnStart ? paths[firstOf(k)].front() : result.apex; };
  double farthest = 0.0;
  for (std::size_t k = 0; k < paths.size(); ++k)
  {
    for (const Vec3& p : paths[k])
    {
      farthest = std::max(farthest, along.dot(p - originOf(k)));
    }
  }
  result.length = length > 0.0 ? length : farthest;

  result.lateralMin = std::numeric_limits<double>::infinity();
  result.lateralMax = -std::numeric_limits<double>::infinity();
  std::vector<double> ends; // lateral, of rocks that begin within L
  std::size_t rock = paths.size();
  double reached = 0.0; // along, by the rock at hand
  for (std::size_t k = 0; k < paths.size(); ++k)
  {
    const std::vector<Vec3>& path = paths[k];
    if (path.empty())
    {
      continue;
    }
    const Vec3 origin = originOf(k);
    if (along.dot(path.front() - origin) > result.length)
    {
      continue;
    }
    double last = 0.0, run = 0.0;
    for (std::size_t i = 0; i < path.size(); ++i)
    {
      run = along.dot(path[i] - origin);
      double side = across.dot(path[i] - origin);
      const bool beyond = run > result.length;
      if (beyond)
      {
        // Cut where the path crosses the end of the cross-section.
        const double run0 = along.dot(path[i - 1] - origin);
        const double side0 = across.dot(path[i - 1] - origin);
        side = side0 + (side - side0) * (result.length - run0) / (run - run0);
        run = result.length;
      }
      result.lateralMin = std::min(result.lateralMin, side);
      result.lateralMax = std::max(result.lateralMax, side);
      last = side;
      if (beyond)
      {
        break;
      }
    }
    if (firstOf(k) != rock)
    {
      rock = firstOf(k);
      ends.push_back(last);
      reached = run;
    }
    else if (run > reached)
    {
      ends.back() = last;
      reached = run;
    }
  }
  double sum = 0.0, squares = 0.0;
  for (const double end : ends)
  {
    sum += end;
    squares += end * end;
  }
  if (result.lateralMax < result.lateralMin)
  {
    result.lateralMin = result.lateralMax = 0.0; // all of them start beyond L
  }
  result.width = result.lateralMax - result.lateralMin;
  if (result.length > 0.0)
  {
    result.angle = std::atan(result.width / (2.0 * result.length));
  }
  const int n = int(ends.size());
  result.lateralDeviation =
    n > 1 ? std::sqrt(std::max(0.0, (squares - sum * sum / n) / (n - 1))) : 0.0;
  return result;
}

} // namespace rockfall
