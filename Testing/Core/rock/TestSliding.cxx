// METHOD 9.2 (paper fig. 14): a block slides down a 30° plane, d(t) = ½ (g sin α − g cos α tan φ)
// t².

#include "slopes.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kPlaneSize = 200.0; // m, of the plane

SimulationParameters paperParameters(double endTime)
{
  SimulationParameters p;
  p.timeStep = 0.01;
  p.normalPenalty = 1e9;
  p.endTime = endTime;
  p.outputInterval = 0.5;
  return p;
}

std::vector<Vec3> slide(int nodes, double frictionDegrees, double azimuth, double endTime = 4.0)
{
  const double angle = radians(30.0);
  const Terrain plane =
    makePlane(nodes, kPlaneSize, angle, azimuth, material(0.8, frictionDegrees));
  const Trajectory t =
    simulate(plane, cubeOnPlane(kPlaneSize, angle, azimuth, 20.0), paperParameters(endTime));
  EXPECT_EQ(t.summary.unsettledSteps, 0);
  EXPECT_EQ(t.summary.impacts, 0) << "sliding is no impact";
  std::vector<Vec3> path;
  for (const Sample& s : t.samples)
  {
    path.push_back(s.position);
  }
  return path;
}

double closedForm(double frictionDegrees, double time)
{
  const double a = radians(30.0);
  return 0.5 * kGravity * (std::sin(a) - std::cos(a) * std::tan(radians(frictionDegrees))) * time *
    time;
}

} // namespace

class SlidingTest : public ::testing::TestWithParam<double>
{
};

TEST_P(SlidingTest, FollowsTheClosedForm)
{
  const double friction = GetParam();
  for (int k = 0; k < 8; ++k)
  {
    const double azimuth = 2.0 * std::numbers::pi * k / 8.0;
    const std::vector<Vec3> path = slide(2, friction, azimuth);
    const double d = (path.back() - path.front()).norm();
    // The bar is 0.1 %. Second order in Δt gives 1e-5; the start-up from zero force costs one step.
    EXPECT_NEAR(d, closedForm(friction, 4.0), 5e-5 * d) << "azimuth " << degrees(azimuth);
    // The block stays in the fall line and on the plane: the settlement under its weight is 6e-6 m.
    const Vec3 downhill(std::cos(radians(30.0)) * std::cos(azimuth),
      std::cos(radians(30.0)) * std::sin(azimuth), -std::sin(radians(30.0)));
    const Vec3 travel = path.back() - path.front();
    EXPECT_LT((travel - travel.dot(downhill) * downhill).norm(), 2e-5);
  }
}

TEST_P(SlidingTest, OnePairAndTenThousandCellsAreTheSamePlane)
{
  const std::vector<Vec3> one = slide(2, GetParam(), 0.3);
  const std::vector<Vec3> many = slide(101, GetParam(), 0.3);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t k = 0; k < one.size(); ++k)
  {
    // Nodes rounded at 1e-14 of 100 m over cells of 2 m, times the 27 m slid: far below the bar.
    EXPECT_LT((one[k] - many[k]).norm(), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(FrictionAngles, SlidingTest, ::testing::Values(10.0, 20.0));

TEST(Sliding, BelowTheFrictionAngleItStays)
{
  const double angle = radians(30.0);
  const Terrain plane = makePlane(11, kPlaneSize, angle, 0.3, material(0.8, 31.0));
  const Trajectory t =
    simulate(plane, cubeOnPlane(kPlaneSize, angle, 0.3, 0.0), paperParameters(60.0));
  EXPECT_EQ(t.summary.fate, Fate::Rested);
  // The penalty springs take the weight: mg / 4p each way, 6e-6 m.
  EXPECT_LT((t.summary.stop - t.summary.start).norm(), 2e-5);
}

TEST(Sliding, EnergyIsAccountedFor)
{
  const double angle = radians(30.0);
  const Terrain plane = makePlane(2, kPlaneSize, angle, 0.0, material(0.8, 20.0));
  const Trajectory t =
    simulate(plane, cubeOnPlane(kPlaneSize, angle, 0.0, 20.0), paperParameters(4.0));
  const EnergyAudit& e = t.summary.energy;
  // Friction does μ N d; N is the weight's share but for the settling.
  const double d = (t.summary.stop - t.summary.start).norm();
  const double work = t.summary.mass * kGravity * std::cos(angle) * std::tan(radians(20.0)) * d;
  EXPECT_NEAR(e.friction, work, 1e-3 * work);
  EXPECT_LT(std::abs(e.numerical), 1e-6 * e.released);
  EXPECT_LT(std::abs(e.damping), 1e-4 * e.released);
}

/// Where friction is less than the slope nothing comes to rest at the slope's edge, whichever edge
/// it is and however slow it gets there; where friction is more, what stands half over it stays.
TEST(Sliding, GoesOnOverTheEdge)
{
  const double size = 20.0;
  SimulationParameters p = paperParameters(30.0);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (const double degrees : { 20.0, 25.0, 30.0, 35.0 })
  {
    const double angle = radians(degrees);
    for (int k = 0; k < 8; ++k)
    {
      const double azimuth = 2.0 * std::numbers::pi * k / 8.0;
      const double reach = 0.5 * size / std::cos(angle) *
        (k % 2 == 0 ? 1.0 : std::numbers::sqrt2); // down to the edge or corner
      const Terrain slippery = makePlane(11, size, angle, azimuth, material(0.3, 0.5 * degrees));
      const Terrain rough = makePlane(11, size, angle, azimuth, material(0.3, degrees + 10.0));
      Rock rock = cubeOnPlane(size, angle, azimuth, 0.5 - reach);
      EXPECT_EQ(simulate(rough, rock, p).summary.fate, Fate::Rested) << degrees << ", " << k;
      for (int repeat = 0; repeat < 6; ++repeat)
      {
        const double left = 0.8 + 4.0 * u(random);
        rock = cubeOnPlane(size, angle, azimuth, left - reach);
        const Vec3 normal = rock.orientation * Vec3::UnitZ();
        rock.orientation = Quat(Eigen::AngleAxisd(0.3 * u(random), normal)) * rock.orientation;
        rock.position += 0.01 * normal;
        EXPECT_EQ(simulate(slippery, rock, p).summary.fate, Fate::LeftDomain)
          << degrees << " degrees, towards " << k << ", from " << left << " m";
      }
    }
  }
}
