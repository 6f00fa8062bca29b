#include "statistics/dispersion.h"

#include "base/errors.h"
#include "base/text/numberText.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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

Dispersion measureDispersion(
  std::span<const std::vector<Vec3>> paths, double azimuth, double length, bool fromOwnStart)
{
  if (!(length >= 0.0) || !std::isfinite(length))
  {
    throw ParameterError(
      "Length is " + numberText(length) + ", it must be a finite number of metres, not negative");
  }
  if (!std::isfinite(azimuth))
  {
    throw ParameterError("Direction is " + numberText(azimuth) + ", it must be finite");
  }
  Dispersion result;
  const Vec3 along(std::cos(azimuth), std::sin(azimuth), 0.0);
  const Vec3 across(-along.y(), along.x(), 0.0);
  for (const std::vector<Vec3>& path : paths)
  {
    if (!path.empty())
    {
      ++result.trajectories;
      result.apex += path.front();
    }
  }
  if (result.trajectories == 0)
  {
    return result;
  }
  result.apex /= result.trajectories;

  double farthest = 0.0;
  for (const std::vector<Vec3>& path : paths)
  {
    for (const Vec3& p : path)
    {
      farthest = std::max(farthest, along.dot(p - (fromOwnStart ? path.front() : result.apex)));
    }
  }
  result.length = length > 0.0 ? length : farthest;

  result.lateralMin = std::numeric_limits<double>::infinity();
  result.lateralMax = -std::numeric_limits<double>::infinity();
  double sum = 0.0, squares = 0.0;
  int n = 0; // trajectories that begin within L
  for (const std::vector<Vec3>& path : paths)
  {
    if (path.empty())
    {
      continue;
    }
    const Vec3 origin = fromOwnStart ? path.front() : result.apex;
    if (along.dot(path.front() - origin) > result.length)
    {
      continue;
    }
    double last = 0.0;
    for (std::size_t i = 0; i < path.size(); ++i)
    {
      double run = along.dot(path[i] - origin);
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
    ++n;
    sum += last;
    squares += last * last;
  }
  if (result.lateralMax < result.lateralMin)
  {
    result.lateralMin = result.lateralMax = 0.0; // all of them start beyond L
  }
  result.width = result.lateralMax - result.lateralMin;
  result.angle = result.length > 0.0 ? std::atan(result.width / (2.0 * result.length)) : 0.0;
  result.lateralDeviation =
    n > 1 ? std::sqrt(std::max(0.0, (squares - sum * sum / n) / (n - 1))) : 0.0;
  return result;
}

} // namespace rockfall
