#include "trackedGround.h"

#include "base/errors.h"

#include <algorithm>
#include <cmath>

namespace rockfall::calibration
{

namespace
{

/// Twice the signed area of a triangle, > 0 if it turns left, m².
double turn(const Place& a, const Place& b, const Place& c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Andrew's monotone chain: counter-clockwise, without places on its sides.
std::vector<Place> convexHull(std::vector<Place> places)
{
  std::ranges::sort(places);
  std::vector<Place> hull;
  for (int half = 0; half < 2; ++half)
  {
    const std::size_t begin = hull.size();
    for (const Place& p : places)
    {
      while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0.0)
      {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back(); // the first one of the other half
    std::ranges::reverse(places);
  }
  return hull;
}

} // namespace

TrackedGround::TrackedGround(std::span<const Place> places, double margin)
{
  const std::vector<Place> hull = convexHull({ places.begin(), places.end() });
  if (hull.size() < 3)
  {
    throw DataError("tracked ground: needs three places that are not on one line");
  }
  for (std::size_t k = 0; k < hull.size(); ++k)
  {
    const Place &a = hull[k], &b = hull[(k + 1) % hull.size()];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    const Place outward = { (b[1] - a[1]) / length, (a[0] - b[0]) / length };
    sides_.push_back({ outward, outward[0] * a[0] + outward[1] * a[1] + margin });
  }
}

bool TrackedGround::holds(const Place& place) const
{
  return std::ranges::all_of(sides_,
    [&](const Side& s) { return s.outward[0] * place[0] + s.outward[1] * place[1] <= s.offset; });
}

Place TrackedGround::cut(const Place& from, const Place& to) const
{
  const Place way = { to[0] - from[0], to[1] - from[1] };
  double inside = 1.0; // of the way
  for (const Side& s : sides_)
  {
    const double out = s.outward[0] * way[0] + s.outward[1] * way[1];
    const double room = s.offset - s.outward[0] * from[0] - s.outward[1] * from[1];
    if (out > 0.0 && room < inside * out)
    {
      inside = std::max(0.0, room / out);
    }
  }
  return { from[0] + inside * way[0], from[1] + inside * way[1] };
}

} // namespace rockfall::calibration
