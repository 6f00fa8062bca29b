// METHOD 9.2 (paper fig. 14): d(t) = ½ (g sin α − g cos α tan φ) t² on 30°.

#include "verification.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;
using namespace rockfall::testing;
using namespace rockfall::verification;

namespace
{

constexpr double kPlaneSize = 200.0;     // m, of the plane
constexpr double kAngle = radians(30.0); // α

SimulationParameters paperParameters(double endTime, double interval = 0.1)
{
  SimulationParameters p;
  p.timeStep = 0.01;
  p.normalPenalty = 1e9;
  p.endTime = endTime;
  p.outputInterval = interval;
  return p;
}

Trajectory slide(int nodes, double friction, double azimuth)
{
  const Terrain plane =
    makePlane(nodes, kPlaneSize, kAngle, azimuth, verification::surface(0.8, friction));
  return simulate(plane, cubeOnPlane(kPlaneSize, kAngle, azimuth, 20.0), paperParameters(4.0));
}

double acceleration(double friction)
{
  return kGravity * (std::sin(kAngle) - std::cos(kAngle) * std::tan(radians(friction)));
}

} // namespace

TEST(Sliding, FollowsTheClosedFormInEveryDirection)
{
  for (double friction : { 10.0, 20.0 })
  {
    double worst = 0.0, aside = 0.0;
    for (int k = 0; k < 16; ++k)
    {
      const double azimuth = 2.0 * std::numbers::pi * k / 16.0;
      const Trajectory t = slide(2, friction, azimuth);
      const Vec3 downhill(std::cos(kAngle) * std::cos(azimuth),
        std::cos(kAngle) * std::sin(azimuth), -std::sin(kAngle));
      const Vec3 way = t.samples.back().position - t.samples.front().position;
      const double expected = 0.5 * acceleration(friction) * 16.0;
      worst = std::max(worst, std::abs(way.norm() / expected - 1.0));
      aside = std::max(aside, (way - way.dot(downhill) * downhill).norm());
      if (k == 0)
      {
        std::vector<double> times, measured, exact;
        for (const Sample& s : t.samples)
        {
          times.push_back(s.time);
          measured.push_back((s.position - t.samples.front().position).norm());
          exact.push_back(0.5 * acceleration(friction) * s.time * s.time);
        }
        addCurve("sliding", "φ " + text(friction) + "°, this code", times, measured);
        addCurve("sliding", "φ " + text(friction) + "°, closed form", times, exact);
      }
    }
    const std::string head = "α 30°, φ " + text(friction) + "°, 16 azimuths, 4 s: ";
    recordAtMost({ "Sliding", head + "largest relative error of the way", "",
                   "METHOD 9.2, Δt 0.01 s; the start from zero contact force costs one step" },
      worst, 5e-4);
    recordAtMost({ "Sliding", head + "largest way off the fall line", "m",
                   "settlement under the weight is 6e-6 m" },
      aside, 2e-5);
  }
}

TEST(Sliding, OnePairAndTenThousandCfesAreOnePlane)
{
  for (double friction : { 10.0, 20.0 })
  {
    const Trajectory one = slide(2, friction, 0.3), many = slide(72, friction, 0.3);
    ASSERT_EQ(one.samples.size(), many.samples.size());
    double worst = 0.0;
    for (std::size_t k = 0; k < one.samples.size(); ++k)
    {
      worst = std::max(worst, (one.samples[k].position - many.samples[k].position).norm());
    }
    recordAtMost({ "Sliding", "φ " + text(friction) + "°: 2 CFEs against 10,082 CFEs, any time",
                   "m", "METHOD 10.5; the nodes differ by rounding only" },
      worst, 1e-6);
  }
}

TEST(Sliding, BelowTheFrictionAngleNothingCreeps)
{
  for (double friction : { 30.5, 35.0, 45.0 })
  {
    const Terrain plane =
      makePlane(11, kPlaneSize, kAngle, 0.3, verification::surface(0.8, friction));
    const Trajectory t =
      simulate(plane, cubeOnPlane(kPlaneSize, kAngle, 0.3, 0.0), paperParameters(60.0, 0.01));
    EXPECT_EQ(t.summary.fate, Fate::Rested);
    // The springs take up the weight at the start; what comes after 0.25 s is drift. A rock that is
    // found to be at rest is not followed up to 60 s: its last speed is taken to go on.
    const Sample& last = t.samples.back();
    const Sample* settled = &t.samples.front();
    for (const Sample& s : t.samples)
    {
      settled = s.time <= 0.25 + 1e-9 ? &s : settled;
    }
    const double drift =
      (last.position - settled->position).norm() + last.velocity.norm() * (60.0 - last.time);
    recordAtMost({ "Sliding",
                   "α 30°, φ " + text(friction) +
                     "°: drift in 60 s after the springs took the weight (0.25 s)",
                   "m", "no creep; the springs themselves give 6e-6 m, once" },
      drift, 1e-6);
    recordAtMost(
      { "Sliding", "α 30°, φ " + text(friction) + "°: settlement when the springs take the weight",
        "m", "mg/4p each way is 6e-6 m; twice that for the swing" },
      (settled->position - t.samples.front().position).norm(), 2e-5);
  }
}
