// What one rock of a mass fall has broken is gone for the others.

#include "piles.h"
#include "terrain/structures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
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
    ASSERT_EQ(follows.structures.size(), 1u);
    EXPECT_EQ(follows.structures[0].outcome, StructureOutcome::BarrierGone);
    EXPECT_EQ(follows.structures[0].energyTaken, 0.0);
    EXPECT_EQ(follows.summary.fate, Fate::Moving);
    EXPECT_GT(follows.summary.stop.x(), 61.0);
  }
  // Rocks that come before it breaks are caught, and stay so.
  const std::vector<Trajectory> runs =
    runTogether(net(400e3), { thrown(kFast, 0.4, 0, beside), thrown(kSlow, 0.3, 1) });
  EXPECT_EQ(runs[0].structures[0].outcome, StructureOutcome::BarrierBroken);
  EXPECT_EQ(runs[1].summary.fate, Fate::Caught);
}

/// The braking distance at a capacity is 5 m, 60 % of the height are left of it, and 4 m³ fill a
/// metre.
Structures loadedNet(double capacity)
{
  Structures s = net(capacity);
  s.barriers[0].braking = 5.0;
  s.barriers[0].residual = 0.6;
  s.barriers[0].room = 4.0;
  return s;
}

TEST(BrokenStructures, WhatANetHoldsLoadsItForTheNext)
{
  // 281 kJ, and what it fell, of 700 kJ: two are held, the third one is too strong for the rest.
  constexpr double capacity = 700e3, length = 60.0;
  std::vector<Rock> rocks;
  for (int k = 0; k < 3; ++k)
  {
    rocks.push_back(thrown(kSlow, 0.2 + 0.1 * k, k, Vec3(60, 40 + 10 * k, 102)));
  }
  const std::vector<Trajectory> runs = runTogether(loadedNet(capacity), rocks);
  double held = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    const Trajectory& run = runs[std::size_t(k)];
    ASSERT_EQ(run.structures.size(), 1u) << k;
    const StructureEvent& event = run.structures[0];
    EXPECT_EQ(
      event.outcome, k < 2 ? StructureOutcome::BarrierStopped : StructureOutcome::BarrierBroken);
    EXPECT_EQ(event.heldBefore, held) << k;
    const double rope = 5.0 * (1.0 - 0.4 * held / capacity), fill = 5.0 * k / (4.0 * length);
    EXPECT_NEAR(event.usefulHeight, rope - fill, 1e-12);
    held += event.energyTaken;
    EXPECT_NEAR(event.brakingDistance, k < 2 ? 5.0 * std::sqrt(held / capacity) : 0.0, 1e-12);
    const EnergyAudit& e = run.summary.energy;
    EXPECT_LT(std::abs(e.numerical), 1e-9 * e.released);
    EXPECT_NEAR(e.structures, event.energyTaken, 1e-9 * capacity);
  }
  EXPECT_NEAR(held, capacity, 1e-9 * capacity); // the third one took the rest

  // One that neither wears nor fills is as new for all.
  Structures asNew = net(capacity);
  asNew.barriers[0].braking = 5.0;
  for (const Trajectory& run : runTogether(asNew, rocks))
  {
    ASSERT_EQ(run.summary.fate, Fate::Caught);
    const StructureEvent& event = run.structures[0];
    EXPECT_EQ(event.heldBefore, 0.0);
    EXPECT_EQ(event.usefulHeight, 5.0);
    EXPECT_NEAR(event.brakingDistance, 5.0 * std::sqrt(event.energyTaken / capacity), 1e-12);
  }
}

/// Ten rocks side by side at a net that holds one: at once, or one after the other within a step,
/// in the air or as an island.
TEST(BrokenStructures, RocksOfOneStepMeetWhatTheOthersLeave)
{
  for (const double lag : { 0.0, 1e-3, -1e-3 })
  {
    for (const double apart : { 4.0, 1.02 })
    {
      for (const bool absorbs : { false, true })
      {
        SCOPED_TRACE(::testing::Message() << lag << ' ' << apart << ' ' << absorbs);
        std::vector<Rock> rocks;
        for (int k = 0; k < 10; ++k)
        {
          rocks.push_back(thrown(kSlow, 0.2, k, Vec3(60.0 - 15.0 * lag * k, 40 + apart * k, 103)));
        }
        Structures s = net(300e3);
        s.barriers[0].residual = 1.0;
        s.barriers[0].absorbs = absorbs;
        const std::vector<Trajectory> runs = runTogether(s, rocks);
        const int first = lag < 0.0 ? 9 : 0;
        double taken = 0.0;
        int held = 0, broke = 0;
        for (const Trajectory& run : runs)
        {
          for (const StructureEvent& event : run.structures)
          {
            taken += event.energyTaken;
            held += event.outcome == StructureOutcome::BarrierStopped;
            broke += event.outcome == StructureOutcome::BarrierBroken;
          }
        }
        EXPECT_EQ(held, 1);
        EXPECT_EQ(broke, 1);
        EXPECT_LE(taken, 300e3 * (1.0 + 1e-12));
        EXPECT_EQ(runs[std::size_t(first)].summary.fate, Fate::Caught);
      }
    }
  }
}

TEST(BrokenStructures, FillAndRopeLetRocksOver)
{
  // The top comes at 102.5 m, under the rope at 103 m; a rock before it wears or fills the net.
  const Rock first = thrown(kSlow, 0.2, 0, Vec3(60, 40, 101)),
             second = thrown(kSlow, 0.4, 1, Vec3(60, 50, 102 + 0.5 * kGravity * 0.16));
  const auto fate = [&](double residual, double room)
  {
    Structures s = net(700e3);
    s.barriers[0].height = 3.0;
    s.barriers[0].residual = residual;
    s.barriers[0].room = room;
    return runTogether(s, { first, second })[1].summary.fate;
  };
  const double never = std::numeric_limits<double>::infinity(), nan = std::nan("");
  EXPECT_EQ(fate(nan, never), Fate::Caught);
  EXPECT_EQ(fate(0.9, never), Fate::Caught); // 2.88 m are left
  EXPECT_EQ(fate(0.4, never), Fate::Moving); // 2.3 m
  // 1 m³ on 60 m: 1.5 m deep it does not lift the rock, whose bottom is at 1.5 m.
  EXPECT_EQ(fate(nan, 1.0 / 30.0), Fate::Caught);
  EXPECT_EQ(fate(nan, 1.0 / 45.0), Fate::Moving); // 2.25 m: its top comes to 3.25 m
}

TEST(BrokenStructures, LoadsAreThoseOfOneIterationOnAnyNumberOfThreads)
{
  Terrain ground = makePlane(21, 100.0, 0.0, 0.0, material(0.3, 30.0));
  ground.setStructures(loadedNet(2000e3));
  std::vector<Rock> rocks;
  for (int k = 0; k < 16; ++k)
  {
    const double time = 0.2 + 0.05 * k;
    rocks.push_back(
      thrown(kSlow, time, k, Vec3(60, 30 + 2.5 * k, 102 + 0.5 * kGravity * time * time)));
  }
  const auto run = [&](int threads)
  {
    SimulationParameters p;
    p.endTime = 1.5;
    p.iterations = 2;
    p.rockRockContact = true;
    p.threads = threads;
    TrajectoryStore store(int(rocks.size()), p.iterations);
    runEnsemble(ground, rocks, p, store);
    std::vector<std::uint64_t> bits;
    double most = 0.0;
    for (const Trajectory& trajectory : store.trajectories())
    {
      bits.push_back(trajectory.summary.hash);
      for (const StructureEvent& event : trajectory.structures)
      {
        most = std::max(most, event.heldBefore);
      }
      const bool first = trajectory.summary.rock == 0; // of its iteration
      EXPECT_TRUE(!first || trajectory.structures.at(0).heldBefore == 0.0);
    }
    EXPECT_GT(most, 1500e3);
    EXPECT_LE(most, 2000e3);
    return bits;
  };
  const std::vector<std::uint64_t> alone = run(1);
  EXPECT_EQ(run(2), alone);
  EXPECT_EQ(run(4), alone);
}

/// The push of an upright stem is level: what falls along it keeps its speed down.
TEST(BrokenStructures, AStemTakesNothingOfAFallAlongIt)
{
  for (const double across : { 0.5, 2.0, 8.0 })
  {
    const Vec3 velocity(across, 0.0, -28.0); // 980 kJ
    const Rock rock = thrown(velocity, 0.1, 0, { 60.0, 50.0, 112.0 });
    const std::vector<Trajectory> runs = runTogether(stem({ 60.6, 50.0 }, 250e3), { rock });
    ASSERT_EQ(runs[0].structures.size(), 1u) << across;
    const StructureEvent& event = runs[0].structures[0];
    EXPECT_EQ(event.outcome, StructureOutcome::TreeBroken);
    const double level = 0.5 * 2500.0 * across * across;
    EXPECT_LE(event.energyTaken, level * (1.0 + 1e-9)) << across;
    EXPECT_GE(event.energyTaken, 0.9 * level) << across;
    EXPECT_NEAR(runs[0].summary.energy.structures, event.energyTaken, 1e-9 * event.kineticEnergy);
  }
}

/// A stump takes its capacity of what comes down on its top.
TEST(BrokenStructures, AStumpTakesItsCapacityOfWhatFallsOnIt)
{
  for (const double aside : { 0.0, 0.5 })
  {
    Structures s = stem({ 60.0, 50.0 }, 250e3);
    s.trees[0].height = 3.0;
    const Vec3 velocity(aside, 0.0, -28.0); // 980 kJ
    const std::vector<Trajectory> runs =
      runTogether(s, { thrown(velocity, 0.05, 0, { 60.0, 50.0, 104.0 }) });
    ASSERT_EQ(runs[0].structures.size(), 1u) << aside;
    EXPECT_EQ(runs[0].structures[0].outcome, StructureOutcome::TreeBroken);
    EXPECT_NEAR(runs[0].structures[0].energyTaken, 0.98 * 250e3, 0.01 * 250e3) << aside;
  }
}

/// A stump that is hit beside its middle lets the rock slip past, and takes what the event says.
TEST(BrokenStructures, AStumpLetsPassWhatFallsBesideItsMiddle)
{
  int passed = 0;
  for (const double beside : { 0.25, 0.35, 0.45, 0.55 })
  {
    Structures s = stem({ 60.0, 50.0 }, 800e3);
    s.trees[0].height = 3.0;
    const Vec3 velocity(9.0, 0.0, -27.0);
    const std::vector<Trajectory> runs =
      runTogether(s, { thrown(velocity, 0.05, 0, { 60.0, 50.0 + beside, 104.0 }) });
    for (const StructureEvent& event : runs[0].structures)
    {
      passed += event.outcome == StructureOutcome::TreePassed;
      EXPECT_NEAR(runs[0].summary.energy.structures, event.energyTaken, 1e-9 * event.kineticEnergy)
        << beside;
    }
  }
  EXPECT_GT(passed, 0);
}

/// A light rock at rest before a net, which a heavy one drives into it, and a third one that comes on
/// its own: all in one step.
TEST(BrokenStructures, WhoIsDrivenIntoANetLoadsItForTheNext)
{
  Structures s = net(250e3);
  s.barriers[0].residual = 1.0;
  for (const double gap : { 0.03, 0.05, 0.07 })
  {
    Rock light = brick(Vec3(0.8, 0.8, 0.8), Vec3(59.6 - gap + 0.4, 40.0, 100.4), 0);
    Rock heavy = brick(Vec3(3, 3, 3), Vec3(light.position.x() - 0.4 - 1.5 - 0.02, 40.0, 101.5), 1);
    heavy.velocity = Vec3(20.0, 0.0, 0.0);
    const std::vector<Trajectory> runs =
      runTogether(s, { light, heavy, thrown({ 13.0, 0.0, 0.0 }, 0.004, 2) });
    double held = 0.0;
    for (const Trajectory& run : runs)
    {
      for (const StructureEvent& event : run.structures)
      {
        held += event.outcome == StructureOutcome::BarrierStopped ? event.energyTaken : 0.0;
      }
    }
    EXPECT_GT(held, 0.0) << gap;
    EXPECT_LE(held, 250e3) << gap;
  }
}

/// A rock that comes obliquely is nearer to the net, and later there.
TEST(BrokenStructures, WhoComesFirstMeetsANetFirst)
{
  Structures s = net(300e3);
  s.barriers[0].residual = 1.0;
  Rock oblique = thrown(Vec3(2.6, -14.8, 0.0), 0.0043, 0, Vec3(60, 40, 103));
  Rock square = thrown(Vec3(15.0, 0.0, 0.0), 0.0015, 1, Vec3(60, 50, 103));
  for (const bool first : { true, false })
  {
    const std::vector<Trajectory> runs = runTogether(
      s, first ? std::vector<Rock>{ oblique, square } : std::vector<Rock>{ square, oblique });
    EXPECT_EQ(runs[first ? 1 : 0].summary.fate, Fate::Caught);
    EXPECT_EQ(runs[first ? 0 : 1].structures.at(0).outcome, StructureOutcome::BarrierBroken);
  }
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
