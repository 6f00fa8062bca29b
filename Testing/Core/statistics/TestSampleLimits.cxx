// What so few values can say: quantiles and shares.

#include "statistics/sample.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;

TEST(SampleLimits, RocksThatAQuantileTakes)
{
  // 0.95^59 = 0.0485, 0.95^58 = 0.0510 and so on.
  EXPECT_EQ(leastForQuantile(0.50), 5);
  EXPECT_EQ(leastForQuantile(0.90), 29);
  EXPECT_EQ(leastForQuantile(0.95), 59);
  EXPECT_EQ(leastForQuantile(0.99), 299);
  EXPECT_EQ(highestQuantile(4), 0);
  EXPECT_EQ(highestQuantile(5), 50);
  EXPECT_EQ(highestQuantile(28), 50);
  EXPECT_EQ(highestQuantile(29), 90);
  EXPECT_EQ(highestQuantile(298), 95);
  EXPECT_EQ(highestQuantile(299), 99);
}

TEST(SampleLimits, WhatIsInReachIsSaid)
{
  EXPECT_EQ(quantilesMissed(0), "any quantile: 50, 90, 95 and 99 % take 5, 29, 59 and 299 rocks");
  EXPECT_EQ(quantilesMissed(50),
    "the 90, 95 and 99 % quantiles, which take 29, 59 and 299 rocks; 50 % is in reach");
  EXPECT_EQ(
    quantilesMissed(95), "the 99 % quantile, which takes 299 rocks; 50, 90 and 95 % are in reach");
}

TEST(SampleLimits, SharesOfNoneAndAllAreNotCertain)
{
  EXPECT_NEAR(shareLimit(1), 0.95, 1e-12);
  EXPECT_NEAR(shareLimit(2), 1.0 - std::sqrt(0.05), 1e-12);
  EXPECT_NEAR(shareLimit(1000), 3.0 / 1000.0, 1e-5); // the rule of three
  EXPECT_EQ(binomialError(0.0, 20), shareLimit(20));
  EXPECT_EQ(binomialError(1.0, 20), shareLimit(20));
  EXPECT_NEAR(binomialError(0.5, 100), 0.05, 1e-12);
  EXPECT_TRUE(std::isnan(shareLimit(0)));
  EXPECT_TRUE(std::isnan(binomialError(0.0, 0)));
}
