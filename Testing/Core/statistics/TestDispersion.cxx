// θ = arctan(W / 2L) on paths with a known spread (METHOD 9.3).

#include "base/errors.h"
#include "statistics/dispersion.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;

namespace
{

/// A fan of straight paths of 100 m run from one point, the outer ones `half` m to each side.
std::vector<std::vector<Vec3>> fan(double azimuth, double half, const Vec3& apex)
{
  std::vector<std::vector<Vec3>> paths;
  for (int k = -2; k <= 2; ++k)
  {
    std::vector<Vec3> path;
    for (int s = 0; s <= 10; ++s)
    {
      const double run = 10.0 * s, side = half * k / 2.0 * s / 10.0;
      path.push_back(apex +
        Vec3(run * std::cos(azimuth) - side * std::sin(azimuth),
          run * std::sin(azimuth) + side * std::cos(azimuth), -0.5 * run));
    }
    paths.push_back(path);
  }
  return paths;
}

} // namespace

TEST(Dispersion, MeasuresAFan)
{
  const Vec3 apex(500000.0, 4000000.0, 900.0);
  for (double azimuth : { 0.0, 1.1, -2.5 })
  {
    const auto paths = fan(azimuth, 20.0, apex);
    EXPECT_NEAR(meanAzimuth(paths), azimuth, 1e-9);
    const Dispersion d = measureDispersion(paths, azimuth);
    EXPECT_EQ(d.trajectories, 5);
    EXPECT_NEAR(d.length, 100.0, 1e-6);
    EXPECT_NEAR(d.width, 40.0, 1e-6);
    EXPECT_NEAR(d.angle, std::atan(40.0 / 200.0), 1e-9);
    // Cut between two samples, the angle of a straight fan is the same.
    const Dispersion cut = measureDispersion(paths, azimuth, 55.0);
    EXPECT_NEAR(cut.length, 55.0, 1e-12);
    EXPECT_NEAR(cut.width, 22.0, 1e-6);
    EXPECT_NEAR(cut.angle, d.angle, 1e-9);
    EXPECT_LT((cut.apex - apex).norm(), 1e-6);
  }
}

TEST(Dispersion, OwnStartsTakeTheSourceWidthOut)
{
  auto paths = fan(0.0, 0.0, Vec3::Zero());
  for (std::size_t k = 0; k < paths.size(); ++k)
  {
    for (Vec3& p : paths[k])
    {
      p.y() += 10.0 * double(k);
    }
  }
  EXPECT_NEAR(measureDispersion(paths, 0.0, 0.0, true).width, 0.0, 1e-12);
  EXPECT_NEAR(measureDispersion(paths, 0.0, 0.0, false).width, 40.0, 1e-12);
}

TEST(Dispersion, WhatStartsBeyondLIsLeftOut)
{
  // Mean start at x = 10: of L = 5 the third starts beyond it.
  const std::vector<std::vector<Vec3>> paths = { { { 0, 0, 0 }, { 30, 3, 0 } },
    { { 0, 6, 0 }, { 30, 9, 0 } }, { { 30, 0, 0 }, { 60, 0, 0 } } };
  const Dispersion d = measureDispersion(paths, 0.0, 5.0, false);
  EXPECT_EQ(d.trajectories, 3);
  EXPECT_NEAR(d.width, 7.5, 1e-12);
  EXPECT_NEAR(d.lateralDeviation, std::sqrt(18.0), 1e-12); // of two that are 6 m apart
}

TEST(Dispersion, RefusesAndHasNoAngleWithoutALength)
{
  EXPECT_THROW(measureDispersion({}, 0.0, -1.0), ParameterError);
  EXPECT_THROW(measureDispersion({}, NAN), ParameterError);
  EXPECT_EQ(measureDispersion({}, 0.0).trajectories, 0);
  const std::vector<std::vector<Vec3>> still = { { Vec3(1, 2, 3) } };
  EXPECT_TRUE(std::isnan(measureDispersion(still, 0.0).angle));
  // Against the direction: 10 m wide, and no way along it.
  const std::vector<std::vector<Vec3>> back = { { Vec3(0, 0, 9), Vec3(-20, 5, 0) },
    { Vec3(0, 0, 9), Vec3(-20, -5, 0) } };
  const Dispersion reversed = measureDispersion(back, 0.0);
  EXPECT_EQ(reversed.length, 0.0);
  EXPECT_EQ(reversed.width, 10.0);
  EXPECT_TRUE(std::isnan(reversed.angle));
}

TEST(Dispersion, ARockThatBrokeCountsOnce)
{
  // Both rocks begin at x = 0; the first breaks at (10, 1) into three, the second at (8, 50) into one.
  const std::vector<std::vector<Vec3>> paths = { { { 0, 0, 9 }, { 10, 1, 5 } },
    { { 10, 1, 5 }, { 20, 7, 1 } }, { { 10, 1, 5 }, { 40, -3, 0 } }, { { 10, 1, 5 }, { 30, 2, 2 } },
    { { 0, 50, 9 }, { 8, 50, 5 } }, { { 8, 50, 5 }, { 30, 54, 1 } } };
  const std::vector<std::size_t> rockOf = { 0, 0, 0, 0, 4, 4 };
  const Dispersion d = measureDispersion(paths, 0.0, 0.0, true, rockOf);
  EXPECT_EQ(d.trajectories, 2);
  EXPECT_EQ(d.length, 40.0);
  EXPECT_EQ(d.lateralMin, -3.0);
  EXPECT_EQ(d.lateralMax, 7.0);
  EXPECT_NEAR(d.lateralDeviation, 7.0 / std::sqrt(2.0), 1e-12); // ends at −3 and 4
  EXPECT_EQ(d.apex, Vec3(0, 25, 9));
  // Cut at 25 m: the first rock's second piece passes there first among those that get so far.
  const Dispersion cut = measureDispersion(paths, 0.0, 25.0, true, rockOf);
  EXPECT_NEAR(cut.lateralMin, -1.0, 1e-12);
  EXPECT_EQ(cut.lateralMax, 7.0);
  EXPECT_NEAR(
    cut.lateralDeviation, (4.0 * 17.0 / 22.0 + 1.0) / std::sqrt(2.0), 1e-12); // ends at −1 and 3.1
  const std::vector<std::vector<Vec3>> ends = endsOfRocks(paths, rockOf);
  ASSERT_EQ(ends.size(), 2u);
  EXPECT_EQ(ends[0][1], Vec3(40, -3, 0));
  EXPECT_EQ(ends[1][1], Vec3(30, 54, 1));
}
