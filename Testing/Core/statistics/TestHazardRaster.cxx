// Hazard maps against closed forms, against a brute-force walk along the curves, and against
// themselves where the same path is sampled otherwise or shared out otherwise.

#include "hermitePaths.h"

#include "base/errors.h"
#include "statistics/HazardRaster.h"
#include "summarizePassages.h"
#include "terrain/Terrain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

using namespace rockfall;
using namespace rockfall::testing;
using rockfall::testing::g;
using rockfall::testing::hops;
using rockfall::testing::rockPathOf;
using rockfall::testing::wild;

namespace
{

constexpr int energy = int(Hazard::KineticEnergy), speed = int(Hazard::Speed),
              height = int(Hazard::HeightOverGround), rotation = int(Hazard::RotationRate);

std::vector<CellSummary> cellsOf(HazardRaster& raster)
{
  std::vector<CellSummary> cells;
  summarize(raster, [&cells](const CellSummary& cell) { cells.push_back(cell); });
  return cells;
}

constexpr double kKept = 6e-8; ///< To which a passage keeps a value: half the last bit of a float.

void expectSame(
  const std::vector<CellSummary>& a, const std::vector<CellSummary>& b, double relative)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k)
  {
    EXPECT_EQ(a[k].cell, b[k].cell);
    EXPECT_EQ(a[k].passages, b[k].passages) << "cell " << a[k].cell;
    EXPECT_EQ(a[k].rocks, b[k].rocks);
    EXPECT_EQ(a[k].stops, b[k].stops);
    EXPECT_EQ(a[k].reach, b[k].reach);
    for (std::size_t h = 0; h < hazardCount; ++h)
    {
      const SampleStatistics &one = a[k].statistics[h], &other = b[k].statistics[h];
      const double near = relative * (1.0 + std::abs(one.maximum));
      EXPECT_NEAR(one.maximum, other.maximum, near) << "cell " << a[k].cell << ", " << h;
      EXPECT_NEAR(one.mean, other.mean, near);
      for (std::size_t q = 0; q < one.quantiles.size(); ++q)
      {
        EXPECT_NEAR(one.quantiles[q], other.quantiles[q], near);
      }
    }
  }
}

} // namespace

TEST(HazardRaster, ParabolaThroughKnownCells)
{
  // Thrown from (5, 5, 0) with 10 m/s along x and upwards: at x it has been on the way for
  // (x − 5) / 10 s. Two points only.
  const double mass = 1000.0, spin = 500.0, duration = 2.0 * 10.0 / g;
  std::vector<PathPoint> points = hops(100.0, { 5, 5, 0 }, { 10, 0, 10 }, mass, spin, 0);
  ASSERT_EQ(points.size(), 2u);
  HazardRaster raster({ 3, 1, 10.0, 0.0, 0.0 });
  RockPath path = rockPathOf(points, 0, 0, mass);
  path.rested = true;
  raster.add(path);
  const auto cells = cellsOf(raster);
  ASSERT_EQ(cells.size(), 3u);
  const auto vz = [](double t) { return 10.0 - g * t; };
  const auto z = [](double t) { return 10.0 * t - 0.5 * g * t * t; };
  // Cell 0 from 0 to 0.5 s, cell 1 to 1.5 s with the apex at 1.019 s, cell 2 to the end at 2.039 s.
  const double times[4] = { 0.0, 0.5, 1.5, duration };
  for (int k = 0; k < 3; ++k)
  {
    const double v2 =
      100.0 + std::max(vz(times[k]) * vz(times[k]), vz(times[k + 1]) * vz(times[k + 1]));
    const CellSummary& cell = cells[std::size_t(k)];
    EXPECT_EQ(cell.cell, k);
    EXPECT_EQ(cell.passages, 1);
    EXPECT_EQ(cell.rocks, 1);
    EXPECT_EQ(cell.stops, k == 2);
    EXPECT_EQ(cell.reach, 1.0);
    const auto expectKept = [&cell](int of, double value)
    { EXPECT_NEAR(cell.statistics[std::size_t(of)].maximum, value, kKept * value); };
    expectKept(speed, std::sqrt(v2));
    expectKept(energy, 0.5 * mass * v2 + spin);
    expectKept(height, k == 1 ? 100.0 / (2.0 * g) : std::max(z(times[k]), z(times[k + 1])));
    EXPECT_NEAR(cell.statistics[rotation].maximum, 5.0, 1e-12);
  }
}

TEST(HazardRaster, DoesNotDependOnTheSamplingInterval)
{
  const CellGrid grid{ 40, 40, 2.5, 0.0, 0.0 };
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> start(5.0, 20.0), push(1.0, 9.0), mass(100.0, 5000.0);
  HazardRaster fine(grid), coarse(grid);
  for (int rock = 0; rock < 50; ++rock)
  {
    const Vec3 place(start(random), start(random), 10.0 + start(random));
    const Vec3 velocity(push(random), push(random), push(random));
    const double m = mass(random);
    for (auto [raster, interval] : { std::pair(&fine, 0.01), std::pair(&coarse, 0.5) })
    {
      const auto points = hops(interval, place, velocity, m, 100.0, 8);
      RockPath path = rockPathOf(points, rock % 5, rock, m);
      path.rested = true;
      raster->add(path);
    }
  }
  // Coefficients of the pieces of 0.01 s are rounded to 1e-16 of 100 m, which is 1e-12 of their
  // length: velocities to 1e-11, energies as much.
  const auto a = cellsOf(fine), b = cellsOf(coarse);
  EXPECT_GT(a.size(), 200u);
  expectSame(a, b, 1e-9);
}

TEST(HazardRaster, BruteForceAlongRandomCurves)
{
  const CellGrid grid{ 12, 9, 7.0, 3.0, -2.0 };
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 10; ++trial)
  {
    const auto points = wild(random, 6, 70.0);
    HazardRaster raster(grid);
    raster.add(rockPathOf(points, 0, 0, 1000.0));
    std::map<std::int64_t, std::array<double, 4>> most;
    const int steps = 20000;
    for (std::size_t k = 1; k < points.size(); ++k)
    {
      const PathPiece piece(points[k - 1], points[k], 1000.0);
      const Cubic over = piece.height();
      for (int i = 0; i <= steps; ++i)
      {
        const double s = double(i) / steps;
        const Vec3 p = piece.position(s);
        const double column = std::floor((p.x() - grid.west) / grid.cellSize);
        const double row = std::floor((p.y() - grid.south) / grid.cellSize);
        if (column < 0 || column >= grid.columns || row < 0 || row >= grid.rows)
        {
          continue;
        }
        auto& known = most
                        .try_emplace(std::int64_t(row) * grid.columns + std::int64_t(column),
                          std::array<double, 4>{ -1e300, -1e300, -1e300, -1e300 })
                        .first->second;
        const double values[4] = { piece.kineticEnergy(s), piece.velocity(s).norm(), over(s),
          piece.rotationRate(s).norm() };
        for (std::size_t h = 0; h < 4; ++h)
        {
          known[h] = std::max(known[h], values[h]);
        }
      }
    }
    const auto cells = cellsOf(raster);
    std::size_t seen = 0;
    for (const CellSummary& cell : cells)
    {
      const auto found = most.find(cell.cell);
      if (found == most.end())
      {
        continue; // a corner shorter than a step of the walk
      }
      ++seen;
      for (std::size_t h = 0; h < 4; ++h)
      {
        // The walk misses the largest value by less than what it changes in one of its steps.
        EXPECT_GE(cell.statistics[h].maximum, found->second[h] * (1.0 - kKept) - 1e-9);
        EXPECT_LE(cell.statistics[h].maximum, found->second[h] * 1.002 + 0.01);
      }
    }
    EXPECT_EQ(seen, most.size());
    EXPECT_LE(cells.size(), seen + 1);
  }
}

TEST(HazardRaster, GroundBetweenThePoints)
{
  // A ridge of 10 m at x = 20 between two points that know nothing of it: at 2 m over level ground
  // at both ends, and level flight at 12 m above it.
  std::vector<double> heights;
  for (int row = 0; row < 5; ++row)
  {
    for (const double h : { 0.0, 0.0, 10.0, 0.0, 0.0 })
    {
      heights.push_back(h);
    }
  }
  const Terrain terrain({ 5, 5, 10.0, 0.0, 0.0, "" }, heights);
  std::vector<PathPoint> points(2);
  points[0].position = Vec3(2.0, 17.0, 14.0);
  points[1].position = Vec3(38.0, 17.0, 14.0);
  points[1].time = 3.6;
  points[0].velocity = points[1].velocity = Vec3(10, 0, 0);
  points[0].heightOverGround = points[1].heightOverGround = 12.0; // its lowest vertex 2 m below it
  HazardRaster with({ 8, 8, 5.0, 0.0, 0.0 }, &terrain), without({ 8, 8, 5.0, 0.0, 0.0 });
  with.add(rockPathOf(points, 0, 0, 1.0));
  without.add(rockPathOf(points, 0, 0, 1.0));
  const double expected[8] = { 12, 12, 12, 7, 7, 12, 12, 12 };
  const auto seen = cellsOf(with), blind = cellsOf(without);
  ASSERT_EQ(seen.size(), 8u);
  for (std::size_t k = 0; k < 8; ++k)
  {
    EXPECT_NEAR(seen[k].statistics[height].maximum, expected[k], 1e-9) << k;
    EXPECT_NEAR(blind[k].statistics[height].maximum, 12.0, 1e-9) << k;
  }
}

TEST(HazardRaster, GroundUnderAFlightThatLeavesIt)
{
  // The same ridge, and no ground beyond x = 40, where the flight ends: one of its points has no
  // height. However often it is sampled, it is as high over the ridge, and beyond has no height.
  std::vector<double> heights;
  for (int row = 0; row < 5; ++row)
  {
    for (const double h : { 0.0, 0.0, 10.0, 0.0, 0.0, double(NAN) })
    {
      heights.push_back(h);
    }
  }
  const Terrain terrain({ 6, 5, 10.0, 0.0, 0.0, "" }, heights);
  const double expected[10] = { 12, 12, 12, 7, 7, 12, 12, 12, -1, -1 };
  for (const double step : { 46.0, 11.5 })
  {
    for (const bool back : { false, true })
    {
      std::vector<PathPoint> points;
      for (double x = 2.0; x < 49.0; x += step)
      {
        PathPoint& p = points.emplace_back();
        p.position = Vec3(back ? 50.0 - x : x, 17.0, 14.0);
        p.time = (x - 2.0) / 10.0;
        p.velocity = Vec3(back ? -10 : 10, 0, 0);
        const double ground = terrain.elevation(p.position.x(), 17.0);
        p.heightOverGround = 12.0 - ground;
      }
      HazardRaster raster({ 10, 8, 5.0, 0.0, 0.0 }, &terrain);
      raster.add(rockPathOf(points, 0, 0, 1.0));
      const auto cells = cellsOf(raster);
      ASSERT_EQ(cells.size(), 10u);
      for (std::size_t k = 0; k < 10; ++k)
      {
        const double found = cells[k].statistics[height].maximum;
        if (expected[k] < 0.0)
        {
          EXPECT_TRUE(std::isnan(found)) << k << " of " << step;
        }
        else
        {
          EXPECT_NEAR(found, expected[k], 1e-9) << k << " of " << step;
        }
      }
    }
  }
}

TEST(HazardRaster, StatisticsOfACell)
{
  // Rocks of speeds 1, 2, … 101 m/s through one cell, three more through none.
  HazardRaster raster({ 1, 1, 10.0, 0.0, 0.0 });
  const auto through = [](double v, double y)
  {
    std::vector<PathPoint> points(2);
    points[0].position = Vec3(-5, y, 0);
    points[1].position = Vec3(15, y, 0);
    points[0].velocity = points[1].velocity = Vec3(v, 0, 0);
    points[1].time = 20.0 / v;
    points[0].heightOverGround = points[1].heightOverGround = NAN;
    return points;
  };
  for (int k = 101; k >= 1; --k)
  {
    raster.add(rockPathOf(through(k, 5), k % 4, k, 1.0));
  }
  for (int k = 0; k < 3; ++k)
  {
    raster.add(rockPathOf(through(1, 25), k == 1 ? 3 : k, 200, 1.0));
  }
  const auto cells = cellsOf(raster);
  ASSERT_EQ(cells.size(), 1u);
  const CellSummary& cell = cells[0];
  EXPECT_EQ(cell.rocks, 101);
  EXPECT_EQ(cell.passages, 101);
  EXPECT_EQ(cell.stops, 0);
  EXPECT_DOUBLE_EQ(cell.reach, 101.0 / 104.0);
  EXPECT_DOUBLE_EQ(cell.reachError, std::sqrt(101.0 / 104.0 * 3.0 / 104.0 / 104.0));
  // Released 26 in each iteration; 25, 26, 25 and 25 came: deviations −¼, −¼, −¼ and ¾ of the mean.
  EXPECT_NEAR(cell.reachErrorOfIterations, std::sqrt(0.75 * 4.0 / 3.0) / 104.0, 1e-12);
  const SampleStatistics& v = cell.statistics[speed];
  EXPECT_NEAR(v.mean, 51.0, 1e-12);
  EXPECT_NEAR(v.maximum, 101.0, 1e-12);
  EXPECT_NEAR(v.quantiles[0], 51.0, 1e-12);
  EXPECT_NEAR(v.quantiles[1], 91.0, 1e-12);
  EXPECT_NEAR(v.quantiles[2], 96.0, 1e-12);
  EXPECT_NEAR(v.quantiles[3], 100.0, 1e-12);
  EXPECT_TRUE(std::isnan(cell.statistics[height].mean)); // no ground anywhere
}

TEST(HazardRaster, ComingBackIsAPassageButNoOtherRock)
{
  // Up along x from cell 0 into cell 1 and back: x = 5 + 10 t − t², t to 10 s.
  std::vector<PathPoint> points(2);
  points[0].position = points[1].position = Vec3(5, 5, 0);
  points[0].velocity = Vec3(10, 0, 0);
  points[1].velocity = Vec3(-10, 0, 0);
  points[1].time = 10.0;
  HazardRaster raster({ 4, 1, 10.0, 0.0, 0.0 });
  raster.add(rockPathOf(points, 0, 0, 1.0));
  const auto cells = cellsOf(raster);
  ASSERT_EQ(cells.size(), 3u); // it turns at x = 30, on the border: not beyond
  EXPECT_EQ(cells[0].passages, 2);
  EXPECT_EQ(cells[0].rocks, 1);
  EXPECT_EQ(cells[1].passages, 2);
  EXPECT_EQ(cells[2].passages, 1);
  EXPECT_EQ(cells[0].reach, 1.0);
}

TEST(HazardRaster, ARockOnABorderIsInOneCell)
{
  // Dropped onto a border or a corner of cells, the noise of its rest on either side of it.
  const CellGrid grid{ 4, 4, 5.0, 0.0, 0.0 };
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> noise(-1e-13, 1e-13);
  const double places[][2] = { { 5.0, 7.0 }, { 7.0, 10.0 }, { 10.0, 10.0 }, { 0.0, 7.0 },
    { 20.0, 7.0 }, { 20.0, 20.0 } };
  for (const auto& [x, y] : places)
  {
    for (int trial = 0; trial < 20; ++trial)
    {
      std::vector<PathPoint> points(2 + trial % 4);
      for (std::size_t k = 0; k < points.size(); ++k)
      {
        PathPoint& p = points[k];
        p.time = 0.5 * double(k);
        p.position = Vec3(std::clamp(x + (trial > 3 ? noise(random) : 0.0), 0.0, 20.0),
          std::clamp(y + noise(random), 0.0, 20.0), 0.0);
        p.velocity = Vec3(noise(random), noise(random), k == 1 ? -4.0 : 0.0);
        p.kineticEnergy = 0.5 * p.velocity.squaredNorm();
      }
      HazardRaster raster(grid);
      RockPath path = rockPathOf(points, 0, 0, 1.0);
      path.rested = true;
      raster.add(path);
      const auto cells = cellsOf(raster);
      int stops = 0;
      double most = 0.0;
      for (const CellSummary& cell : cells)
      {
        stops += cell.stops;
        most = std::max(most, cell.statistics[energy].maximum);
      }
      EXPECT_EQ(stops, 1) << x << ", " << y << ", " << trial;
      EXPECT_NEAR(most, 8.0, 1e-9) << x << ", " << y << ", " << trial;
    }
  }
}

TEST(HazardRaster, PartsMergeToTheSameBits)
{
  const CellGrid grid{ 20, 20, 5.0, 0.0, 0.0 };
  std::mt19937_64 random(3);
  std::vector<std::vector<PathPoint>> paths;
  for (int k = 0; k < 60; ++k)
  {
    paths.push_back(wild(random, 5, 90.0));
  }
  HazardRaster whole(grid), even(grid), odd(grid);
  for (int k = 0; k < 60; ++k)
  {
    whole.add(rockPathOf(paths[std::size_t(k)], k / 10, k % 10, 100.0 + k));
    const int back = 59 - k;
    (back % 2 ? odd : even)
      .add(rockPathOf(paths[std::size_t(back)], back / 10, back % 10, 100.0 + back));
  }
  odd.merge(even);
  const auto a = cellsOf(whole), b = cellsOf(odd);
  EXPECT_EQ(odd.released(), 60);
  expectSame(a, b, 0.0);
  for (std::size_t k = 0; k < a.size(); ++k)
  {
    EXPECT_EQ(a[k].reachErrorOfIterations, b[k].reachErrorOfIterations);
  }
}

TEST(HazardRaster, BadInput)
{
  EXPECT_THROW(HazardRaster({ 0, 5, 1.0, 0.0, 0.0 }), ParameterError);
  EXPECT_THROW(HazardRaster({ 5, 5, 0.0, 0.0, 0.0 }), ParameterError);
  EXPECT_THROW(HazardRaster({ 100000, 100000, 1.0, 0.0, 0.0 }), ParameterError);
  HazardRaster raster({ 5, 5, 1.0, 0.0, 0.0 }), other({ 5, 5, 2.0, 0.0, 0.0 });
  EXPECT_THROW(raster.merge(other), ParameterError);
  std::vector<PathPoint> points(2);
  points[1].time = -1.0;
  EXPECT_THROW(raster.add(rockPathOf(points, 0, 0, 1.0)), DataError);
  points[1].time = 1.0;
  points[1].velocity.x() = NAN;
  try
  {
    raster.add(rockPathOf(points, 3, 4, 1.0));
    FAIL();
  }
  catch (const DataError& error)
  {
    const std::string text = error.what();
    for (const char* word : { "iteration 3", "rock 4", "Velocity", "point 2" })
    {
      EXPECT_NE(text.find(word), std::string::npos) << text;
    }
  }
  points[1].velocity.x() = 0.0;
  raster.add(rockPathOf(points, 0, 0, 1.0));
  raster.add(rockPathOf(points, 0, 0, 1.0));
  EXPECT_THROW(cellsOf(raster), DataError); // twice the same
}
