// Rocks that are in each other at the start: named, pushed apart, kept from it.

#include "base/errors.h"
#include "rock/placement.h"
#include "run/overlaps.h"
#include "slopes.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

Rock cubeAt(const Vec3& place, std::int64_t id, double volume = 1.0)
{
  Rock rock;
  rock.blockId = id;
  rock.shape = makeShape(Shape::Cube, volume);
  rock.position = place;
  return rock;
}

Terrain flat()
{
  return makeSlope(
    41, 1.0, [](double, double) { return 0.0; }, material(0.3, 35.0));
}

SimulationParameters together()
{
  SimulationParameters p;
  p.rockRockContact = true;
  p.endTime = 0.1;
  return p;
}

void expectRefused(const Terrain& terrain, const std::vector<Rock>& rocks,
  const SimulationParameters& parameters, const std::vector<std::string>& words)
{
  try
  {
    TrajectoryStore store;
    runEnsemble(terrain, rocks, parameters, store);
    ADD_FAILURE() << "no error with " << words.front();
  }
  catch (const PlacementError& error)
  {
    for (const std::string& word : words)
    {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
        << word << " is not in: " << error.what();
    }
  }
}

/// Thirty rocks of several shapes and sizes thrown into a small space over the ground.
std::vector<Rock> heap(const Terrain& ground)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(18.0, 22.0), unit(0.0, 1.0);
  std::vector<Rock> rocks;
  for (int i = 0; i < 30; ++i)
  {
    Rock rock;
    rock.blockId = i;
    rock.shape = makeShape(i % 2 ? Shape::Cube : Shape::Icosahedron, 0.1 + 1.5 * unit(random));
    const double u = unit(random), v = unit(random);
    rock.orientation = randomRotation(u, v, unit(random));
    const double x = place(random), y = place(random);
    rock.position = Vec3(x, y,
      touchingHeight(Surface::asSurveyed(ground), rock.shape, rock.orientation, x, y) +
        unit(random));
    rocks.push_back(rock);
  }
  return rocks;
}

} // namespace

TEST(Overlaps, NamedWithTheDepth)
{
  std::vector<Rock> rocks = { cubeAt({ 20.0, 20.0, 0.5 }, 3), cubeAt({ 20.7, 20.1, 0.5 }, 7),
    cubeAt({ 20.0, 20.9, 0.5 }, 8) };
  expectRefused(flat(), rocks, together(),
    { "block 3 at (20,", "block 7 at (20.7,", "overlap at the start, by 0.3", "2 other pairs",
      "PushRocksApart" });
  // Face to face is no overlap; without rock-rock contact nothing is asked.
  EXPECT_TRUE(
    findOverlaps(std::vector{ cubeAt({ 1.0, 1.0, 0.5 }, 0), cubeAt({ 2.0, 1.5, 0.5 }, 1) })
      .empty());
  SimulationParameters alone = together();
  alone.rockRockContact = false;
  TrajectoryStore store;
  EXPECT_TRUE(runEnsemble(flat(), rocks, alone, store));
}

TEST(Overlaps, TheSameRockTwice)
{
  std::vector<Rock> rocks = { cubeAt({ 20.0, 20.0, 0.5 }, 1), cubeAt({ 5.0, 5.0, 0.5 }, 2),
    cubeAt({ 20.0, 20.0, 0.5 }, 9) };
  SimulationParameters p = together();
  for (const bool push : { false, true })
  {
    p.pushRocksApart = push;
    expectRefused(flat(), rocks, p, { "block 1 at (20, 20, 0.5) and block 9", "same rock twice" });
  }
  // Another size at the same place is another rock.
  rocks[2] = cubeAt({ 20.0, 20.0, 0.5 }, 9, 0.5);
  p.pushRocksApart = false;
  expectRefused(flat(), rocks, p, { "overlap at the start" });
  p.pushRocksApart = true;
  TrajectoryStore store;
  EXPECT_TRUE(runEnsemble(flat(), rocks, p, store));
}

TEST(Overlaps, ThoseOfAnIterationAreNamed)
{
  // Given apart, drawn 5 m about: some iteration has them in each other.
  std::vector<Rock> rocks;
  for (int i = 0; i < 12; ++i)
  {
    rocks.push_back(cubeAt({ 14.0 + i, 20.0, 0.5 }, i));
    rocks.back().uncertainty.horizontalDeviation = 5.0;
  }
  SimulationParameters p = together();
  p.iterations = 4;
  expectRefused(flat(), rocks, p, { "overlap at the start in iteration " });
  p.pushRocksApart = true;
  TrajectoryStore store;
  EXPECT_TRUE(runEnsemble(flat(), rocks, p, store));
}

TEST(Overlaps, PushedApart)
{
  const Terrain ground = makeSlope(
    41, 1.0, [](double x, double y) { return 0.3 * x + 0.5 * std::sin(y); }, material(0.3, 35.0));
  const std::vector<Rock> given = heap(ground);
  ASSERT_GT(findOverlaps(given).size(), 20u);
  std::vector<Rock> rocks = given;
  const PushedApart done = pushApart(ground, rocks);
  EXPECT_TRUE(findOverlaps(rocks).empty());
  EXPECT_GT(done.rocks, 20);
  double farthest = 0.0;
  std::int64_t moved = 0;
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    const double way = (rocks[i].position - given[i].position).norm();
    farthest = std::max(farthest, way);
    moved += way > 0.0;
    const double height = touchingHeight(Surface::asSurveyed(ground), rocks[i].shape,
      rocks[i].orientation, rocks[i].position.x(), rocks[i].position.y());
    EXPECT_GE(rocks[i].position.z(), height - 1e-9) << i; // rounding of that height
  }
  EXPECT_EQ(done.farthest, farthest);
  EXPECT_EQ(done.rocks, moved);
  // Thirty rocks of up to 1.4 m in 16 m²: none needs to leave that by far.
  EXPECT_LT(farthest, 4.0);
  std::vector<Rock> again = given;
  pushApart(ground, again);
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    EXPECT_EQ(again[i].position, rocks[i].position);
  }
  // Rocks that are not concerned do not move.
  std::vector<Rock> apart = { cubeAt({ 10.0, 20.0, 9.0 }, 0), cubeAt({ 15.0, 20.0, 9.0 }, 1) };
  EXPECT_EQ(pushApart(ground, apart).rocks, 0);
  // The heavy one moves less, as masses are.
  std::vector<Rock> two = { cubeAt({ 10.0, 20.0, 9.0 }, 0, 8.0), cubeAt({ 11.0, 20.1, 9.0 }, 1) };
  pushApart(ground, two);
  EXPECT_NEAR((two[1].position.x() - 11.0) / (10.0 - two[0].position.x()), 8.0, 1e-9);
}

TEST(Overlaps, TheRunStartsWhereTheyWerePushed)
{
  const Terrain ground = flat();
  std::vector<Rock> rocks = heap(ground), pushed = rocks;
  pushApart(ground, pushed);
  SimulationParameters p = together();
  p.pushRocksApart = true;
  p.endTime = 0.05;
  TrajectoryStore store;
  ASSERT_TRUE(runEnsemble(ground, rocks, p, store));
  const Ensemble ensemble(ground, rocks, p);
  EXPECT_GT(ensemble.pushed().rocks, 20);
  EXPECT_EQ(ensemble.pushed().iterations, 1);
  EXPECT_FALSE(ensemble.pushesAnew());
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    EXPECT_EQ(store.trajectories()[i].samples.front().position, pushed[i].position) << i;
  }
}

TEST(Overlaps, WhatWasPushedInAnyIterationIsTold)
{
  // Four rocks 4 m from each other, drawn 2 m about: few iterations have them in each other.
  std::vector<Rock> rocks;
  for (int i = 0; i < 4; ++i)
  {
    rocks.push_back(cubeAt({ 14.0 + 4.0 * i, 20.0, 0.5 }, i));
    rocks.back().uncertainty.horizontalDeviation = 2.0;
  }
  SimulationParameters p = together();
  p.pushRocksApart = true;
  p.iterations = 24;
  PushedApart expected;
  for (int iteration = 0; iteration < p.iterations; ++iteration)
  {
    std::vector<Rock> drawn;
    for (std::size_t i = 0; i < rocks.size(); ++i)
    {
      drawn.push_back(realise(flat(), rocks[i], p.seed, iteration, i));
    }
    const PushedApart done = pushApart(flat(), drawn);
    EXPECT_EQ(done.iterations, done.rocks > 0 ? 1 : 0);
    expected.add(done);
  }
  ASSERT_GT(expected.iterations, 0);
  ASSERT_LT(expected.iterations, p.iterations);
  for (const int threads : { 1, 3 })
  {
    p.threads = threads;
    const Terrain ground = flat();
    const Ensemble ensemble(ground, rocks, p);
    EXPECT_TRUE(ensemble.pushesAnew());
    EXPECT_EQ(ensemble.pushed().iterations, 0); // not known yet
    TrajectoryStore store;
    ASSERT_TRUE(ensemble.run(ensemble.whole(), store));
    const PushedApart told = ensemble.pushed();
    EXPECT_EQ(told.iterations, expected.iterations);
    EXPECT_EQ(told.rocks, expected.rocks);
    EXPECT_EQ(told.farthest, expected.farthest);
    EXPECT_EQ(told.passes, expected.passes);
  }
}

TEST(Overlaps, OffTheSlope)
{
  std::vector<Rock> rocks = { cubeAt({ 0.1, 20.0, 0.5 }, 0), cubeAt({ 0.3, 20.0, 0.5 }, 1) };
  SimulationParameters p = together();
  p.pushRocksApart = true;
  expectRefused(flat(), rocks, p, { "PushRocksApart", "block 0", "off the slope" });
}

TEST(Overlaps, PlacerSeesWhatFindOverlapsSees)
{
  const std::vector<Rock> rocks = heap(flat());
  std::vector<Rock> placed;
  double largest = 0.0;
  for (const Rock& rock : rocks)
  {
    largest = std::max(largest, rock.shape.radius());
  }
  ApartPlacer placer(largest);
  for (const Rock& rock : rocks)
  {
    std::vector<Rock> with = placed;
    with.push_back(rock);
    const bool apart = findOverlaps(with).empty();
    EXPECT_EQ(placer.fits(rock), apart);
    if (apart)
    {
      placer.add(rock);
      placed.push_back(rock);
    }
  }
  EXPECT_GT(placed.size(), 5u);
  EXPECT_LT(placed.size(), rocks.size());
  // Attitudes that are still to be drawn need the whole sphere.
  ApartPlacer turning(2.0);
  turning.add(cubeAt({ 0.0, 0.0, 0.0 }, 0));
  Rock beside = cubeAt({ 1.2, 0.0, 0.0 }, 1);
  EXPECT_TRUE(turning.fits(beside));
  beside.uncertainty.attitude = AttitudeLaw::Random;
  EXPECT_FALSE(turning.fits(beside));
  beside.position.x() = 1.75; // √3
  EXPECT_TRUE(turning.fits(beside));
}

TEST(Overlaps, WhatTheGroundAndOthersHoldIsNotPushedInVain)
{
  const Terrain ground = flat();
  const auto pushed = [&](std::vector<Rock>& rocks)
  {
    const PushedApart done = pushApart(ground, rocks);
    EXPECT_TRUE(findOverlaps(rocks).empty());
    EXPECT_LT(done.passes, 200);
    return done.farthest;
  };
  // A stone of 10 cm under a cube of 10 m, half and wholly in it: the ground holds the stone, so
  // that the cube goes up; no farther than the push beyond the depth.
  for (const double height : { 5.05, 5.0 })
  {
    const double depth = 5.1 - height;
    std::vector<Rock> rocks = { cubeAt({ 20.0, 20.0, height }, 0, 1000.0),
      cubeAt({ 20.0, 20.0, 0.05 }, 1, 1e-3) };
    EXPECT_LE(pushed(rocks), 1.1 * depth + 1e-9);
    EXPECT_GE(rocks[0].position.z(), 5.1 - 1e-5);
  }
  // The same stone between two such cubes, whose gap is too narrow for it.
  std::vector<Rock> between = { cubeAt({ 14.96, 20.0, 5.0 }, 0, 1000.0),
    cubeAt({ 25.04, 20.0, 5.0 }, 1, 1000.0), cubeAt({ 20.0, 20.0, 0.05 }, 2, 1e-3) };
  EXPECT_LT(pushed(between), 0.02);
  // Columns that stand in the ground's way: each goes up on the one below.
  for (const double step : { 0.9, 0.5, 0.2 })
  {
    std::vector<Rock> column;
    for (int k = 0; k < 30; ++k)
    {
      column.push_back(cubeAt({ 20.0, 20.0, 0.5 + step * k }, k));
    }
    pushed(column);
  }
}
