// Who may meet whom within a step: what a fast rock strikes goes on at its speed in the same step,
// and must not enter what stands behind it, though neither moved before.

#include "piles.h"

#include <gtest/gtest.h>

#include <span>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kLength = 1.0, kWidth = 0.2; // of a bar, m

/// Bars end to end along x with these gaps, m; the first one moves.
std::vector<Rock> row(double x, double z, std::span<const double> gaps, const Vec3& velocity)
{
  std::vector<Rock> rocks;
  rocks.push_back(brick(Vec3(kLength, kWidth, kWidth), Vec3(x, 20.0, z), 0));
  rocks[0].velocity = velocity;
  for (const double gap : gaps)
  {
    x += kLength + gap;
    rocks.push_back(brick(Vec3(kLength, kWidth, kWidth), Vec3(x, 20.0, z), int(rocks.size())));
  }
  return rocks;
}

/// Impacts are stopped within a hundredth of the smaller radius, and rocks that meet in the corner
/// of a step are seen one short step later.
constexpr double kAllowed = 0.015 * 0.52;

} // namespace

TEST(IslandFinder, StruckRockDoesNotEnterTheNextOne)
{
  // 0.1 m in a step of 5 ms; bars of which bounding spheres are 10 mm apart and more.
  for (const double first : { 0.001, 0.03, 0.07 })
  {
    Pile pile;
    pile.ground = abyss();
    pile.parameters.gravity = 0.0;
    pile.parameters.timeStep = 0.005;
    pile.parameters.rockRestitution = 1.0;
    const double gaps[] = { first, 0.05, 0.05, 0.05, 0.2 };
    pile.rocks = row(20.0, 0.0, gaps, Vec3(20.0, 0.0, 0.0));
    pile.start();
    double last = 0.0;
    for (int step = 0; step < 10; ++step)
    {
      pile.fall->advance();
      last = std::max(last, pile.fall->state(4).velocity.x());
      EXPECT_LT(pile.overlap(), kAllowed) << first << " m, step " << step;
    }
    EXPECT_GT(last, 10.0); // it went on so far
  }
}

TEST(IslandFinder, StruckSleepersDoNotEnterTheNextOne)
{
  // A bar comes down in front of others that lie asleep by then, and pushes them along; what lies
  // 3 m off sleeps on.
  Pile pile;
  pile.ground = floorSlope(10.0);
  pile.awake = false;
  pile.parameters.timeStep = 0.005;
  pile.parameters.rockRestitution = 0.8;
  const double gaps[] = { 20.0, 0.05, 0.05, 0.05, 3.0, 0.05 };
  pile.rocks = row(5.0, 0.5 * kWidth, gaps, Vec3(20.0, 0.0, 4.9));
  pile.rocks[0].position.z() += 0.02;
  pile.start();
  double deepest = 0.0;
  bool struck = false;
  std::vector<Vec3> lay;
  for (int step = 0; step < 210; ++step)
  {
    pile.fall->advance();
    deepest = std::max(deepest, pile.overlap());
    if (step == 179)
    {
      lay = pile.places();
    }
    else if (step == 180)
    {
      for (std::size_t i = 1; i < lay.size(); ++i)
      {
        EXPECT_EQ(pile.places()[i], lay[i]) << i; // asleep
      }
    }
    struck = struck || pile.fall->state(4).velocity.x() > 1.0;
  }
  EXPECT_TRUE(struck);
  EXPECT_LT(deepest, kAllowed);
  for (std::size_t i : { 5, 6 })
  {
    EXPECT_EQ(pile.places()[i], lay[i]) << i;
  }
}

TEST(IslandFinder, FieldOfSleepersIsNotWokenByOneRock)
{
  // Gaps of 30 mm have to be crossed one after the other: a row is not one group.
  Pile pile;
  pile.ground = abyss();
  pile.parameters.gravity = 0.0;
  pile.parameters.timeStep = 0.005;
  pile.parameters.rockRestitution = 0.9;
  const std::vector<double> gaps(12, 0.03);
  pile.rocks = row(20.0, 0.0, gaps, Vec3(20.0, 0.0, 0.0));
  pile.start();
  pile.fall->advance();
  int linked = 0;
  for (const RockPair* pair : pile.fall->pairs())
  {
    linked += pair->linked;
  }
  EXPECT_GE(linked, 3); // 0.1 m
  EXPECT_LE(linked, 5);
}

TEST(IslandFinder, WhoTouchesNoneOfAGroupBouncesAsAlone)
{
  // Cubes 60 mm apart may meet in any step in which one of them strikes the floor, and never do.
  constexpr int count = 5;
  const auto fall = [](double apart)
  {
    Pile pile;
    pile.ground = makeSlope(
      41, 5.0, [](double, double) { return 0.0; }, material(0.5, 20.0));
    pile.parameters.rockRestitution = 0.8;
    for (int k = 0; k < count; ++k)
    {
      Rock rock = brick(Vec3(1, 1, 1), Vec3(50.0 + apart * k, 100.0, 0.8 + 0.1 * k), k);
      rock.velocity = Vec3(0.0, 3.0, -4.0);
      pile.rocks.push_back(rock);
    }
    pile.start();
    pile.run(0.6);
    std::vector<Vec3> places = pile.places();
    for (int k = 0; k < count; ++k)
    {
      EXPECT_GE(pile.fall->rock(k).trajectory().impacts.size(), 1u);
      for (const ImpactEvent& event : pile.fall->rock(k).trajectory().impacts)
      {
        EXPECT_EQ(event.otherRock, -1);
      }
      places[std::size_t(k)].x() -= apart * k;
    }
    return places;
  };
  const std::vector<Vec3> near = fall(1.06), far = fall(20.0);
  for (int k = 0; k < count; ++k)
  {
    EXPECT_LT((near[std::size_t(k)] - far[std::size_t(k)]).norm(), 2e-3) << k; // of 1.5 m
  }
}

TEST(IslandFinder, WhatMeetsNoOtherFallsAsWithoutCollisions)
{
  // Not bit for bit, as the steps of an impact are cut where those of the fall end, but no way is
  // longer or shorter for it: also at the lowest stiffness of rock and in steps that resolve its
  // vibration. Whether a block rings in its impacts is a question of the block.
  Roughness roughness;
  roughness.deviation = 0.1;
  const Terrain slope = makeSlope(
    41, 5.0,
    [](double x, double) { return x < 100.0 ? 120.0 - 0.6 * x : 60.0 + 0.2 * (x - 100.0); },
    material(0.8, 20.0), roughness);
  std::vector<Rock> rocks;
  for (int k = 0; k < 5; ++k)
  {
    Rock rock = brick(Vec3(1.1, 0.8, 0.5 + 0.1 * k), Vec3(20.0, 20.0 + 40.0 * k, 112.0), k);
    rock.youngModulus = 1e9;
    rocks.push_back(rock);
  }
  SimulationParameters p;
  p.timeStep = 0.001;
  p.iterations = 6;
  TrajectoryStore apart(5, p.iterations), together(5, p.iterations);
  runEnsemble(slope, rocks, p, apart);
  p.rockRockContact = true;
  runEnsemble(slope, rocks, p, together);
  double sum = 0.0, squares = 0.0;
  const std::size_t n = apart.trajectories().size();
  for (std::size_t i = 0; i < n; ++i)
  {
    const TrajectorySummary& a = apart.trajectories()[i].summary;
    const TrajectorySummary& b = together.trajectories()[i].summary;
    EXPECT_EQ(a.energy.vibration, 0.0);
    EXPECT_EQ(b.energy.exchanged, 0.0) << "met another one";
    const double longer = b.stop.x() - a.stop.x();
    sum += longer;
    squares += longer * longer;
  }
  const double mean = sum / double(n);
  const double error = std::sqrt((squares / double(n) - mean * mean) / double(n));
  EXPECT_LT(std::abs(mean), 3.0 * error);
  EXPECT_LT(error, 1.0); // of ways of 100 m
}

TEST(IslandFinder, WhatLosesItsSupportFalls)
{
  // A cube at rest on a slab that slides away under it without friction, until the slab leaves the
  // slope or is caught.
  for (const bool caught : { false, true })
  {
    for (const double speed : { 1.0, 2.0, 4.0 })
    {
      const double end = caught ? 30.0 : 40.0;
      Pile pile;
      pile.ground = floorSlope(0.0);
      if (caught)
      {
        Structures s;
        Barrier barrier;
        barrier.points = { { end, 5.0 }, { end, 35.0 } };
        barrier.height = 4.0;
        s.barriers.push_back(barrier);
        pile.ground.setStructures(s);
      }
      const double x =
        end - 0.96 * speed; // gone after 0.96 s, when the cube has been still for long
      pile.rocks = { brick(Vec3(6.0, 2.0, 0.5), Vec3(x, 20.0, 0.25), 0),
        brick(Vec3(1.0, 1.0, 1.0), Vec3(std::min(x + 2.0, end - 2.4), 20.0, 1.0), 1) };
      pile.rocks[0].velocity = Vec3(speed, 0.0, 0.0);
      pile.parameters.rockFrictionAngle = 0.0;
      pile.parameters.endTime = 6.0;
      pile.awake = false;
      pile.start();
      pile.run(6.0);
      EXPECT_NEAR(pile.fall->state(1).position.z(), 0.5, 0.02) << speed << " m/s, " << caught;
    }
  }
}

TEST(IslandFinder, WhatLiesOnAStruckPillarFalls)
{
  // A beam on two pillars, awake as something spins on one of them, which is struck out: by the
  // next step the beam is on its own, and has not gone far as yet.
  for (const double timeStep : { 0.005, 0.002 })
  {
    Pile pile;
    pile.ground = makeSlope(
      21, 5.0, [](double, double) { return 0.0; }, material(0.3, 0.0));
    pile.rocks = { brick(Vec3(1.0, 1.0, 1.0), Vec3(48.5, 50.0, 0.5), 0),
      brick(Vec3(2.0, 1.0, 1.0), Vec3(52.0, 50.0, 0.5), 1),
      brick(Vec3(4.0, 0.2, 0.5), Vec3(50.0, 50.0, 1.25), 2),
      brick(Vec3(0.3, 0.3, 0.3), Vec3(52.7, 50.0, 1.15), 3),
      brick(Vec3(1.0, 1.0, 1.0), Vec3(52.0, 29.0, 0.5), 4) };
    pile.rocks[3].angularVelocity = Vec3(0.0, 0.0, 6.0);
    pile.rocks[4].velocity = Vec3(0.0, 28.0, 0.0); // there after 0.72 s
    pile.parameters.rockFrictionAngle = 0.0;
    pile.parameters.rockRestitution = 1.0;
    pile.parameters.timeStep = timeStep;
    pile.parameters.endTime = 5.0;
    pile.awake = false;
    pile.start();
    pile.run(5.0);
    EXPECT_LT(pile.fall->state(2).position.z(), 0.3) << timeStep; // 1.25 m on the pillars
  }
}

TEST(IslandFinder, WhatLeantOnACaughtBoulderSlides)
{
  // A cube on an incline on which it slides, held by a boulder at its foot; the boulder, on which
  // something spins, is struck over the line of a barrier and caught. The cube, alone then, has not
  // come to rest by how long it was still before.
  const double slope = radians(18.0), strikes = 1.2;
  Pile pile;
  pile.ground = makeSlope(
    41, 2.5, [&](double x, double) { return 100.0 + std::max(0.0, std::tan(slope) * (50.0 - x)); },
    material(0.3, 15.0));
  Structures s;
  Barrier barrier;
  barrier.points = { { 49.9, 50.003 }, { 60.0, 50.003 } }; // before both sides of the boulder
  barrier.height = 10.0;
  s.barriers.push_back(barrier);
  pile.ground.setStructures(s);
  Rock cube = brick(Vec3(1.0, 1.0, 1.0), Vec3::Zero(), 0);
  cube.orientation = Quat(Eigen::AngleAxisd(slope, Vec3::UnitY()));
  const Vec3 top = cube.orientation * Vec3(0.5, 0.0, 0.5);
  const Vec3 foot = cube.orientation * Vec3(0.5, 0.0, -0.5);
  const double x = 50.0 - top.x() - 1e-4; // its upper edge at the boulder
  cube.position =
    Vec3(x, 50.0, 100.0 + std::tan(slope) * (50.0 - (x + foot.x())) - foot.z() + 1e-5);
  pile.rocks = { cube, brick(Vec3(2.0, 2.0, 2.0), Vec3(51.0, 50.0, 101.0), 1),
    brick(Vec3(0.5, 0.5, 0.5), Vec3(51.0, 50.0, 102.25), 2),
    brick(Vec3(1.6, 2.0, 2.0), Vec3(51.0, 48.0 - 20.0 * strikes, 101.03), 3) };
  pile.rocks[2].angularVelocity = Vec3(0.0, 0.0, 4.0);
  pile.rocks[3].velocity = Vec3(0.0, 20.0, 0.5 * kGravity * strikes);
  pile.parameters.rockFrictionAngle = 0.0;
  pile.parameters.timeStep = 0.002;
  pile.parameters.endTime = 5.0;
  pile.awake = false;
  pile.start();
  pile.run(strikes + 0.01);
  ASSERT_EQ(pile.fall->rock(1).trajectory().summary.fate, Fate::Caught);
  const Vec3 held = pile.fall->state(0).position;
  pile.run(4.0);
  EXPECT_GT((pile.fall->state(0).position - held).norm(), 0.1);
}
