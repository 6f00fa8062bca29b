// What one rock of a mass fall has broken is gone for the others.

#include "piles.h"
#include "terrain/structures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// A cube of 2.5 t, thrown level from 3 m over level ground so that it comes to `to` after `time`.
Rock thrown(const Vec3& velocity, double time, std::int64_t id, const Vec3& to = { 60, 50, 103 })
{
  Rock rock = brick(Vec3(1, 1, 1), to - time * velocity, id);
  rock.velocity = velocity;
  return rock;
}
const Vec3 kFast(20.0, 0.0, 0.0), kSlow(15.0, 0.0, 0.0); // 500 kJ and 281 kJ

std::vector<Trajectory> runTogether(const Structures& structures, std::vector<Rock> rocks)
{
  Pile pile;
  pile.ground = makePlane(21, 100.0, 0.0, 0.0, material(0.3, 30.0));
  pile.ground.setStructures(structures);
  pile.parameters.endTime = 0.7;
  pile.rocks = std::move(rocks);
  pile.make();
  return pile.fall->run();
}

Structures net(double capacity)
{
  Barrier b;
  b.feature = 3;
  b.points = { { 60.0, 20.0 }, { 60.0, 80.0 } };
  b.height = 5.0;
  b.capacity = capacity;
  Structures s;
  s.barriers = { b };
  return s;
}

Structures stem(const Eigen::Vector2d& position, double capacity)
{
  Tree tree;
  tree.feature = 4;
  tree.position = position;
  tree.diameter = 0.3;
  tree.height = 20.0;
  tree.capacity = capacity;
  Structures s;
  s.trees = { tree };
  return s;
}

} // namespace

TEST(BrokenStructures, NetIsGoneForTheNext)
{
  const Vec3 beside(60, 40, 103);
  const Rock fast = thrown(kFast, 0.3, 0, beside), slow = thrown(kSlow, 0.4, 1);
  const std::vector<Trajectory> alone = runTogether(net(400e3), { slow });
  EXPECT_EQ(alone[0].summary.fate, Fate::Caught);
  for (const bool first : { true, false })
  {
    const std::vector<Trajectory> runs = runTogether(
      net(400e3), first ? std::vector<Rock>{ fast, slow } : std::vector<Rock>{ slow, fast });
    const Trajectory &breaks = runs[first ? 0 : 1], &follows = runs[first ? 1 : 0];
    ASSERT_EQ(breaks.structures.size(), 1u);
    EXPECT_EQ(breaks.structures[0].outcome, StructureOutcome::BarrierBroken);
    EXPECT_TRUE(follows.structures.empty());
    EXPECT_EQ(follows.summary.fate, Fate::Moving);
    EXPECT_GT(follows.summary.stop.x(), 61.0);
  }
  // Rocks that come before it breaks are caught, and stay so.
  const std::vector<Trajectory> runs =
    runTogether(net(400e3), { thrown(kFast, 0.4, 0, beside), thrown(kSlow, 0.3, 1) });
  EXPECT_EQ(runs[0].structures[0].outcome, StructureOutcome::BarrierBroken);
  EXPECT_EQ(runs[1].summary.fate, Fate::Caught);
}

TEST(BrokenStructures, TreeIsGoneForTheNext)
{
  const Structures one = stem({ 60.0, 50.0 }, 350e3);
  const Rock fast = thrown(Vec3(0, 30, 0), 0.2, 0), slow = thrown(kSlow, 0.4, 1);
  const std::vector<Trajectory> alone = runTogether(one, { slow });
  EXPECT_LT(alone[0].summary.stop.x(), 60.0);
  const std::vector<Trajectory> runs = runTogether(one, { slow, fast });
  ASSERT_EQ(runs[1].structures.size(), 1u);
  EXPECT_EQ(runs[1].structures[0].outcome, StructureOutcome::TreeBroken);
  EXPECT_TRUE(runs[0].structures.empty());
  EXPECT_NEAR(runs[0].summary.stop.x(), 64.5, 1e-9); // in free flight
}

TEST(BrokenStructures, WhatLeansOnATreeGoesOnWhenAnotherBreaksIt)
{
  // On 25° with 10° of friction only the stem holds the cube.
  const double angle = radians(25.0), axis = 60.0;
  Pile pile;
  pile.awake = false;
  pile.ground = makePlane(21, 100.0, angle, 0.0, material(0.0, 10.0));
  pile.ground.setStructures(stem({ axis, 50.0 }, 300e3));
  pile.parameters.endTime = 8.0;
  Rock leans = cubeOnPlane(100.0, angle, 0.0, 0.0);
  const Vec3 down(std::cos(angle), 0.0, -std::sin(angle));
  leans.position += (axis - 1.5 - leans.position.x()) / down.x() * down;
  leans.blockId = 0;
  // The late rock comes to the stem across the slope after 5 s, well over the cube.
  Rock late = brick(Vec3(1, 1, 1), Vec3::Zero(), 1);
  const double time = 5.0, speed = 9.0, rise = 0.5 * kGravity * time;
  late.position = leans.position + Vec3(axis - leans.position.x(), -speed * time, 4.0);
  late.velocity = Vec3(0.0, speed, rise);
  pile.rocks = { leans, late };
  pile.make();
  bool leant = false;
  const auto look = [&](double now)
  {
    const BlockState& state = pile.fall->state(0);
    leant = leant ||
      (now > 4.0 && now < 4.5 && state.position.x() < axis && state.velocity.norm() < 1e-6);
    return true;
  };
  const std::vector<Trajectory> runs = pile.fall->run(look);
  EXPECT_TRUE(leant);
  ASSERT_EQ(runs[1].structures.size(), 1u);
  EXPECT_EQ(runs[1].structures[0].outcome, StructureOutcome::TreeBroken);
  EXPECT_GT(runs[0].summary.stop.x(), axis + 3.0);
  const EnergyAudit& e = runs[0].summary.energy;
  EXPECT_LT(std::abs(e.numerical), 1e-6 * e.released);
}
