#include "terrain/stand.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/hectare.h"
#include "base/random.h"
#include "base/text/numberText.h"
#include "geometry/planeSampling.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace rockfall
{

namespace
{

constexpr int kMostAttempts = 1000;
/// Streams of a source under a seed that no source has: stems and rocks are independent.
constexpr std::uint64_t kSeedOfStands = 0x7374656d00000000;

/// Events of a Poisson process in a time of `mean`: waiting times are exponential.
std::int64_t poisson(double mean, std::uint64_t seed, std::uint64_t first)
{
  double time = 0.0;
  for (std::int64_t events = 0;; ++events)
  {
    time -= std::log(uniformDeviate(seed, 0, Draw::SourceNumber, first + std::uint64_t(events)));
    if (time > mean)
    {
      return events;
    }
  }
}

/// A gamma deviate of shape k ≥ 1 and scale 1: Marsaglia & Tsang (2000), A simple method for
/// generating gamma variables, ACM Transactions on Mathematical Software 26(3), 363–372.
double gammaDeviate(double k, std::uint64_t seed, std::uint64_t index)
{
  const double d = k - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
  for (std::uint32_t attempt = 0;; ++attempt)
  {
    const double x = normalDeviate(seed, 2 * attempt, Draw::SourceVolume, index);
    const double v = std::pow(1.0 + c * x, 3);
    const double u = uniformDeviate(seed, 2 * attempt + 1, Draw::SourceVolume, index);
    if (v > 0.0 && std::log(u) < 0.5 * x * x + d - d * v + d * std::log(v))
    {
      return d * v;
    }
  }
}

/// Places that keep a distance, in squares of that size, of a metre at least.
class Spacing
{
public:
  explicit Spacing(double distance)
    : distance_(distance)
    , side_(std::max(distance, 1.0))
  {
  }

  bool isFree(const Eigen::Vector2d& place) const
  {
    const auto [column, row] = this->squareOf(place);
    for (std::int64_t y = row - 1; distance_ > 0.0 && y <= row + 1; ++y)
    {
      for (std::int64_t x = column - 1; x <= column + 1; ++x)
      {
        const auto found = squares_.find(keyOf(x, y));
        if (found != squares_.end() &&
          std::any_of(found->second.begin(), found->second.end(),
            [&](const Eigen::Vector2d& other)
            { return (other - place).squaredNorm() < distance_ * distance_; }))
        {
          return false;
        }
      }
    }
    return true;
  }

  void take(const Eigen::Vector2d& place)
  {
    if (distance_ > 0.0)
    {
      const auto [column, row] = this->squareOf(place);
      squares_[keyOf(column, row)].push_back(place);
    }
  }

private:
  std::pair<std::int64_t, std::int64_t> squareOf(const Eigen::Vector2d& place) const
  {
    return { std::int64_t(std::floor(place.x() / side_)),
      std::int64_t(std::floor(place.y() / side_)) };
  }
  static std::int64_t keyOf(std::int64_t column, std::int64_t row)
  {
    return (column << 32) ^ (row & 0xffffffff);
  }

  double distance_, side_; ///< m
  std::unordered_map<std::int64_t, std::vector<Eigen::Vector2d>> squares_;
};

} // namespace

std::vector<Tree> growStand(const Stand& stand, bool breaks, std::uint64_t seed)
{
  const PolygonSampler ground(stand.rings);
  const double mean = stand.stemsPerHectare * ground.area() / kHectare;
  if (!(mean > 0.0))
  {
    throw DataError("the polygon of the stand has no area");
  }
  if (mean > kMostStems)
  {
    throw DataError("the stand has some " + numberText(mean, 3) + " stems, more than " +
      numberText(kMostStems) + ": cut out what rocks can reach");
  }
  const std::uint64_t key = kSeedOfStands ^ seed;
  const std::uint64_t first = std::uint64_t(stand.feature) << 32;
  const std::int64_t count = poisson(mean, key, first);
  const double ratio =
    stand.diameterDeviation > 0.0 ? stand.diameterMean / stand.diameterDeviation : 0.0;
  const double shape = ratio * ratio; // mean = shape scale, deviation² = shape scale²
  std::vector<Tree> trees;
  Spacing spacing(stand.spacing);
  for (std::int64_t k = 0; k < count; ++k)
  {
    stayWanted();
    const std::uint64_t index = first + std::uint64_t(k);
    Tree tree;
    tree.feature = stand.feature;
    tree.height = stand.height;
    tree.material = stand.material;
    bool placed = false;
    for (std::uint32_t attempt = 0; !placed && attempt < kMostAttempts; ++attempt)
    {
      const auto [u, v] = uniformDeviates(key, 2 * attempt, Draw::SourcePlace, index);
      const double w = uniformDeviate(key, 2 * attempt + 1, Draw::SourcePlace, index);
      tree.position = ground.at(u, v, w);
      placed = spacing.isFree(tree.position);
    }
    if (!placed)
    {
      throw DataError("the stand has no room for " + std::to_string(count) + " stems with " +
        numberText(stand.spacing) + " m between any two: only " + std::to_string(k) + " stand");
    }
    spacing.take(tree.position);
    tree.diameter = shape > 0.0 ? stand.diameterMean / shape * gammaDeviate(shape, key, index)
                                : stand.diameterMean;
    if (breaks)
    {
      const bool conifer = uniformDeviate(key, 0, Draw::SourceShape, index) < stand.conifers;
      tree.capacity =
        stemCapacity(tree.diameter, conifer ? stand.coniferFactor : stand.broadleafFactor);
    }
    trees.push_back(tree);
  }
  return trees;
}

} // namespace rockfall
