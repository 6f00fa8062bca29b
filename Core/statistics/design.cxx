#include "statistics/design.h"

#include "base/require.h"
#include "statistics/sample.h"

#include <boost/math/special_functions/beta.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

namespace
{

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The smallest k of 0 to n with P(at most k) ≥ least.
std::int64_t leastSuccesses(std::int64_t n, double p, double least)
{
  std::int64_t low = -1, high = n; // P(at most n) is 1
  while (high - low > 1)
  {
    const std::int64_t middle = low + (high - low) / 2;
    (binomialAtMost(middle, n, p) >= least ? high : low) = middle;
  }
  return high;
}

DesignValue valueOf(std::span<const double> ascending, double q)
{
  if (q < 1.0)
  {
    return { quantile(ascending, q), quantileLimits(ascending, q) };
  }
  return { ascending.empty() ? kNan : ascending.back(), { kNan, kNan } };
}

} // namespace

double binomialAtMost(std::int64_t k, std::int64_t n, double p)
{
  if (k < 0)
  {
    return 0.0;
  }
  if (k >= n || p <= 0.0)
  {
    return 1.0;
  }
  if (p >= 1.0)
  {
    return 0.0;
  }
  return boost::math::ibetac(double(k + 1), double(n - k), p);
}

double shareAtMost(std::int64_t successes, std::int64_t trials)
{
  if (trials <= 0)
  {
    return kNan;
  }
  return successes < trials
    ? boost::math::ibetac_inv(double(successes + 1), double(trials - successes), kDoubt)
    : 1.0;
}

QuantileLimits quantileLimits(std::span<const double> ascending, double q)
{
  QuantileLimits limits{ kNan, kNan };
  const auto n = std::int64_t(ascending.size());
  if (n == 0)
  {
    return limits;
  }
  // The value of rank l, from 1, is above the quantile if at most l − 1 are below it.
  const std::int64_t low = leastSuccesses(n, q, std::nextafter(kDoubt, 1.0));
  if (low >= 1)
  {
    limits.low = ascending[std::size_t(low - 1)];
  }
  // The value of rank u is below the quantile if u or more are.
  const std::int64_t high = leastSuccesses(n, q, 1.0 - kDoubt) + 1;
  if (high <= n)
  {
    limits.high = ascending[std::size_t(high - 1)];
  }
  return limits;
}

double PartialFactors::energy(double characteristic, double speed) const
{
  const double simulated = designMass > 0.0 ? 0.5 * designMass * speed * speed : characteristic;
  return risk * ofMass() * ofSpeed() * ofSpeed() * simulated;
}

void checkFactors(const PartialFactors& factors)
{
  const std::pair<const char*, double> least[] = { { "SlopeSurveyFactor", factors.slopeSurvey },
    { "TrajectoryFactor", factors.trajectories }, { "BlockSurveyFactor", factors.blockSurvey },
    { "UnitWeightFactor", factors.unitWeight }, { "RiskFactor", factors.risk },
    { "BarrierFactor", factors.barrier } };
  for (const auto& [name, value] : least)
  {
    require(value >= 1.0 && std::isfinite(value), name, value, "", "finite and at least 1");
  }
  const std::pair<const char*, double> positive[] = { { "Freeboard", factors.freeboard },
    { "DesignMass", factors.designMass } };
  for (const auto& [name, value] : positive)
  {
    require(value >= 0.0 && std::isfinite(value), name, value, "", "finite and not negative");
  }
}

int sufficientClass(double energy)
{
  if (std::isnan(energy))
  {
    return -1;
  }
  const auto found = std::find_if(barrierClasses.begin(), barrierClasses.end(),
    [energy](const BarrierClass& of) { return of.maximum >= energy; });
  return int(found - barrierClasses.begin());
}

std::vector<DesignLevel> designLevels(std::span<const DesignPassing> passings)
{
  std::vector<double> energies, speeds, tops;
  for (const DesignPassing& passing : passings)
  {
    energies.push_back(passing.energy);
    speeds.push_back(passing.speed);
    if (!std::isnan(passing.top))
    {
      tops.push_back(passing.top);
    }
  }
  for (std::vector<double>* values : { &energies, &speeds, &tops })
  {
    std::sort(values->begin(), values->end());
  }
  std::vector<DesignLevel> levels;
  levels.reserve(std::size(designQuantiles) + 1);
  for (const double q : designQuantiles)
  {
    levels.push_back({ q, valueOf(energies, q), valueOf(speeds, q), valueOf(tops, q) });
  }
  levels.push_back({ 1.0, valueOf(energies, 1.0), valueOf(speeds, 1.0), valueOf(tops, 1.0) });
  return levels;
}

BarrierOutcome outcomeOf(
  std::span<const DesignPassing> passings, double height, double capacity, bool known)
{
  BarrierOutcome outcome;
  outcome.caught.frequency = outcome.over.frequency = outcome.tooStrong.frequency =
    known ? 0.0 : kNan;
  for (const DesignPassing& passing : passings)
  {
    BarrierOutcome::Count& count = !(passing.top <= height) ? outcome.over
      : !(passing.energy <= capacity)                       ? outcome.tooStrong
                                                            : outcome.caught;
    ++count.rocks;
    count.frequency += passing.frequency;
  }
  return outcome;
}

} // namespace rockfall
