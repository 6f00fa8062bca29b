// What cohesion holds does not hang on how many points two faces happen to have.

#include "piles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kAngle = 24.0, kFriction = 15.0; // degrees
constexpr double kCohesion = 300.0;               // N per contact point

/// Acceleration down a slope that friction and four points of cohesion leave a block, m/s².
double expected(double mass)
{
  const double angle = radians(kAngle);
  return kGravity * (std::sin(angle) - std::tan(radians(kFriction)) * std::cos(angle)) -
    4.0 * kCohesion / mass;
}

} // namespace

/// A cube on a cube has four points where their edges are parallel, and up to eight where the upper
/// one is turned a little, be it by rounding.
TEST(Cohesion, OfAJointIsThatOfFourPoints)
{
  const double angle = radians(kAngle);
  const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
  const Vec3 downhill(std::cos(angle), 0.0, -std::sin(angle));
  const Quat slope(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  for (const double turn : { 0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1 })
  {
    Pile pile;
    pile.ground = makePlane(2, 120.0, angle, 0.0, material(0.3, 45.0));
    pile.parameters.timeStep = 0.005;
    pile.parameters.rockFrictionAngle = radians(kFriction);
    pile.parameters.rockCohesion = kCohesion;
    for (int k = 0; k < 2; ++k)
    {
      Rock rock = brick(Vec3(1, 1, 1), Vec3::Zero(), k);
      rock.orientation = slope * Quat(Eigen::AngleAxisd(k == 0 ? 0.0 : turn, Vec3::UnitZ()));
      rock.position = Vec3(60.0, 60.0, 100.0) + (0.5 + k) * normal - 20.0 * downhill;
      pile.rocks.push_back(rock);
    }
    pile.start();
    pile.run(0.2);
    const double before = downhill.dot(pile.fall->state(1).velocity);
    pile.run(0.2);
    const double found = (downhill.dot(pile.fall->state(1).velocity) - before) / 0.2;
    // 0.1 % of gravity, as for other stacks of cubes (TestPiles).
    EXPECT_NEAR(found, expected(pile.blocks[1].mass()), 1e-3 * kGravity) << turn;
  }
}

/// Prisms of any number of corners slide down a plane alike.
TEST(Cohesion, OnTheGroundIsThatOfFourPoints)
{
  const double angle = radians(kAngle);
  SurfaceMaterial m = material(0.0, kFriction);
  m.cohesion = kCohesion;
  const Terrain slope = makePlane(2, 120.0, angle, 0.0, m);
  const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
  const Vec3 downhill(std::cos(angle), 0.0, -std::sin(angle));
  for (const int corners : { 4, 6, 12, 24 })
  {
    std::vector<Vec3> points;
    for (int k = 0; k < corners; ++k)
    {
      const double turn = 2.0 * std::numbers::pi * (k + 0.5) / corners;
      for (const double z : { -0.25, 0.25 })
      {
        points.emplace_back(0.7 * std::cos(turn), 0.7 * std::sin(turn), z);
      }
    }
    Rock rock;
    rock.shape = Polyhedron::convexHull(points).centred();
    rock.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
    rock.position = Vec3(60.0, 60.0, 100.0) + 0.25 * normal - 20.0 * downhill;
    SimulationParameters p;
    p.endTime = 2.0;
    const Trajectory t = simulate(slope, rock, p);
    const double way = (t.summary.stop - rock.position).norm();
    const double mass = t.summary.mass;
    // The block sinks by the compression of its springs first, of less than a millimetre.
    EXPECT_NEAR(way, 0.5 * expected(mass) * p.endTime * p.endTime, 0.01) << corners;
  }
}
