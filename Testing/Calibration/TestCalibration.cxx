// What the calibration programs compute: scores, rocks, single impacts, names.

#include "GroundSettings.h"
#include "SingleImpact.h"
#include "SlopeFigures.h"
#include "fieldScores.h"
#include "fieldTables.h"
#include "trackedGround.h"

#include "Core/slopes.h"
#include "base/errors.h"
#include "terrain/presets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace rockfall;
using namespace rockfall::calibration;

TEST(FieldScores, CrpsOfAUniformForecast)
{
  // Of a uniform distribution over 0 … 1 at its middle: mean |x − ½| − ½ mean |x − x'| = ¼ − ⅙.
  std::vector<double> sample;
  for (int k = 0; k < 1000; ++k)
  {
    sample.push_back((k + 0.5) / 1000.0);
  }
  EXPECT_NEAR(crps(sample, 0.5), 1.0 / 12.0, 2e-4); // 1/n: pairs of different x only
  EXPECT_DOUBLE_EQ(rankOf(sample, 0.25), 0.25);
}

TEST(FieldScores, EnergyScoreOnALineIsTheCrps)
{
  const std::vector<double> sample = { 3.0, -1.0, 4.0, 1.0, 5.5 };
  std::vector<std::array<double, 2>> places;
  for (const double x : sample)
  {
    places.push_back({ 0.6 * x, 0.8 * x });
  }
  EXPECT_NEAR(energyScore(places, { 1.2, 1.6 }), crps(sample, 2.0), 1e-12);
  // A forecast that is sure is as good as it is near.
  EXPECT_DOUBLE_EQ(crps({ 7.0, 7.0, 7.0 }, 4.0), 3.0);
}

TEST(TrackedGround, CutsWaysAtTheWidenedHull)
{
  const std::vector<Place> places = { { 0, 0 }, { 4, 0 }, { 1, 1 }, { 4, 2 }, { 0, 2 }, { 2, 0 } };
  const TrackedGround tracked(places, 0.5);
  EXPECT_TRUE(tracked.holds({ 4.4, 1.0 }));
  EXPECT_FALSE(tracked.holds({ 4.6, 1.0 }));
  const Place inside = tracked.cut({ 1, 1 }, { 3, 1.5 }), beyond = tracked.cut({ 1, 1 }, { 8, 1 });
  EXPECT_EQ(inside, (Place{ 3, 1.5 }));
  EXPECT_NEAR(beyond[0], 4.5, 1e-12);
  EXPECT_NEAR(beyond[1], 1.0, 1e-12);
  const std::vector<Place> line = { { 0, 0 }, { 1, 1 }, { 2, 2 } };
  EXPECT_THROW(TrackedGround(line, 1.0), DataError);
}

TEST(FieldRocks, HaveTheirMassAndSize)
{
  const Vec3 size(0.5, 0.3, 0.39);
  const Polyhedron rock = makeCutBox(size, 79.0 / 2700.0);
  EXPECT_NEAR(rock.integrals().volume, 79.0 / 2700.0, 1e-9);
  EXPECT_EQ(rock.faces().size(), 26u);
  for (int axis = 0; axis < 3; ++axis)
  {
    double most = 0.0;
    for (const Vec3& v : rock.vertices())
    {
      most = std::max(most, v[axis]);
    }
    EXPECT_NEAR(most, 0.5 * size[axis], 1e-9);
  }
  EXPECT_THROW(makeCutBox(size, 1.01 * size.prod()), DataError);
}

TEST(SingleImpact, FlatDropKeepsTheSquareOfTheRestitution)
{
  SurfaceMaterial ground = rockfall::testing::material(0.5, 40.0);
  ground.restitutionModel = RestitutionModel::NormalTangential;
  const Terrain terrain = rockfall::testing::makePlane(21, 20.0, 0.0, 0.0, ground);
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.position = Vec3(10.0, 10.0, 100.5);
  rock.velocity = Vec3(0.0, 0.0, -6.0);
  SimulationParameters p;
  p.endTime = 1.5;
  p.outputInterval = 0.01;
  const Rock before = heldBack(terrain, rock, p.gravity);
  EXPECT_GT(before.position.z(), rock.position.z());
  // The same parabola: height and speed go together.
  EXPECT_NEAR(0.5 * before.velocity.squaredNorm() + p.gravity * before.position.z(),
    18.0 + p.gravity * 100.5, 1e-9);
  const ImpactOutcome outcome = simulateImpact(terrain, before, p, 0);
  ASSERT_TRUE(outcome.touched && outcome.tookOff);
  EXPECT_NEAR(outcome.velocityAfter.z(), 3.0, 0.03); // 1 % for the vibration left in the block
  EXPECT_NEAR(outcome.energyAfter / outcome.energyBefore, 0.25, 0.01);
  EXPECT_LT(outcome.spinAfter, 1e-3 * outcome.energyAfter);
}

TEST(SingleImpact, ShortHopsArePartOfIt)
{
  // A cube that falls on one edge turns over onto the others within a few hundredths of a second.
  SurfaceMaterial ground = rockfall::testing::material(0.2, 40.0);
  ground.restitutionModel = RestitutionModel::NormalTangential;
  const Terrain terrain = rockfall::testing::makePlane(21, 20.0, 0.0, 0.0, ground);
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.orientation = Quat(Eigen::AngleAxisd(0.1, Vec3::UnitY()));
  rock.position = Vec3(10.0, 10.0, 100.7);
  rock.velocity = Vec3(0.0, 0.0, -6.0);
  SimulationParameters p;
  p.endTime = 1.5;
  p.outputInterval = 0.01;
  const ImpactOutcome outcome = simulateImpact(terrain, rock, p, 0);
  ASSERT_TRUE(outcome.touched);
  // Both edges of its face have hit: it is not on its way down any more.
  EXPECT_GE(outcome.velocityAfter.z(), -0.05);
  EXPECT_LT(outcome.energyAfter, 0.3 * outcome.energyBefore);
}

TEST(GroundSettings, ByName)
{
  GroundSettings s;
  s.set("tangentialRestitution=0.7");
  s.set("frictionAngle=30");
  EXPECT_DOUBLE_EQ(s.material.tangentialRestitution, 0.7);
  EXPECT_DOUBLE_EQ(s.material.frictionAngle, radians(30.0));
  EXPECT_THROW(s.set("stickiness=1"), UsageError);
  EXPECT_THROW(s.set("frictionAngle=steep"), UsageError);
  EXPECT_THROW(s.set("frictionAngle"), UsageError);
  EXPECT_THROW(s.set("tangentialRestitution=1.5"), ParameterError);
}

TEST(GroundSettings, APresetIsAllOfTheGround)
{
  GroundSettings s;
  s.set("roughnessDeviation=0.04");
  s.setGround("Meadow");
  const GroundPreset& meadow = groundPreset("meadow");
  EXPECT_EQ(s.material.yielding, meadow.yielding);
  EXPECT_EQ(s.material.restitutionModel, RestitutionModel::SpeedDependent);
  EXPECT_EQ(s.material.restitution, meadow.normalRestitution);
  EXPECT_EQ(s.material.restitutionDeviation, meadow.restitutionDeviation);
  EXPECT_EQ(s.roughness, meadow.roughness);
  EXPECT_EQ(s.deviationPer, DeviationPer::Impact);
  s.setGround("hard");
  EXPECT_FALSE(s.material.yielding.yields());
  EXPECT_EQ(s.deviationPer, DeviationPer::Iteration);
  EXPECT_THROW(s.setGround("moon"), DataError);
}

TEST(SlopeFigures, AreThoseOfTheSample)
{
  std::vector<TrajectorySummary> rocks(101);
  for (int k = 0; k < 101; ++k)
  {
    TrajectorySummary& t = rocks[std::size_t(37 * k % 101)]; // in any order
    t.maxSpeed = k;
    t.maxHeightOverGround = 0.1 * k;
    t.runOut = 100.0 + k;
    t.start.z() = 100.0;
    t.endTime = 2.0 * k;
  }
  const SlopeFigures f = figuresOf(rocks);
  EXPECT_NEAR(f.speed, 95.0, 1e-9);
  EXPECT_NEAR(f.jump, 9.5, 1e-9);
  EXPECT_NEAR(f.runOut, 150.0, 1e-9);
  EXPECT_NEAR(f.reach, degrees(std::atan(100.0 / 150.0)), 1e-9);
  EXPECT_NEAR(f.reachFarthest, degrees(std::atan(100.0 / 199.0)), 1e-9);
  EXPECT_NEAR(f.longest, 200.0, 1e-9);
}

// A ball lands, rolls down, over the foot and on to its rest: Azzoni et al. (1995), and at both
// impacts the angular momentum about the place that is touched, less what the resistance takes.
TEST(SlopeFigures, ABallRestsWhereTheClosedFormHasIt)
{
  const double angle = radians(10.0), resistance = 0.1, g = 9.80665, share = 5.0 / 7.0;
  GroundSettings s;
  s.material.restitutionModel = RestitutionModel::NormalTangential;
  s.material.restitution = 0.0;
  s.material.restitutionDeviation = 0.0;
  s.material.frictionAngle = radians(60.0);
  s.material.frictionAngleDeviation = 0.0;
  s.material.yielding.rollingResistance = resistance;
  s.roughness = {};
  s.simulation.normalPenalty = 0.0;
  s.simulation.gravity = g;
  s.simulation.iterations = 2;
  s.simulation.endTime = 300.0;
  s.simulation.outputInterval = 0.5;
  const SlopeFigures f = measure(s, { 10.0, 20.0, 1.0 }, { makeShape(Shape::Sphere, 1.0) });

  const double radius = std::cbrt(0.75 / std::numbers::pi), c = std::cos(angle),
               n = std::sin(angle);
  const double gap = 2.0 * c - radius, rise = 1.5 * n;
  const double t = (rise + std::sqrt(rise * rise + 2.0 * g * c * gap)) / (g * c);
  const double down = g * c * t - rise, along = 1.5 * c + g * n * t; // m/s, at the touch
  double v = share * (along - resistance * down);
  const double foot = 2.0 * std::round((8.0 + 20.0 / std::tan(angle)) / 2.0);
  const double before = radius * std::tan(0.5 * angle); // of the foot: the ball touches both
  const double way = (foot - 8.0) / c - 2.0 * n - (1.5 * c * t + 0.5 * g * n * t * t) - before;
  v = std::sqrt(v * v + 2.0 * share * g * c * (std::tan(angle) - resistance) * way);
  EXPECT_NEAR(f.speed, v, 0.01 * v);
  v *= 1.0 - share * (1.0 - c) - share * resistance * n;
  const double stop = foot + before + v * v / (2.0 * share * g * resistance);
  EXPECT_NEAR(f.runOut, stop - 8.0, 0.01 * (stop - 8.0));
  EXPECT_NEAR(f.reach, f.reachFarthest, 1e-3); // they are all alike
}
