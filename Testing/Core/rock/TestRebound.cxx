// A block dropped on a horizontal slope: METHOD 9.1 and 10.1, restitution (METHOD 4).

#include "piles.h"
#include "slopes.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

Terrain slopeOf(double restitution)
{
  return makeSlope(
    5, 5.0, [](double, double) { return 100.0; }, material(restitution, 15.0));
}

Rock cubeOver(double height)
{
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.position = Vec3(10.0, 10.0, 100.5 + height);
  rock.youngModulus = 1e11;
  return rock;
}

} // namespace

TEST(Rebound, IsElasticWhateverThePhaseOfTheStep)
{
  // METHOD 10.1: a literal transcription gives 0.03 … 2.81 here.
  const Terrain slope = slopeOf(1.0);
  for (double timeStep : { 0.01, 0.005, 0.001 })
  {
    for (double penalty : { 1e8, 1e9, 1e10 })
    {
      for (int k = 0; k < 20; ++k)
      {
        SimulationParameters p;
        p.timeStep = timeStep;
        p.normalPenalty = penalty;
        p.endTime = 1.0;
        const Trajectory t = simulate(slope, cubeOver(1.0 + 2.0 * k / 19.0), p);
        ASSERT_FALSE(t.impacts.empty());
        const ImpactEvent& impact = t.impacts.front();
        const double ratio = -impact.velocityAfter.z() / impact.velocityBefore.z();
        // The bar is 1 %: what is missing stays in the block as vibration.
        EXPECT_NEAR(ratio, 1.0, 0.01) << timeStep << " s, " << penalty << " N/m, drop " << k;
      }
    }
  }
}

TEST(Rebound, FiveMetreDropLosesWhatRvSays)
{
  for (double rv : { 0.6, 0.7, 0.8 })
  {
    SimulationParameters p;
    p.endTime = 30.0;
    const Trajectory t = simulate(slopeOf(rv), cubeOver(5.0), p);
    ASSERT_GT(t.impacts.size(), 5u);
    // √(2 g 5 m) = 9.905 m/s; the event starts up to one step of 0.2 ms before the touch.
    EXPECT_NEAR(t.impacts[0].velocityBefore.z(), -9.905, 0.003);
    for (std::size_t k = 0; k + 1 < 5; ++k)
    {
      const double v = t.impacts[k].velocityBefore.z(), next = t.impacts[k + 1].velocityBefore.z();
      // Rv², as a ratio of heights, within 1 %.
      EXPECT_NEAR(next * next / (v * v), rv * rv, 0.01 * rv * rv) << rv << ", bounce " << k;
    }
    // At rest when the geometric series ends, t = t₁ (1 + Rv) / (1 − Rv), and recognised as such
    // after half a second of stillness. The last hops, below 0.1 m/s, are not made (0.1 s of the
    // series). After some twenty bounces on four corners the cube wobbles, as rounding grows from
    // bounce to bounce, which shortens its last hops; how much is chance.
    const double fall = std::sqrt(2.0 * 5.0 / kGravity);
    const double series = fall * (1.0 + rv) / (1.0 - rv);
    EXPECT_EQ(t.summary.fate, Fate::Rested);
    EXPECT_NEAR(t.summary.endTime, series + 0.5, 0.6);
    // The block stands on the floor, 6e-6 m into the penalty springs.
    EXPECT_NEAR(t.summary.stop.z(), 100.5, 2e-5);
    EXPECT_LT(std::abs(t.summary.energy.numerical), 0.005 * t.summary.energy.released);
  }
}

TEST(Rebound, OfASoftBlockDoesNotHangOnTheTimeStep)
{
  // Whether the block rings, and what it loses so, is its own affair. Impacts are resolved by
  // themselves; what is left is the phase of their steps.
  const Terrain slope = slopeOf(1.0);
  for (double youngModulus : { 1e7, 1e8, 1e9, 1e10 })
  {
    double least = 1.0, most = 0.0;
    for (double timeStep : { 0.01, 0.005, 0.002, 0.001 })
    {
      SimulationParameters p;
      p.timeStep = timeStep;
      p.endTime = 0.9;
      Rock rock = cubeOver(1.0);
      rock.youngModulus = youngModulus;
      const Trajectory t = simulate(slope, rock, p);
      ASSERT_FALSE(t.impacts.empty());
      // What was not dropped as vibration, of a fall of 1 m.
      const double kept = 1.0 - t.summary.energy.vibration / (rock.density * 9.81);
      least = std::min(least, kept);
      most = std::max(most, kept);
    }
    EXPECT_LT(most - least, 0.01) << youngModulus << " Pa";
    if (youngModulus < 1e9)
    {
      EXPECT_LT(most, 0.97);
    }
    else
    {
      EXPECT_EQ(least, 1.0);
    }
  }
}

TEST(Rebound, ElasticDropInAnyAttitudeKeepsEnergy)
{
  // No friction, Rv 1: after separation nothing is lost but the block's vibration.
  SurfaceMaterial smooth = material(1.0, 0.0);
  const Terrain slopes[] = { makeSlope(
                               9, 2.0, [](double, double) { return 100.0; }, smooth),
    makeSlope(
      9, 2.0, [](double x, double) { return 100.0 - 0.3 * x; }, smooth),
    makeSlope(
      9, 2.0, [](double x, double) { return 100.0 - 0.5 * std::abs(x - 8.0); }, smooth),
    makeSlope(
      9, 2.0, [](double x, double y) { return 100.0 - 0.4 * std::hypot(x - 8.0, y - 8.0); },
      smooth) };
  std::srand(1); // UnitRandom
  double worst = 0.0;
  int total = 0, within = 0;
  for (const Terrain& slope : slopes)
  {
    for (Shape shape : { Shape::Cube, Shape::Tetrahedron, Shape::Octahedron, Shape::Dodecahedron,
           Shape::Icosahedron, Shape::Eota221 })
    {
      for (int k = 0; k < 10; ++k)
      {
        Rock rock;
        rock.shape = makeShape(shape, 1.0);
        rock.orientation = Quat::UnitRandom();
        rock.position = Vec3(8.0 + 0.05 * k, 8.0 - 0.03 * k, 103.0);
        SimulationParameters p;
        p.endTime = 1.2;
        const Trajectory t = simulate(slope, rock, p);
        const EnergyAudit& e = t.summary.energy;
        // Fall height 3 m or so; what a bounce may lose is measured against that.
        const double scale = t.summary.mass * kGravity * 2.0;
        worst = std::max(worst, std::abs(e.numerical) / scale);
        ++total;
        within += std::abs(e.numerical) < 0.01 * scale;
        // Every spring keeps its energy when it goes over to another feature: rounding.
        EXPECT_LT(std::abs(e.numerical), 1e-6 * scale)
          << shapeName(shape) << ", attitude " << k << ", slope " << &slope - slopes;
        EXPECT_LT(std::abs(e.friction), 1e-9 * scale);
        EXPECT_EQ(e.restitution, 0.0);
      }
    }
  }
  EXPECT_EQ(within, total);
  std::printf("%d of %d within 1 %%; largest numerical energy error: %.2e of the fall\n", within,
    total, worst);
}

/// Boxes of any proportions on a face or an edge, without friction: what touches comes back with Rn
/// times its speed, however many corners it is and whatever mass each of them would feel alone.
TEST(Rebound, OfFacesAndEdgesIsThatOfTheCoefficient)
{
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (const double e : { 0.2, 0.5, 0.8 })
  {
    SurfaceMaterial m = material(e, 0.0);
    m.restitutionModel = RestitutionModel::NormalTangential;
    const Terrain floor = makePlane(21, 100.0, 0.0, 0.0, m);
    for (int k = 0; k < 100; ++k)
    {
      const bool edge = k % 2 == 1;
      const Vec3 size(0.2 + 1.5 * u(random), 0.2 + 1.5 * u(random), 0.2 + 1.5 * u(random));
      Rock rock = brick(size, Vec3(50.0, 50.0, 103.0), 1);
      rock.orientation =
        Quat(Eigen::AngleAxisd(edge ? 0.15 + 1.2 * u(random) : 0.0, Vec3::UnitY()));
      rock.velocity = Vec3(0.0, 0.0, -3.0);
      SimulationParameters p;
      p.gravity = 1e-6;
      p.endTime = 2.0;
      p.rigid = true;
      const Trajectory t = simulate(floor, rock, p);
      ASSERT_GE(t.impacts.size(), 1u);
      double back = t.impacts[0].velocityAfter.z();
      if (edge)
      {
        // The impulse is that on the centroid, the speed that of the edge.
        const Block block(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio);
        Vec3 lowest = Vec3::Constant(1e9);
        for (const Vec3& v : rock.shape.vertices())
        {
          const Vec3 x = rock.orientation * v;
          lowest = x.z() < lowest.z() ? x : lowest;
        }
        lowest.y() = 0.0;
        const Quat turn = rock.orientation.conjugate();
        back =
          -3.0 + block.mass() * (back + 3.0) * block.mobility(turn * Vec3::UnitZ(), turn * lowest);
      }
      // The impact is resolved with eight steps.
      EXPECT_NEAR(back / 3.0, e, 0.015) << (edge ? "edge " : "face ") << size.transpose();
    }
  }
}

/// Prisms of many corners on their end, also slender ones, and hardly any rebound: a dashpot that
/// stops a rock within a fraction of a step must not throw it back.
TEST(Rebound, OfManyCornersAndOfNearlyNone)
{
  const auto prism = [](int corners, double radius, double height)
  {
    std::vector<Vec3> points;
    for (int k = 0; k < corners; ++k)
    {
      const double turn = 2.0 * std::numbers::pi * (k + 0.5) / corners;
      for (const double z : { -0.5 * height, 0.5 * height })
      {
        points.emplace_back(radius * std::cos(turn), radius * std::sin(turn), z);
      }
    }
    return Polyhedron::convexHull(points).centred();
  };
  const Polyhedron shapes[] = { prism(4, 0.7, 1.0), prism(4, 0.3, 2.0), prism(12, 0.6, 1.0),
    prism(24, 0.6, 1.0), prism(24, 0.3, 2.0), prism(24, 1.0, 0.3) };
  for (const double e : { 0.0, 0.02, 0.05, 0.1, 0.3, 0.6, 0.9 })
  {
    SurfaceMaterial m = material(e, 0.0);
    m.restitutionModel = RestitutionModel::NormalTangential;
    const Terrain floor = makePlane(21, 100.0, 0.0, 0.0, m);
    for (const Polyhedron& shape : shapes)
    {
      for (int phase = 0; phase < 5; ++phase)
      {
        Rock rock;
        rock.shape = shape;
        rock.position = Vec3(50.0, 50.0, 103.0 + 0.037 * phase);
        rock.velocity = Vec3(0.0, 0.0, -3.0);
        SimulationParameters p;
        p.gravity = 1e-6;
        p.endTime = 2.0;
        const Trajectory t = simulate(floor, rock, p);
        ASSERT_GE(t.impacts.size(), 1u);
        const double back = t.impacts[0].velocityAfter.z() / 3.0;
        // What is left when the dashpot has stopped it is the push of springs compressed by half a
        // step's way, at most (π/16)².
        EXPECT_NEAR(back, e, e < 0.1 ? 0.04 : 0.01)
          << shape.vertices().size() / 2 << " corners, " << e;
      }
    }
  }
}

/// A tilted cube that lands, tumbles and lands again, and touches by impacts only: what was taken
/// is what their events tell, from the first step of each on.
TEST(Rebound, EventsTellAllThatImpactsTake)
{
  for (const RestitutionModel model : { RestitutionModel::Velocity,
         RestitutionModel::NormalTangential, RestitutionModel::SpeedDependent })
  {
    for (const double e : { 0.3, 0.8 })
    {
      SurfaceMaterial m = material(e, 30.0);
      m.restitutionModel = model;
      const Terrain floor = makePlane(21, 100.0, 0.0, 0.0, m);
      Rock rock = brick(Vec3(1.0, 1.0, 1.0), Vec3(50.0, 50.0, 105.8), 1);
      rock.velocity = Vec3(2.0, 0.0, 0.0);
      rock.orientation = Quat(Eigen::AngleAxisd(0.3, Vec3(1.0, 2.0, 0.0).normalized()));
      SimulationParameters p;
      p.endTime = 1.3;
      p.normalPenalty = 1e9;
      const Trajectory t = simulate(floor, rock, p);
      EXPECT_GE(t.impacts.size(), 2u);
      double told = 0.0;
      for (const ImpactEvent& event : t.impacts)
      {
        told += event.energyLoss;
      }
      const double taken = t.summary.energy.restitution + t.summary.energy.friction;
      EXPECT_GT(taken, 1e4);
      EXPECT_NEAR(told, taken, 1e-9 * taken) << int(model) << ' ' << e;
    }
  }
}

TEST(Rebound, WhatIsUnderWayInTheEndIsAnImpact)
{
  // The end time comes while the cube is pressed in: what it took is booked, and so told.
  SurfaceMaterial m = material(0.5, 30.0);
  m.restitutionModel = RestitutionModel::NormalTangential;
  const Terrain floor = makePlane(21, 100.0, 0.0, 0.0, m);
  const Rock rock = brick(Vec3(1.0, 1.0, 1.0), Vec3(50.0, 50.0, 100.5 + 0.5 * kGravity), 1);
  SimulationParameters p;
  p.endTime = 1.0012;
  const Trajectory t = simulate(floor, rock, p);
  ASSERT_EQ(t.impacts.size(), 1u);
  EXPECT_EQ(t.summary.impacts, 1);
  EXPECT_NEAR(t.impacts[0].time, 1.0, 1e-3);
  EXPECT_NEAR(t.impacts[0].energyLoss, t.summary.energy.restitution + t.summary.energy.friction,
    1e-9 * t.summary.energy.restitution);
}

TEST(Rebound, RollingAndSlidingAreNoImpacts)
{
  // A cube pushed over a floor slides to rest in v² / 2μg, not slowed by Rv = 0.6 on the way.
  Rock rock = cubeOver(0.0);
  rock.velocity = Vec3(3.0, 0.0, 0.0);
  SimulationParameters p;
  p.endTime = 10.0;
  const Trajectory t = simulate(slopeOf(0.6), rock, p);
  const double expected = 9.0 / (2.0 * kGravity * std::tan(radians(15.0)));
  EXPECT_EQ(t.summary.impacts, 0);
  EXPECT_EQ(t.summary.fate, Fate::Rested);
  EXPECT_NEAR(t.summary.runOut, expected, 0.01 * expected);
}
