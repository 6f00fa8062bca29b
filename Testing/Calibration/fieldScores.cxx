#include "fieldScores.h"

#include "statistics/sample.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rockfall::calibration
{

double crps(std::vector<double> sample, double observed)
{
  std::ranges::sort(sample);
  const double n = double(sample.size());
  double error = 0.0, pairs = 0.0; // pairs: Σ |x − x'| over unordered ones
  for (std::size_t k = 0; k < sample.size(); ++k)
  {
    error += std::abs(sample[k] - observed);
    pairs += sample[k] * (2.0 * double(k) - n + 1.0);
  }
  return error / n - pairs / (n * (n - 1.0));
}

double energyScore(
  std::span<const std::array<double, 2>> sample, const std::array<double, 2>& observed)
{
  const auto distance = [](const std::array<double, 2>& a, const std::array<double, 2>& b)
  { return std::hypot(a[0] - b[0], a[1] - b[1]); };
  const double n = double(sample.size());
  double error = 0.0, pairs = 0.0;
  for (std::size_t k = 0; k < sample.size(); ++k)
  {
    error += distance(sample[k], observed);
    for (std::size_t l = 0; l < k; ++l)
    {
      pairs += distance(sample[k], sample[l]);
    }
  }
  return error / n - pairs / (n * (n - 1.0));
}

double rankOf(std::span<const double> sample, double observed)
{
  double below = 0.0;
  for (const double x : sample)
  {
    below += x < observed ? 1.0 : x == observed ? 0.5 : 0.0;
  }
  return below / double(sample.size());
}

double mean(std::span<const double> sample)
{
  return std::accumulate(sample.begin(), sample.end(), 0.0) / double(sample.size());
}

double median(std::vector<double> sample)
{
  std::ranges::sort(sample);
  return quantile(sample, 0.5);
}

} // namespace rockfall::calibration
