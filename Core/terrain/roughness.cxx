#include "terrain/roughness.h"

#include "base/require.h"
#include "law/settings.h"
#include "terrain/scatter.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rockfall
{

namespace
{

using Drawn = std::array<double, 3>;

/// Numbers drawn for a square of the map, remembered for its neighbours: a function all the same.
template <typename Draw>
const Drawn& remembered(std::uint64_t seed, std::uint32_t iteration, rockfall::Draw purpose,
  std::uint64_t index, Draw&& draw)
{
  struct Entry
  {
    std::uint64_t seed = 0, index = 0;
    std::uint32_t iteration = 0, purpose = 0; // 0: nothing is drawn for that
    Drawn drawn = {};
  };
  constexpr int bits = 11;
  thread_local std::vector<Entry> table(std::size_t(1) << bits);
  Entry& e = table[std::size_t((index * 0x9e3779b97f4a7c15ull) >> (64 - bits))];
  const std::uint32_t use = std::uint32_t(purpose);
  if (e.index != index || e.iteration != iteration || e.seed != seed || e.purpose != use)
  {
    e = { seed, index, iteration, use, draw() };
  }
  return e.drawn;
}

struct Knots
{
  std::int64_t first;            ///< Of four.
  std::array<double, 4> weights; ///< Of the cubic B-spline.
  double norm = 0.0;             ///< Sum of their squares.

  explicit Knots(double u)
  {
    const double floor = std::floor(u), t = u - floor, s = 1.0 - t;
    first = std::int64_t(floor) - 1;
    weights = { s * s * s / 6.0, (4.0 - 3.0 * t * t * (2.0 - t)) / 6.0,
      (4.0 - 3.0 * s * s * (2.0 - s)) / 6.0, t * t * t / 6.0 };
    for (const double w : weights)
    {
      norm += w * w;
    }
  }
};

/// Root mean square height of the field on facets between nodes so many ℓ apart, over σ. The mean
/// square over a triangle is ½ + Σ ρ/6, ρ the correlations along its three sides: h, h and √2 h.
double facetDeviation(double h)
{
  return std::sqrt(0.5 + (2.0 * std::exp(-h * h) + std::exp(-2.0 * h * h)) / 6.0);
}

} // namespace

double Roughness::highestObstacle() const
{
  return std::max({ obstacles[0], obstacles[1], obstacles[2] });
}

double Roughness::resolvedBy() const
{
  if (!this->isField())
  {
    return 0.0;
  }
  return this->hasObstacles() ? length / kNodesOfObstacles
    : deviation > 0.0         ? length / kNodesOfField
                              : 0.0;
}

Roughness Roughness::onNodes(double spacing) const
{
  Roughness nodes = *this;
  if (this->isField() && deviation > 0.0)
  {
    nodes.deviation = deviation / facetDeviation(spacing / length);
  }
  return nodes;
}

double Roughness::highest() const
{
  const double most =
    length > 0.0 ? kMostDeviates / facetDeviation(1.0 / kNodesOfField) : largestDeviate;
  return std::max(0.0, mean + most * deviation + this->highestObstacle());
}

double Roughness::deepest() const
{
  const double most = length > 0.0 ? kMostDeviates / facetDeviation(1.0 / kNodesOfField) : 9.0;
  return std::max(0.0, -(mean - most * deviation));
}

void Roughness::validate() const
{
  require(std::isfinite(mean), "RoughnessMean", mean, "", "finite");
  const auto notNegative = [](double value, const char* field)
  {
    require(value >= 0.0 && std::isfinite(value), field, value, "",
      "a finite number of metres, not negative");
  };
  notNegative(deviation, "RoughnessDeviation");
  notNegative(length, "RoughnessLength");
  notNegative(obstacles[0], "ObstacleHeight70");
  notNegative(obstacles[1], "ObstacleHeight20");
  notNegative(obstacles[2], "ObstacleHeight10");
  if (this->hasObstacles() && !(length > 0.0))
  {
    throw ParameterError("RoughnessLength is 0, but there are obstacles of up to " +
      numberText(this->highestObstacle()) +
      " m: it must be above 0, the distance from one to the next in metres");
  }
}

double RoughField::gaussian(double easting, double northing, double length, Draw purpose) const
{
  const double inverse = 1.0 / (kFieldKnots * length);
  const Knots x(easting * inverse), y(northing * inverse);
  double sum = 0.0;
  for (int j = 0; j < 4; ++j)
  {
    double row = 0.0;
    for (int i = 0; i < 4; ++i)
    {
      const std::uint64_t index = squareIndex(x.first + i, y.first + j);
      const auto draw = [&] { return Drawn{ normalDeviate(seed, iteration, purpose, index) }; };
      row += x.weights[i] * remembered(seed, iteration, purpose, index, draw)[0];
    }
    sum += y.weights[j] * row;
  }
  return std::clamp(sum / std::sqrt(x.norm * y.norm), -kMostDeviates, kMostDeviates);
}

double RoughField::obstacles(double easting, double northing, const Roughness& roughness) const
{
  const double u = easting / roughness.length, v = northing / roughness.length;
  const auto column = std::int64_t(std::floor(u)), row = std::int64_t(std::floor(v));
  double highest = 0.0;
  for (std::int64_t j = row - 1; j <= row + 1; ++j)
  {
    for (std::int64_t i = column - 1; i <= column + 1; ++i)
    {
      const std::uint64_t index = squareIndex(i, j);
      const auto draw = [&]
      {
        const auto [x, y] = uniformDeviates(seed, iteration, Draw::ObstaclePlace, index);
        return Drawn{ x, y, uniformDeviate(seed, iteration, Draw::ObstacleHeight, index) };
      };
      const Drawn& o = remembered(seed, iteration, Draw::ObstaclePlace, index, draw);
      const double dx = u - double(i) - o[0], dy = v - double(j) - o[1];
      const double in = 1.0 - 4.0 * (dx * dx + dy * dy); // (r/w)² with w = ℓ/2
      if (in > 0.0)
      {
        const double h = roughness.obstacles[o[2] < kMostObstacles ? 0
            : o[2] < kManyObstacles                                ? 1
                                                                   : 2];
        highest = std::max(highest, h * in * in);
      }
    }
  }
  return highest;
}

double RoughField::height(double easting, double northing, const Roughness& roughness) const
{
  double z = roughness.mean;
  if (roughness.deviation > 0.0)
  {
    z += roughness.deviation * this->gaussian(easting, northing, roughness.length);
  }
  if (roughness.hasObstacles())
  {
    z += this->obstacles(easting, northing, roughness);
  }
  return z;
}

} // namespace rockfall
