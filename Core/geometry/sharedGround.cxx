#include "base/abort.h"
#include "base/random.h"
#include "geometry/planeSampling.h"
#include "geometry/twins.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace rockfall
{

namespace
{

/// Whether an odd number of the rings encloses a place.
bool holds(const PlanRings& rings, const Eigen::Vector2d& place)
{
  bool inside = false;
  for (const std::vector<Vec3>& ring : rings)
  {
    for (std::size_t k = 0, last = ring.size() - 1; k < ring.size(); last = k++)
    {
      const Vec3 &a = ring[last], &b = ring[k];
      if ((a.y() > place.y()) != (b.y() > place.y()) &&
        place.x() < a.x() + (place.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      {
        inside = !inside;
      }
    }
  }
  return inside;
}

Eigen::AlignedBox2d boxOf(const PlanRings& rings)
{
  Eigen::AlignedBox2d box;
  for (const std::vector<Vec3>& ring : rings)
  {
    for (const Vec3& corner : ring)
    {
      box.extend(Eigen::Vector2d(corner.head<2>()));
    }
  }
  return box;
}

/// Places of a polygon that are looked for in another one. Of a tenth of it the first ones miss none
/// in a case of a thousand; all of them tell it to some per cent.
constexpr int kFirstPlaces = 64, kPlaces = 512;
constexpr std::uint64_t kSeed = 0x67726f756e640000;

/// Share of a polygon's ground that lies in another one.
double shareWithin(const PolygonSampler& ground, const PlanRings& other)
{
  int within = 0;
  for (int k = 0; k < kPlaces && (within > 0 || k < kFirstPlaces); ++k)
  {
    const auto [u, v] = uniformDeviates(kSeed, 0, Draw::SourcePlace, std::uint64_t(k));
    const double w = uniformDeviate(kSeed, 1, Draw::SourcePlace, std::uint64_t(k));
    within += holds(other, ground.at(u, v, w));
  }
  return double(within) / kPlaces;
}

/// As exact as it is known.
double twoDigits(double area)
{
  const double digit = std::pow(10.0, std::floor(std::log10(area)) - 1.0);
  return std::round(area / digit) * digit;
}

} // namespace

std::vector<SharedGround> sharedGround(const std::vector<PlanRings>& polygons, const Alike& alike)
{
  std::vector<Eigen::AlignedBox2d> boxes;
  std::vector<PolygonSampler> grounds;
  for (const PlanRings& rings : polygons)
  {
    boxes.push_back(boxOf(rings));
    grounds.emplace_back(rings);
  }
  // Along x: only those that begin before another one ends are compared.
  std::vector<int> order(polygons.size());
  std::iota(order.begin(), order.end(), 0);
  const auto west = [&](int k) { return boxes[std::size_t(k)].min().x(); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return west(a) < west(b); });
  std::vector<SharedGround> shared(polygons.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const double east = boxes[std::size_t(order[i])].max().x();
    for (std::size_t j = i + 1; j < order.size() && west(order[j]) < east; ++j)
    {
      stayWanted();
      const auto [first, second] = std::minmax(order[i], order[j]);
      SharedGround& found = shared[std::size_t(second)];
      if ((found.earlier >= 0 && found.earlier <= first) ||
        !boxes[std::size_t(first)].intersects(boxes[std::size_t(second)]) ||
        (alike && !alike(first, second)))
      {
        continue;
      }
      auto [small, large] = std::pair(second, first);
      if (grounds[std::size_t(small)].area() > grounds[std::size_t(large)].area())
      {
        std::swap(small, large);
      }
      const PolygonSampler& ground = grounds[std::size_t(small)];
      const double share =
        ground.area() > 0.0 ? shareWithin(ground, polygons[std::size_t(large)]) : 0.0;
      if (share >= kSharedGround)
      {
        found = { first, twoDigits(share * ground.area()) };
      }
    }
  }
  return shared;
}

} // namespace rockfall
