// A design table by hand: ten rocks of two sources and three classes of volume past a line.

#include "base/errors.h"
#include "statistics/design.h"
#include "statistics/sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

using namespace rockfall;

namespace
{

/// Small, medium and large rocks: 1/4, 1/16 and 1/64 a year, so that sums are exact.
std::vector<DesignPassing> passings()
{
  constexpr double small = 0.25, medium = 0.0625, large = 0.015625;
  return { { 1, 20e3, 5, 1.0, small }, { 1, 40e3, 7, 1.5, small }, { 1, 90e3, 9, 2.0, medium },
    { 1, 200e3, 11, 2.5, medium }, { 1, 900e3, 15, 5.5, large }, { 2, 10e3, 4, 0.5, small },
    { 2, 30e3, 6, 3.5, small }, { 2, 60e3, 8, 4.5, medium }, { 2, 1500e3, 12, 3.0, large },
    { 2, 5000e3, 20, 4.0, large } };
}

} // namespace

TEST(Design, CharacteristicValuesOfTenRocks)
{
  const std::vector<DesignLevel> levels = designLevels(passings());
  ASSERT_EQ(levels.size(), 6u);
  // Ascending: 10 20 30 40 60 90 200 900 1500 5000 kJ; places 4.5, 8.1, 8.55, 8.82, 8.91 from 0.
  const double energies[] = { 75e3, 1850e3, 3425e3, 4370e3, 4685e3, 5000e3 };
  // 4 5 6 7 8 9 11 12 15 20 m/s
  const double speeds[] = { 8.5, 15.5, 17.75, 19.1, 19.55, 20.0 };
  // 0.5 1 1.5 2 2.5 3 3.5 4 4.5 5.5 m
  const double tops[] = { 2.75, 4.6, 5.05, 5.32, 5.41, 5.5 };
  for (std::size_t k = 0; k < levels.size(); ++k)
  {
    EXPECT_EQ(levels[k].quantile, k < 5 ? designQuantiles[k] : 1.0);
    EXPECT_NEAR(levels[k].energy.value, energies[k], 1e-6);
    EXPECT_NEAR(levels[k].speed.value, speeds[k], 1e-12);
    EXPECT_NEAR(levels[k].top.value, tops[k], 1e-12);
    EXPECT_EQ(std::isnan(levels[k].energy.limits.high), k > 0); // ten rocks give the median alone
  }
  // Of ten, at most 1 below the median: 11/1024, at most 2: 56/1024 = 5.5 %. So ranks 2 and 9.
  EXPECT_EQ(levels[0].energy.limits.low, 20e3);
  EXPECT_EQ(levels[0].energy.limits.high, 1500e3);
  EXPECT_EQ(levels[0].top.limits.low, 1.0);
  EXPECT_EQ(levels[0].top.limits.high, 4.5);
  // At most 7 below the 90 % quantile: 7.0 %, at most 6: 1.3 %. So rank 7, and none above.
  EXPECT_EQ(levels[1].energy.limits.low, 200e3);
  // 95 %: at most 7: 1.2 %, at most 8: 8.6 %.  99 %: at most 8: 0.4 %, at most 9: 9.6 %.
  EXPECT_EQ(levels[2].energy.limits.low, 900e3);
  EXPECT_EQ(levels[4].energy.limits.low, 1500e3);
  EXPECT_TRUE(std::isnan(levels[5].energy.limits.low));
}

TEST(Design, WhatABarrierDoesToTenRocks)
{
  // 4 m and 1000 kJ: 5.5 and 4.5 m are over it, 1500 and 5000 kJ too strong.
  const BarrierOutcome outcome = outcomeOf(passings(), 4.0, 1000e3);
  EXPECT_EQ(outcome.caught.rocks, 6);
  EXPECT_EQ(outcome.over.rocks, 2);
  EXPECT_EQ(outcome.tooStrong.rocks, 2);
  EXPECT_EQ(outcome.caught.frequency, 4 * 0.25 + 2 * 0.0625);
  EXPECT_EQ(outcome.over.frequency, 0.0625 + 0.015625);
  EXPECT_EQ(outcome.tooStrong.frequency, 2 * 0.015625);
  EXPECT_EQ(outcome.rocks(), 10);
  EXPECT_EQ(outcome.frequency(), 4 * 0.25 + 3 * 0.0625 + 3 * 0.015625);
  // A rock without a height is not caught.
  const DesignPassing unknown{ 1, 1e3, 1, std::numeric_limits<double>::quiet_NaN(), 1.0 };
  EXPECT_EQ(outcomeOf(std::span(&unknown, 1), 4.0, 1e6).over.rocks, 1);
}

/// What is not known of all is not known of none of them either: 0 would say that none ever comes.
TEST(Design, FrequenciesThatAreNotKnown)
{
  const std::vector<DesignPassing> rocks{ { 1, 20e3, 5, 1.0,
    std::numeric_limits<double>::quiet_NaN() } };
  const BarrierOutcome outcome = outcomeOf(rocks, 4.0, 1000e3, false);
  EXPECT_EQ(outcome.caught.rocks, 1);
  for (const BarrierOutcome::Count& count : { outcome.caught, outcome.over, outcome.tooStrong })
  {
    EXPECT_TRUE(std::isnan(count.frequency));
  }
  EXPECT_TRUE(std::isnan(outcomeOf({}, 4.0, 1000e3, false).frequency()));
  EXPECT_EQ(outcomeOf({}, 4.0, 1000e3).frequency(), 0.0);
  EXPECT_EQ(outcomeOf(rocks, 4.0, 1000e3).over.frequency, 0.0); // of no rock that is over it
}

TEST(Design, SmallestSufficientClass)
{
  EXPECT_EQ(sufficientClass(0.0), 0);
  EXPECT_EQ(sufficientClass(100e3), 0);
  EXPECT_EQ(sufficientClass(100.001e3), 1);
  EXPECT_EQ(sufficientClass(1850e3), 5);
  EXPECT_EQ(sufficientClass(4500e3), 7);
  EXPECT_EQ(sufficientClass(4501e3), 8);
  EXPECT_EQ(sufficientClass(std::numeric_limits<double>::quiet_NaN()), -1);
}

TEST(Design, PartialFactors)
{
  PartialFactors factors;
  EXPECT_EQ(factors.energy(1850e3, 15.5), 1850e3);
  factors = { 1.10, 1.02, 1.10, 1.0, 1.05, 1.2, 0.5, 0.0 };
  // γ_v = 1.122, γ_m = 1.10
  EXPECT_NEAR(factors.energy(1000.0, 7.0), 1000.0 * 1.05 * 1.10 * 1.122 * 1.122, 1e-9);
  EXPECT_NEAR(factors.height(4.0), 4.488, 1e-12);
  factors.designMass = 2000.0;
  EXPECT_NEAR(factors.energy(1000.0, 7.0), 0.5 * 2200.0 * 7.854 * 7.854 * 1.05, 1e-9);
  checkFactors(factors);
  factors.unitWeight = 0.9;
  EXPECT_THROW(checkFactors(factors), ParameterError);
  factors = {};
  factors.freeboard = -1.0;
  EXPECT_THROW(checkFactors(factors), ParameterError);
}

TEST(Design, BinomialAgainstItsSum)
{
  EXPECT_NEAR(binomialAtMost(2, 10, 0.5), 56.0 / 1024.0, 1e-15);
  EXPECT_NEAR(binomialAtMost(7, 10, 0.9), 0.0701908264, 1e-10); // 1 − Σ of 8 to 10
  EXPECT_NEAR(binomialAtMost(58, 59, 0.95), 1.0 - std::pow(0.95, 59), 1e-14);
  EXPECT_EQ(binomialAtMost(-1, 10, 0.5), 0.0);
  EXPECT_EQ(binomialAtMost(10, 10, 0.5), 1.0);
  EXPECT_EQ(binomialAtMost(0, 10, 0.0), 1.0);
  EXPECT_EQ(binomialAtMost(9, 10, 1.0), 0.0);
  EXPECT_NEAR(binomialAtMost(50000, 100000, 0.5), 0.5 + 0.5 * 0.002523126, 1e-8);
  // The limit of no success is the one of one-sided Clopper–Pearson in sample.h.
  EXPECT_NEAR(shareAtMost(0, 20), shareLimit(20), 1e-12);
  EXPECT_EQ(shareAtMost(20, 20), 1.0);
  EXPECT_NEAR(shareAtMost(1, 10), 0.394163, 1e-6); // Clopper & Pearson
}

TEST(Design, TheHighLimitIsThereAsSoonAsNGivesTheQuantile)
{
  for (const double q : designQuantiles)
  {
    const auto least = std::size_t(leastForQuantile(q));
    std::vector<double> values(least);
    std::iota(values.begin(), values.end(), 0.0);
    EXPECT_EQ(quantileLimits(values, q).high, double(least - 1)) << q;
    values.pop_back();
    EXPECT_TRUE(std::isnan(quantileLimits(values, q).high)) << q;
  }
}

/// 10⁴ samples of an exponential distribution: each limit is on its side as often as the binomial
/// distribution of its rank says, which is 95 % or more, within 4 standard errors.
TEST(Design, LimitsCoverAsTheySay)
{
  constexpr int draws = 10000, n = 120;
  std::mt19937 engine(7);
  const double quantiles[] = { 0.5, 0.9, 0.95 };
  int below[3] = {}, above[3] = {};
  std::vector<double> values(n);
  for (int draw = 0; draw < draws; ++draw)
  {
    for (double& value : values)
    {
      value = -std::log((double(engine()) + 0.5) / 4294967296.0);
    }
    std::sort(values.begin(), values.end());
    for (int k = 0; k < 3; ++k)
    {
      const QuantileLimits limits = quantileLimits(values, quantiles[k]);
      const double truth = -std::log1p(-quantiles[k]);
      below[k] += limits.low <= truth;
      above[k] += limits.high >= truth;
    }
  }
  std::iota(values.begin(), values.end(), 1.0); // values are their ranks
  for (int k = 0; k < 3; ++k)
  {
    const QuantileLimits ranks = quantileLimits(values, quantiles[k]);
    const double ofLow = 1.0 - binomialAtMost(std::int64_t(ranks.low) - 1, n, quantiles[k]);
    const double ofHigh = binomialAtMost(std::int64_t(ranks.high) - 1, n, quantiles[k]);
    EXPECT_GE(ofLow, 0.95);
    EXPECT_GE(ofHigh, 0.95);
    const auto error = [](double p) { return 4.0 * std::sqrt(p * (1.0 - p) / draws); };
    EXPECT_NEAR(double(below[k]) / draws, ofLow, error(ofLow)) << quantiles[k];
    EXPECT_NEAR(double(above[k]) / draws, ofHigh, error(ofHigh)) << quantiles[k];
  }
}
