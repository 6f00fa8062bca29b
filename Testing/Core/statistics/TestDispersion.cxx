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

TEST(Dispersion, RefusesAndStaysFinite)
{
  EXPECT_THROW(measureDispersion({}, 0.0, -1.0), ParameterError);
  EXPECT_THROW(measureDispersion({}, NAN), ParameterError);
  EXPECT_EQ(measureDispersion({}, 0.0).trajectories, 0);
  const std::vector<std::vector<Vec3>> still = { { Vec3(1, 2, 3) } };
  EXPECT_EQ(measureDispersion(still, 0.0).angle, 0.0);
}
