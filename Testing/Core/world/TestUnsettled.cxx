// Which steps are counted as taken although they had not settled.

#include "cubeOnCorners.h"
#include "piles.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// A cube lies on three corners of its lower face and comes down on the fourth, with few sweeps.
/// Nothing of it is settled to `tolerance`.
IslandOutcome sweepOnce(double tolerance, Accept accept)
{
  CubeOnCorners on;
  on.state.velocity.z() = -0.1;
  for (int k = 0; k < 4; ++k)
  {
    on.contacts[std::size_t(k)].reboundSpeed = k == 3 ? 0.0 : -1.0; // so that it is not calm
  }
  on.solver.tolerance = tolerance;
  on.solver.maxSweeps = 2;
  return on.step(accept);
}

} // namespace

TEST(Unsettled, WhatIsNearlySettledIsNotRough)
{
  const IslandOutcome near = sweepOnce(1e-4, Accept::Converging);
  EXPECT_FALSE(near.settled);
  EXPECT_FALSE(near.unconverged);
  EXPECT_TRUE(near.accepted);
  // The same to a tolerance that rounding does not reach.
  const IslandOutcome far = sweepOnce(1e-22, Accept::Converging);
  EXPECT_TRUE(far.unconverged);
  EXPECT_FALSE(far.accepted);
  const IslandOutcome anyway = sweepOnce(1e-22, Accept::Any);
  EXPECT_TRUE(anyway.unconverged);
  EXPECT_TRUE(anyway.accepted);
}

TEST(Unsettled, HeapsThatFallAndRestHaveNone)
{
  // Nine of ten steps do not settle to 1e-4 of the longest way; none is far from it. One step of a
  // heap is 108 rock-steps, so that a single heap says little (0 to 0.12 %); of 24 it is 0.04 %.
  std::int64_t unsettled = 0, steps = 0;
  for (const unsigned seed : { 1, 2, 3, 4 })
  {
    std::mt19937_64 random(seed);
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
    pile.fall->setLargestSoft(0);
    for (const Trajectory& t : pile.fall->run())
    {
      unsettled += t.summary.unsettledSteps;
      steps += t.summary.contactSteps;
    }
  }
  EXPECT_GT(steps, 200000);
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
