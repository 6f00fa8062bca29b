// Barriers catch exactly what is below their height and capacity, whatever Δt and output interval.

#include "form.h"
#include "rigidFor.h"
#include "slopes.h"
#include "terrain/Obstacles.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// Level ground at 100 m with a barrier across x = 60 m, in two pieces.
Terrain withBarrier(double height, double capacity, bool records = false, bool absorbs = true)
{
  Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  Structures s;
  Barrier b;
  b.feature = 3;
  b.points = { { 60.0, 20.0 }, { 60.0, 50.0 }, { 60.0, 80.0 } };
  b.height = height;
  b.capacity = capacity;
  b.records = records;
  b.absorbs = absorbs;
  s.barriers = { b };
  terrain.setStructures(s);
  return terrain;
}

/// A cube of 2.5 t, thrown level at `speed` from `up` over ground, 10 m before the barrier.
Rock thrown(double up, double speed)
{
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.position = Vec3(50.0, 50.0, 100.0 + up); // through the joint of the two pieces
  rock.velocity = Vec3(speed, 0.0, 0.0);
  return rock;
}

} // namespace

TEST(Barriers, CatchWhatIsBelowHeightAndCapacity)
{
  const double speed = 20.0, fallen = 0.5 * kGravity * 0.25; // 0.5 s to the barrier
  const double energy = 0.5 * 2500.0 * speed * speed + 2500.0 * kGravity * fallen;
  const double crossing = 6.0 - fallen;
  const double top = crossing + 0.5;
  for (const double height : { top - 1e-6, top + 1e-6 })
  {
    for (const double capacity : { energy * (1.0 - 1e-9), energy * (1.0 + 1e-9) })
    {
      const Trajectory t =
        simulate(withBarrier(height, capacity), thrown(6.0, speed), rigidFor(0.6));
      if (height < top)
      {
        ASSERT_EQ(t.structures.size(), 1u);
        EXPECT_EQ(t.structures[0].outcome, StructureOutcome::BarrierStruck);
        EXPECT_NEAR(t.structures[0].topHeight, top, 1e-9);
        EXPECT_NEAR(t.summary.stop.x(), 62.0, 1e-9);
        continue;
      }
      ASSERT_EQ(t.structures.size(), 1u);
      const StructureEvent& event = t.structures[0];
      EXPECT_EQ(event.feature, 3);
      EXPECT_NEAR(event.time, 0.5, 1e-9);
      EXPECT_NEAR(event.heightOverGround, crossing, 1e-9);
      EXPECT_NEAR(event.topHeight, top, 1e-9);
      EXPECT_NEAR(event.kineticEnergy, energy, 1e-9 * energy);
      EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-9 * energy);
      if (energy < capacity)
      {
        EXPECT_EQ(event.outcome, StructureOutcome::BarrierStopped);
        EXPECT_EQ(t.summary.fate, Fate::Caught);
        EXPECT_NEAR(t.summary.stop.x(), 60.0, 1e-9);
        EXPECT_NEAR(t.summary.endTime, 0.5, 1e-9);
        EXPECT_NEAR(t.summary.energy.structures, energy, 1e-9 * energy);
        EXPECT_NEAR(t.samples.back().kineticEnergy, energy, 1e-9 * energy); // as it came
      }
      else
      {
        EXPECT_EQ(event.outcome, StructureOutcome::BarrierBroken);
        EXPECT_EQ(t.summary.fate, Fate::Moving);
        EXPECT_LT(t.summary.stop.x(), 60.01); // next to nothing is left
      }
    }
  }
}

TEST(Barriers, TakeTheirCapacityFromWhatBreaksThem)
{
  const double speed = 20.0, capacity = 3e5;
  for (const bool absorbs : { true, false })
  {
    const Trajectory t =
      simulate(withBarrier(8.0, capacity, false, absorbs), thrown(6.0, speed), rigidFor(0.7));
    ASSERT_EQ(t.structures.size(), 1u);
    const double energy = t.structures[0].kineticEnergy;
    const double left = absorbs ? std::sqrt(1.0 - capacity / energy) : 1.0;
    EXPECT_NEAR(t.structures[0].energyTaken, absorbs ? capacity : 0.0, 1e-6);
    EXPECT_NEAR(t.summary.stop.x(), 60.0 + 0.2 * speed * left, 1e-6);
    EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-9 * energy);
  }
}

TEST(Barriers, BrakeOnAWayBehindTheLine)
{
  constexpr double capacity = 1e6, braking = 5.0, tilt = 0.3, speed = 20.0;
  const auto fall = [&](double way, double endTime)
  {
    Terrain terrain = makePlane(21, 100.0, std::atan(tilt), 0.0, material(0.5, 20.0));
    Structures s = withBarrier(30.0, capacity).obstacles()->structures();
    s.barriers[0].braking = way;
    terrain.setStructures(s);
    return simulate(terrain, thrown(6.0, speed), rigidFor(endTime));
  };
  const Trajectory bare = fall(0.0, 5.0), held = fall(braking, 5.0);
  ASSERT_EQ(held.structures.size(), 1u);
  const StructureEvent &at = bare.structures[0], &event = held.structures[0];
  EXPECT_EQ(held.summary.fate, Fate::Caught);
  EXPECT_EQ(event.position, at.position); // met as before
  EXPECT_EQ(event.energyTaken, at.energyTaken);
  EXPECT_EQ(bare.summary.stop, at.position);

  // Down the ground, as far as the brakes pull out, and at rest there.
  const double way = braking * std::sqrt(at.kineticEnergy / capacity);
  EXPECT_NEAR(event.brakingDistance, way, 1e-12);
  const Vec3 along = Vec3(1.0, 0.0, -tilt).normalized();
  EXPECT_LT((held.summary.stop - at.position - way * along).norm(), 1e-9);
  EXPECT_EQ(held.samples.back().kineticEnergy, 0.0);
  EXPECT_NEAR(
    held.summary.endTime - at.time, 0.5 * std::numbers::pi * way / at.velocity.norm(), 1e-9);

  double last = at.kineticEnergy;
  int behind = 0;
  for (const Sample& sample : held.samples)
  {
    EXPECT_LT(std::abs(sample.energy.numerical), 1e-9 * at.kineticEnergy) << sample.time;
    if (sample.time > at.time + 1e-6)
    {
      ++behind;
      EXPECT_LT(sample.kineticEnergy, last);
      last = sample.kineticEnergy;
      // The speed of a spring: v √(1 − (x/b)²).
      const double x = (sample.position - at.position).dot(along) / way;
      EXPECT_NEAR(sample.velocity.squaredNorm() / at.velocity.squaredNorm(), 1.0 - x * x, 0.01);
    }
  }
  EXPECT_GT(behind, 4);

  // Where the way does not end in time the rock stays at the line.
  EXPECT_EQ(fall(braking, at.time + 0.01).summary.stop, at.position);
}

// The last of 120 equal parts of a way is beyond the whole, as rounded, for some 3 in 100 ways.
TEST(Barriers, EveryBrakedRockComesToRestSomewhere)
{
  Terrain terrain = makePlane(21, 100.0, 0.1, 0.0, material(0.5, 20.0));
  Structures s = withBarrier(30.0, 1e6).obstacles()->structures();
  s.barriers[0].braking = 5.0;
  terrain.setStructures(s);
  for (int k = 0; k < 200; ++k)
  {
    const double speed = 10.0 + 0.05 * k;
    const Trajectory t = simulate(terrain, thrown(6.0, speed), rigidFor(5.0));
    ASSERT_EQ(t.summary.fate, Fate::Caught) << speed;
    EXPECT_TRUE(t.summary.stop.allFinite() && std::isfinite(t.summary.endTime)) << speed;
    EXPECT_NEAR(
      (t.summary.stop - t.structures[0].position).norm(), t.structures[0].brakingDistance, 1e-9)
      << speed;
  }
}

TEST(Barriers, RecordWithoutAnyEffect)
{
  Trajectory bare =
    simulate(makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0)), thrown(6.0, 15.0), rigidFor(8.0));
  const Trajectory t = simulate(withBarrier(8.0, 0.0, true), thrown(6.0, 15.0), rigidFor(8.0));
  ASSERT_EQ(t.structures.size(), 1u);
  EXPECT_EQ(t.structures[0].outcome, StructureOutcome::BarrierRecorded);
  EXPECT_EQ(t.structures[0].energyTaken, 0.0);
  EXPECT_EQ(t.summary.stop, bare.summary.stop);
  EXPECT_EQ(t.summary.contactSteps, bare.summary.contactSteps);
}

/// A cube that slides into it, on level ground: v² = v₀² − 2 g tan φ x.
TEST(Barriers, CountWhatATouchHolds)
{
  // Flat on level ground within 2 mm of way: what falls is held by the springs for a moment, and a
  // net there must take it all the same.
  Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.9, 0.0));
  Structures s;
  for (int k = 0; k < 300; ++k)
  {
    Barrier b;
    b.feature = k;
    b.points = { { 61.0 + 0.001 * k, 20.0 }, { 61.0 + 0.001 * k, 80.0 } };
    b.height = 3.0;
    b.capacity = 1e9;
    b.records = true;
    s.barriers.push_back(b);
  }
  terrain.setStructures(s);
  const Trajectory t = simulate(terrain, thrown(2.0, 20.0), rigidFor(0.6));
  ASSERT_EQ(t.structures.size(), 300u);
  const double before = t.structures.front().kineticEnergy;
  const double after = t.structures.back().kineticEnergy;
  EXPECT_LT(after, before - 5e3);
  for (const StructureEvent& event : t.structures)
  {
    EXPECT_GT(event.kineticEnergy, after - 1e-3 * before) << event.feature;
    EXPECT_LT(event.kineticEnergy, before + 2e-3 * before) << event.feature;
  }
}

TEST(Barriers, WhatTheyCatchInTheMiddleOfAnImpactHasHadOne)
{
  // The rock comes down on its face just before the barrier; the impact takes some 2.5 ms.
  const double speed = 20.0, fallen = 0.5 * kGravity * 0.25;
  for (const double before : { 0.0005, 0.001, 0.002 })
  {
    Rock rock = thrown(0.5 + fallen, speed);
    rock.position.x() -= before * speed; // the barrier comes that much later than the ground
    const Trajectory t = simulate(withBarrier(8.0, 1e9), rock, rigidFor(1.0));
    EXPECT_EQ(t.summary.fate, Fate::Caught);
    EXPECT_EQ(t.summary.impacts, 1) << before;
    ASSERT_EQ(t.impacts.size(), 1u) << before;
    EXPECT_NEAR(t.impacts[0].approachSpeed, 0.5 * kGravity, 0.01);
    EXPECT_NEAR(t.summary.stop.x(), 60.0, 1e-6);
  }
}

TEST(Barriers, CatchAtOnceWhatStartsBeforeThem)
{
  // A path is a line all the same.
  Rock rock = thrown(2.0, 5.0);
  rock.position.x() = 60.0 - 2e-6;
  const Trajectory t = simulate(withBarrier(5.0, 1e9), rock, rigidFor(1.0));
  EXPECT_EQ(t.summary.fate, Fate::Caught);
  ASSERT_EQ(t.samples.size(), 2u);
  EXPECT_GT(t.samples[1].time, t.samples[0].time);
  EXPECT_NEAR(t.samples[1].time, 4e-7, 1e-8);
  EXPECT_EQ(t.samples[1].kind, SampleKind::End);
}

TEST(Barriers, CatchWhatSlides)
{
  for (const double dt : { 0.005, 0.0013 })
  {
    for (const double interval : { 0.05, 0.5 })
    {
      SimulationParameters p = rigidFor(10.0);
      p.timeStep = dt;
      p.outputInterval = interval;
      const double speed = 12.0;
      const double energy =
        1250.0 * (speed * speed - 2.0 * kGravity * std::tan(radians(20.0)) * 10.0);
      const Trajectory t = simulate(withBarrier(1.01, 1.01 * energy), thrown(0.5, speed), p);
      ASSERT_EQ(t.summary.fate, Fate::Caught);
      EXPECT_NEAR(t.summary.stop.x(), 60.0, 1e-6);
      EXPECT_NEAR(t.structures[0].kineticEnergy, energy, 5e-3 * energy); // METHOD 9.2: 1 %
      EXPECT_NEAR(t.summary.energy.structures, energy, 5e-3 * energy);
      EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-3 * energy);
      // Lower than its top, or with less capacity, it does not.
      EXPECT_EQ(simulate(withBarrier(0.99, 1.01 * energy), thrown(0.5, speed), p).summary.fate,
        Fate::Rested);
      EXPECT_EQ(simulate(withBarrier(1.01, 0.9 * energy), thrown(0.5, speed), p).summary.fate,
        Fate::Rested);
    }
  }
}

namespace
{

/// Whether nets on level ground, or on a dam, hold a rock, alone and in a mass fall alike.
bool hold(const std::vector<Barrier>& nets, const Rock& rock, const Embankment* dam = nullptr)
{
  Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  Structures s;
  s.barriers = nets;
  if (dam)
  {
    s.embankments = { *dam };
  }
  terrain.setStructures(s);
  bool held[2];
  for (const bool together : { false, true })
  {
    SimulationParameters p = rigidFor(0.6);
    p.rockRockContact = together;
    TrajectoryStore store(1, 1);
    runEnsemble(terrain, std::vector<Rock>{ rock }, p, store);
    held[together] = store.trajectories()[0].summary.fate == Fate::Caught;
  }
  EXPECT_EQ(held[0], held[1]);
  return held[0];
}

Barrier netAcross(const std::vector<Eigen::Vector2d>& points, double height, double overhang)
{
  Barrier net;
  net.points = points;
  net.height = height;
  net.overhang = overhang;
  return net;
}

} // namespace

/// A cube of 1 m comes 0.5 s later with its centre 4.774 m over ground.
TEST(Barriers, HoldNoMoreThanAShareOfTheRockOverTheRope)
{
  const double crossing = 6.0 - 0.5 * kGravity * 0.25;
  for (const double share : { 0.0, 0.25, 0.5 })
  {
    for (const double tilt : { 0.0, 45.0 })
    {
      Rock rock = thrown(6.0, 20.0);
      rock.orientation = Quat(Eigen::AngleAxisd(radians(tilt), Vec3::UnitY()));
      const double half = tilt > 0.0 ? std::sqrt(0.5) : 0.5;
      const double rope = crossing + half * (1.0 - 2.0 * share);
      for (const double more : { -1e-6, 1e-6 })
      {
        EXPECT_EQ(hold({ netAcross({ { 60.0, 20.0 }, { 60.0, 80.0 } }, rope + more, share) }, rock),
          more > 0.0)
          << share << ' ' << tilt;
      }
    }
  }
}

TEST(Barriers, EndByTheRocksWidth)
{
  for (const double share : { 0.0, 0.25, 0.5 })
  {
    for (const double more : { -1e-6, 1e-6 })
    {
      // The cube spans y = 49.5 to 50.5 m.
      const double end = 50.5 - share + more;
      EXPECT_EQ(
        hold({ netAcross({ { 60.0, 20.0 }, { 60.0, end } }, 9.0, share) }, thrown(6.0, 20.0)),
        more > 0.0)
        << share;
      EXPECT_EQ(hold({ netAcross({ { 60.0, 100.0 - end }, { 60.0, 80.0 } }, 9.0, share) },
                  thrown(6.0, 20.0)),
        more > 0.0)
        << share;
    }
  }
}

/// A rock that is wider than a gap does not go through it, wherever its centre is.
TEST(Barriers, GapsByTheRocksWidth)
{
  for (const double middle : { 49.7, 50.0, 50.3 })
  {
    for (const double half : { 0.15, 0.35, 0.9 })
    {
      for (const double bend : { 0.0, 5.0 }) // m over 30 m
      {
        const std::vector<Barrier> nets = {
          netAcross({ { 60.0 + bend, 20.0 }, { 60.0, middle - half } }, 9.0, 0.0),
          netAcross({ { 60.0, middle + half }, { 60.0 + bend, 80.0 } }, 9.0, 0.0)
        };
        const bool inside = middle - half >= 49.5 && middle + half <= 50.5;
        EXPECT_EQ(hold(nets, thrown(6.0, 20.0)), inside) << middle << ' ' << half << ' ' << bend;
      }
    }
  }
}

TEST(Barriers, WithOnePostAreOne)
{
  for (const double bend : { 0.0, 10.0, -10.0 }) // m over 30 m
  {
    const std::vector<Barrier> nets = { netAcross(
                                          { { 60.0 + bend, 20.0 }, { 60.0, 50.1 } }, 9.0, 0.0),
      netAcross({ { 60.0, 50.1 }, { 60.0 + bend, 80.0 } }, 9.0, 0.0) };
    EXPECT_TRUE(hold(nets, thrown(6.0, 20.0))) << bend;
  }
}

TEST(Barriers, OnACrestStandOnIt)
{
  Embankment dam;
  dam.feature = 1;
  dam.points = { { 60.0, 20.0 }, { 60.0, 80.0 } };
  dam.height = 3.0;
  dam.crestWidth = 2.0;
  dam.mountainSlope = dam.valleySlope = 0.5;
  const double crossing = 6.0 - 0.5 * kGravity * 0.25;
  for (const double more : { -1e-6, 1e-6 })
  {
    const double rope = crossing + 0.5 - dam.height + more; // over the crest
    EXPECT_EQ(
      hold({ netAcross({ { 60.0, 20.0 }, { 60.0, 80.0 } }, rope, 0.0) }, thrown(6.0, 20.0), &dam),
      more > 0.0);
  }
}

/// Rocks of a mass fall as well; what is caught is out of the way of the others.
TEST(Barriers, CatchInMassFalls)
{
  const Terrain terrain = withBarrier(4.0, 1e9);
  std::vector<Rock> rocks;
  for (int k = 0; k < 4; ++k)
  {
    rocks.push_back(thrown(1.2 + 1.3 * (k % 2), 30.0));
    rocks.back().position.x() -= 1.1 * (k / 2);
  }
  SimulationParameters p = rigidFor(6.0);
  p.rockRockContact = true;
  TrajectoryStore store(4, 1);
  runEnsemble(terrain, rocks, p, store);
  for (const Trajectory& t : store.trajectories())
  {
    EXPECT_EQ(t.summary.fate, Fate::Caught) << t.summary.rock;
    EXPECT_NEAR(t.summary.stop.x(), 60.0, 1e-6);
  }
}

/// One barrier that breaks must not hide another one, wherever within the step that stands.
TEST(Barriers, WhatNobodyMeetsLeavesAMassFallAlone)
{
  // What a structure does is the difference between two runs, so it must be none where nothing is
  // met, and where rocks are only recorded.
  std::vector<Rock> rocks(12);
  for (int k = 0; k < 12; ++k)
  {
    rocks[std::size_t(k)].blockId = k;
    rocks[std::size_t(k)].shape = makeShape(Shape::Cube, 0.5);
    rocks[std::size_t(k)].position =
      Vec3(20.0 + k % 3, 48.0 + 1.1 * (k / 3 % 2), 128.0 + 1.2 * (k / 6));
  }
  SimulationParameters p;
  p.endTime = 6.0;
  p.rockRockContact = true;
  const auto endsOn = [&](const std::vector<Barrier>& barriers, const std::vector<Tree>& trees)
  {
    Terrain slope = makePlane(21, 100.0, radians(40.0), 0.0, material(0.4, 20.0));
    Structures s;
    s.barriers = barriers;
    s.trees = trees;
    slope.setStructures(s);
    TrajectoryStore store(12, 1);
    runEnsemble(slope, rocks, p, store);
    std::size_t recorded = 0;
    std::vector<Vec3> ends;
    for (const Trajectory& t : store.trajectories())
    {
      ends.push_back(t.summary.stop);
      recorded += t.structures.size();
    }
    return std::pair(ends, recorded);
  };
  Barrier far, across;
  far.points = { { 95.0, 2.0 }, { 99.0, 2.0 } };
  far.height = across.height = 4.0;
  across.points = { { 27.0, 5.0 }, { 27.0, 95.0 } };
  across.records = true;
  Tree tree;
  tree.position = { 5.0, 5.0 };
  tree.diameter = 0.3;
  tree.height = 10.0;
  const auto alone = endsOn({}, {});
  const auto beside = endsOn({ far, across }, { tree });
  EXPECT_EQ(alone.first, beside.first);
  EXPECT_GT(beside.second, 5u);
}

TEST(Barriers, BehindOneThatBreaksAreMetToo)
{
  for (const bool flies : { false, true })
  {
    for (const double gap : { 0.0, 0.02, 0.1, 0.3 })
    {
      for (int k = 0; k < 12; ++k)
      {
        const double x = 60.0 + 0.013 * k;
        Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 5.0));
        Structures s;
        for (int b = 0; b < 3; ++b)
        {
          Barrier barrier;
          barrier.feature = b;
          barrier.points = { { x + gap * b, 20.0 }, { x + gap * b, 80.0 } };
          barrier.height = 5.0;
          barrier.capacity = b < 2 ? 1e5 : 1e9;
          s.barriers.push_back(barrier);
        }
        terrain.setStructures(s);
        Rock rock = thrown(flies ? 3.0 : 0.5, 20.0);
        SimulationParameters p = rigidFor(3.0);
        p.timeStep = 0.01;
        p.rockRockContact = k % 2;
        const Trajectory t = simulate(terrain, rock, p);
        const std::string at =
          (flies ? "flies, " : "slides, ") + std::to_string(gap) + " m, " + std::to_string(x);
        ASSERT_EQ(t.structures.size(), 3u) << at;
        for (int b = 0; b < 3; ++b)
        {
          EXPECT_EQ(t.structures[std::size_t(b)].feature, b) << at;
        }
        EXPECT_EQ(t.summary.fate, Fate::Caught) << at;
        // What the first two took is no more there for the third one.
        EXPECT_NEAR(t.structures[1].kineticEnergy, t.structures[0].kineticEnergy - 1e5, 0.02 * 5e5)
          << at;
        EXPECT_NEAR(t.structures[2].kineticEnergy, t.structures[0].kineticEnergy - 2e5, 0.02 * 5e5)
          << at;
        EXPECT_LT(std::abs(t.summary.energy.numerical), 0.02 * 5e5) << at;
      }
    }
  }
}

/// Nets on one line are passed at once: each that records does so once, with what the rock comes
/// with, whatever the order of the layer, the points of the lines and whether the other net holds.
TEST(Barriers, OnOneLineAreAllMetOnce)
{
  std::mt19937 random(12);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int held = 0;
  for (int k = 0; k < someOf(400, 80); ++k)
  {
    const bool flies = k % 2 == 0;
    const double x = 60.0 + u(random), angle = 1.2 * u(random);
    const Eigen::Vector2d along(std::sin(angle), std::cos(angle)), middle(x, 50.0);
    // Between other points, either way round.
    const auto line = [&](double off)
    {
      const Eigen::Vector2d m = middle + Eigen::Vector2d(off, 0.0);
      std::vector<Eigen::Vector2d> points{ m - (25.0 + 5.0 * u(random)) * along,
        m + 10.0 * u(random) * along, m + (25.0 + 5.0 * u(random)) * along };
      if (u(random) < 0.0)
      {
        std::reverse(points.begin(), points.end());
      }
      return points;
    };
    enum
    {
      Before,
      On,
      OnToo,
      Behind,
      Net
    };
    std::vector<Barrier> nets(5);
    for (int b = Before; b <= Net; ++b)
    {
      nets[b].feature = b;
      nets[b].points = line(b == Before ? -0.03 : b == Behind ? 0.03 : 0.0);
      nets[b].height = 5.0;
      nets[b].records = b != Net;
    }
    if (k % 3 == 0)
    {
      nets[On].points = nets[Net].points; // the very same
    }
    nets[Net].capacity = 4.9e5 + 2e5 * u(random); // J, about what comes
    std::map<std::int64_t, StructureEvent> first;
    for (int order = 0; order < 3; ++order)
    {
      std::shuffle(nets.begin(), nets.end(), random);
      Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 5.0));
      Structures s;
      s.barriers = nets;
      terrain.setStructures(s);
      SimulationParameters p = rigidFor(1.5);
      p.timeStep = 0.01;
      p.rockRockContact = k % 5 == 0;
      const Trajectory t = simulate(terrain, thrown(flies ? 3.0 : 0.5, 20.0), p);
      std::map<std::int64_t, StructureEvent> met;
      for (const StructureEvent& event : t.structures)
      {
        EXPECT_TRUE(met.emplace(event.feature, event).second) << k << ": twice " << event.feature;
      }
      ASSERT_TRUE(met.count(Net) && met.count(On) && met.count(OnToo) && met.count(Before)) << k;
      const bool holds = met[Net].outcome == StructureOutcome::BarrierStopped;
      held += holds;
      EXPECT_EQ(t.summary.fate == Fate::Caught, holds) << k;
      EXPECT_EQ(met.count(Behind), holds ? 0u : 1u) << k;
      const double energy = met[Net].kineticEnergy;
      for (const int b : { On, OnToo })
      {
        EXPECT_EQ(met[b].outcome, StructureOutcome::BarrierRecorded) << k;
        EXPECT_NEAR(met[b].kineticEnergy, energy, 1e-6 * energy) << k;
        EXPECT_NEAR(met[b].time, met[Net].time, 1e-6) << k;
      }
      EXPECT_LT(met[Before].time, met[Net].time) << k;
      if (!holds)
      {
        const double left = energy - met[Net].energyTaken;
        EXPECT_NEAR(met[Behind].kineticEnergy, left, 0.01 * energy) << k;
        EXPECT_LT(met[Net].time, met[Behind].time) << k;
      }
      for (const auto& [feature, event] : order == 0 ? met : first)
      {
        EXPECT_NEAR(event.kineticEnergy, met[feature].kineticEnergy, 1e-6 * energy) << k;
        EXPECT_NEAR(event.time, met[feature].time, 1e-6) << k;
      }
      first = met;
    }
  }
  EXPECT_GT(held, someOf(200, 30));
  EXPECT_LT(held, someOf(1000, 210));
}
