// Which steps are counted as taken although they had not settled.

#include "form.h"
#include "law/settings.h"
#include "piles.h"
#include "randomScenes.h"
#include "solve/island/SoftSolver.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

using namespace rockfall;
using namespace rockfall::testing;

TEST(Unsettled, WhatEndsDeepIsNotTaken)
{
  for (const bool deep : { false, true })
  {
    for (const Accept accept : { Accept::Settled, Accept::Any })
    {
      SCOPED_TRACE(std::to_string(deep) + ", accept " + std::to_string(int(accept)));
      const Rock cube = brick(Vec3(1.0, 1.0, 1.0), Vec3::Zero(), 0);
      const Block block(cube.shape, cube.density, cube.youngModulus, cube.poissonRatio);
      BlockState state;
      state.velocity.z() = -1.0;
      std::vector<IslandContact> contacts;
      std::vector<IslandBody> bodies(1);
      bodies[0].block = &block;
      bodies[0].state = &state;
      SoftSolver solver;
      solver.begin(lastingStep(0.005, 0.0), accept, bodies, contacts);
      EndDetectionOutcome seen;
      seen.passed = (deep ? 2.0 : 0.5) * kDeepMiss;
      solver.goOn(seen);
      const IslandOutcome outcome = solver.finish();
      const bool taken = !deep || accept == Accept::Any;
      EXPECT_EQ(outcome.settled, !deep);
      EXPECT_EQ(outcome.accepted, taken);
      EXPECT_EQ(state.time, taken ? 0.005 : 0.0);
      EXPECT_EQ(state.position.z() == 0.0, !taken);
    }
  }
}

TEST(Unsettled, HeapsThatFallAndRestHaveNone)
{
  // One step of a heap is 108 rock-steps, so that a single heap says little.
  std::int64_t unsettled = 0, steps = 0;
  const int heaps = someOf(4, 1);
  for (int seed = 1; seed <= heaps; ++seed)
  {
    std::mt19937_64 random{ std::uint64_t(seed) };
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    Pile pile;
    pile.ground = floorSlope();
    pile.awake = false;
    pile.parameters.endTime = 6.0;
    for (int k = 0; k < 108; ++k)
    {
      Rock rock;
      rock.blockId = k;
      rock.shape = makeShape(k % 2 ? Shape::Icosahedron : Shape::Cube, 0.3);
      rock.position = Vec3(20.0 + 1.2 * (k % 3 - 1) + 0.1 * u(random), 20.0 + 1.2 * (k / 3 % 3 - 1),
        1.0 + 1.2 * (k / 9));
      rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
      pile.rocks.push_back(rock);
    }
    pile.make();
    for (const Trajectory& t : pile.fall->run())
    {
      unsettled += t.summary.unsettledSteps;
      steps += t.summary.contactSteps;
    }
  }
  EXPECT_GT(steps, 50000 * heaps);
  EXPECT_LT(double(unsettled), 0.001 * double(steps));
}

TEST(Unsettled, OneRockThatMayNotIterateHasSome)
{
  // Two open–close iterations and no cuts are never enough to close a contact and see it stay.
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.position = Vec3(20.0, 20.0, 2.0);
  SimulationParameters p;
  p.endTime = 2.0;
  EXPECT_EQ(simulate(floorSlope(), rock, p).summary.unsettledSteps, 0);
  p.maxOpenClose = 2;
  p.maxCuts = 0;
  EXPECT_GT(simulate(floorSlope(), rock, p).summary.unsettledSteps, 0);
}

// Cohesion of a hundred thousand times their weight is friction of 87° where it sets in, which has no
// balance in a step that does not resolve the springs; what is taken without one makes energy.
TEST(Unsettled, NeedlesOfStrongCohesionHaveNoneAndGainNothing)
{
  SurfaceMaterial sticky = material(0.6, 25.0);
  sticky.cohesion = 16.0; // N
  const Terrain ground = makeSlope(
    3, 1.0, [](double, double) { return 0.0; }, sticky);
  for (const std::uint64_t seed : { 5, 6, 9 })
  {
    SceneDraw draw(seed);
    Rock rock;
    rock.shape = makeBox(Vec3(0.012, 0.0007, 0.0005));
    rock.density = 1500.0;
    const double w = draw.even(-1.0, 1.0), x = draw.even(-1.0, 1.0), y = draw.even(-1.0, 1.0);
    rock.orientation = Quat(w, x, y, draw.even(-1.0, 1.0)).normalized();
    double lowest = 0.0;
    for (const Vec3& vertex : rock.shape.vertices())
    {
      lowest = std::min(lowest, (rock.orientation * vertex).z());
    }
    rock.position = Vec3(1.0, 1.0, 1e-6 - lowest);
    SimulationParameters p;
    p.timeStep = 0.026;
    p.normalPenalty = 1e8;
    p.rigid = true;
    p.endTime = 0.05;
    const TrajectorySummary fallen = simulate(ground, rock, p).summary;
    EXPECT_EQ(fallen.unsettledSteps, 0) << seed;
    EXPECT_GE(fallen.energy.damping, 0.0) << seed;
  }
}
