#include "statistics/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

double quantile(std::span<const double> ascending, double q)
{
  if (ascending.empty())
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double place = q * double(ascending.size() - 1);
  const auto below = std::size_t(place);
  if (below + 1 >= ascending.size())
  {
    return ascending.back();
  }
  return std::lerp(ascending[below], ascending[below + 1], place - double(below));
}

SampleStatistics statisticsOf(std::vector<double>& values)
{
  SampleStatistics result;
  if (values.empty())
  {
    result.mean = result.deviation = result.maximum = std::numeric_limits<double>::quiet_NaN();
    result.quantiles.fill(result.mean);
    return result;
  }
  const double n = double(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : values)
  {
    sum += value;
  }
  result.mean = sum / n;
  for (const double value : values)
  {
    squares += (value - result.mean) * (value - result.mean);
  }
  result.deviation = values.size() > 1 ? std::sqrt(squares / (n - 1.0)) : 0.0;
  std::sort(values.begin(), values.end());
  result.maximum = values.back();
  for (std::size_t k = 0; k < hazardQuantiles.size(); ++k)
  {
    result.quantiles[k] = quantile(values, hazardQuantiles[k]);
  }
  return result;
}

double binomialError(double share, double trials)
{
  if (share <= 0.0 || share >= 1.0)
  {
    return shareLimit(trials);
  }
  return trials > 0.0 ? std::sqrt(share * (1.0 - share) / trials)
                      : std::numeric_limits<double>::quiet_NaN();
}

double shareLimit(double trials)
{
  return trials > 0.0 ? 1.0 - std::pow(kDoubt, 1.0 / trials)
                      : std::numeric_limits<double>::quiet_NaN();
}

int leastForQuantile(double q)
{
  return int(std::ceil(std::log(kDoubt) / std::log(q)));
}

int highestQuantile(std::size_t values)
{
  int highest = 0;
  for (const double q : hazardQuantiles)
  {
    highest = values >= std::size_t(leastForQuantile(q)) ? int(std::lround(100.0 * q)) : highest;
  }
  return highest;
}

namespace
{

/// "50, 90 and 95" of these quantiles, or what each needs.
struct Listed
{
  std::string percents, needs;

  explicit Listed(std::span<const double> quantiles)
  {
    for (std::size_t k = 0; k < quantiles.size(); ++k)
    {
      const char* link = k == 0 ? "" : k + 1 < quantiles.size() ? ", " : " and ";
      percents += link + std::to_string(std::lround(100.0 * quantiles[k]));
      needs += link + std::to_string(leastForQuantile(quantiles[k]));
    }
  }
};

} // namespace

std::string quantileNeeds()
{
  const Listed all(hazardQuantiles);
  return all.percents + " % take " + all.needs;
}

std::string quantilesMissed(int highest)
{
  const auto reached = std::size_t(std::count_if(hazardQuantiles.begin(), hazardQuantiles.end(),
    [highest](double q) { return std::lround(100.0 * q) <= highest; }));
  const std::span<const double> all(hazardQuantiles);
  const Listed has(all.first(reached)), lacks(all.subspan(reached));
  const bool one = reached + 1 == all.size();
  return (reached == 0 ? "any quantile: " + quantileNeeds()
                       : "the " + lacks.percents +
               (one ? " % quantile, which takes " : " % quantiles, which take ") + lacks.needs) +
    " rocks" +
    (reached == 0 ? "" : "; " + has.percents + " % " + (reached == 1 ? "is" : "are") + " in reach");
}

} // namespace rockfall
