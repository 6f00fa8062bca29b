// Deviations drawn per iteration, per impact and per place.

#include "slopes.h"

#include "terrain/Surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

using namespace rockfall;
using rockfall::testing::makePlane;
using rockfall::testing::runEnsemble;

namespace
{

constexpr int kDraws = 4000;

SurfaceMaterial scattered()
{
  SurfaceMaterial m;
  m.restitution = 0.5;
  m.restitutionDeviation = 0.1;
  m.frictionAngle = radians(30.0);
  m.frictionAngleDeviation = radians(3.0);
  return m;
}

Terrain slope(DeviationPer per, int nodes = 41)
{
  Terrain terrain = makePlane(nodes, 200.0, radians(30.0), 0.0, scattered());
  terrain.setDeviationPer(per);
  return terrain;
}

/// Touch number k of many, each at a place and of an impact of its own.
GroundTouch touch(int k)
{
  return { 1, Vec3(1.5 * (k % 100) + 0.25, 1.5 * (k / 100) + 0.25, 0.0), std::uint32_t(k % 7),
    std::uint32_t(k / 7) };
}

struct Moments
{
  double mean = 0.0, deviation = 0.0;
};

template <typename Draw>
Moments momentsOf(Draw&& draw)
{
  double sum = 0.0, square = 0.0;
  for (int k = 0; k < kDraws; ++k)
  {
    const double x = draw(k);
    sum += x;
    square += x * x;
  }
  const double mean = sum / kDraws;
  return { mean, std::sqrt(square / kDraws - mean * mean) };
}

} // namespace

class ScatterPer : public ::testing::TestWithParam<DeviationPer>
{
};

TEST_P(ScatterPer, HasTheMeanAndTheDeviationOfTheClass)
{
  const Terrain terrain = slope(GetParam());
  const Surface one(terrain, 5, 0);
  const bool perIteration = GetParam() == DeviationPer::Iteration;
  const auto at = [&](int k) { return perIteration ? Surface(terrain, 5, k) : one; };
  const Moments e = momentsOf([&](int k) { return at(k).restitutionAt(touch(k)); });
  const Moments phi = momentsOf([&](int k) { return std::atan(at(k).frictionAt(touch(k))); });
  // The mean of n draws deviates by σ/√n, their deviation by σ/√(2n); four of each.
  EXPECT_NEAR(e.mean, 0.5, 4 * 0.1 / std::sqrt(kDraws));
  EXPECT_NEAR(e.deviation, 0.1, 4 * 0.1 / std::sqrt(2.0 * kDraws));
  EXPECT_NEAR(degrees(phi.mean), 30.0, 4 * 3.0 / std::sqrt(kDraws));
  EXPECT_NEAR(degrees(phi.deviation), 3.0, 4 * 3.0 / std::sqrt(2.0 * kDraws));
}

INSTANTIATE_TEST_SUITE_P(All, ScatterPer,
  ::testing::Values(DeviationPer::Iteration, DeviationPer::Impact, DeviationPer::Place));

TEST(Scatter, PerIterationIsOneNumber)
{
  const Terrain terrain = slope(DeviationPer::Iteration);
  const Surface surface(terrain, 5, 3);
  EXPECT_EQ(surface.restitutionAt(touch(1)), surface.restitutionAt(touch(2)));
  EXPECT_EQ(surface.restitutionAt(touch(1)), surface.restitution());
  EXPECT_EQ(surface.frictionAt(touch(1)), surface.friction());
}

TEST(Scatter, PerImpactRocksAndImpactsDiffer)
{
  const Terrain terrain = slope(DeviationPer::Impact);
  const Surface surface(terrain, 5, 3);
  std::set<double> drawn;
  for (std::uint32_t rock = 0; rock < 10; ++rock)
  {
    for (std::uint32_t impact = 0; impact < 10; ++impact)
    {
      drawn.insert(surface.restitutionAt({ 1, Vec3::Zero(), rock, impact }));
      // Wherever it is.
      EXPECT_EQ(surface.restitutionAt({ 1, Vec3::Zero(), rock, impact }),
        surface.restitutionAt({ 1, Vec3(50.0, 50.0, 0.0), rock, impact }));
    }
  }
  EXPECT_EQ(drawn.size(), 100u);
  EXPECT_NE(
    surface.restitutionAt(touch(0)), Surface(terrain, 5, 4).restitutionAt(touch(0))); // iterations
}

TEST(Scatter, PerPlaceTwoRocksMeetTheSameSpotAlike)
{
  const Terrain terrain = slope(DeviationPer::Place);
  const Surface surface(terrain, 5, 3);
  const GroundTouch first{ 1, Vec3(50.2, 50.3, 0.0), 0, 0 };
  const GroundTouch second{ 1, Vec3(50.8, 50.9, 9.0), 5, 17 };
  const GroundTouch beside{ 1, Vec3(51.2, 50.3, 0.0), 0, 0 };
  EXPECT_EQ(surface.restitutionAt(first), surface.restitutionAt(second));
  EXPECT_EQ(surface.frictionAt(first), surface.frictionAt(second));
  EXPECT_NE(surface.restitutionAt(first), surface.restitutionAt(beside));
  EXPECT_NE(surface.restitutionAt(first), Surface(terrain, 5, 4).restitutionAt(first));
  // A place is one of the map: the same on other nodes, and in a piece that was cut out.
  const Terrain coarse = slope(DeviationPer::Place, 11);
  EXPECT_EQ(surface.restitutionAt(first), Surface(coarse, 5, 3).restitutionAt(first));
  GridGeometry g;
  g.columns = g.rows = 5;
  g.cellSize = 5.0;
  g.xOrigin = g.yOrigin = 50.0;
  Terrain piece(g, std::vector<double>(25, 0.0), scattered());
  piece.setDeviationPer(DeviationPer::Place);
  EXPECT_EQ(surface.restitutionAt(first),
    Surface(piece, 5, 3).restitutionAt({ 1, first.position - Vec3(50.0, 50.0, 0.0), 0, 0 }));
}

TEST(Scatter, NoneOnTheSlopeAsSurveyed)
{
  const Terrain terrain = slope(DeviationPer::Impact);
  const Surface surface = Surface::asSurveyed(terrain);
  EXPECT_EQ(surface.restitutionAt(touch(9)), 0.5);
  EXPECT_EQ(surface.deviationPer(0), DeviationPer::Iteration);
}

TEST(Scatter, EachClassIsDrawnForItsOwn)
{
  // West: per iteration, as the slope. East: per impact.
  Terrain terrain = slope(DeviationPer::Iteration);
  std::vector<std::uint8_t> cells(40 * 40);
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
  {
    cells[cell] = cell % 40 < 20 ? 1 : 2;
  }
  MaterialClasses classes;
  classes.names = { "west", "east" };
  classes.materials = { scattered(), scattered() };
  classes.materials[1].deviationPer = DeviationPer::Impact;
  classes.cells = cells;
  terrain.setRestitutionClasses(classes);
  terrain.setJointClasses(classes);
  const Surface surface(terrain, 5, 3);
  std::set<double> west, east, smooth, rough;
  for (std::uint32_t impact = 0; impact < 20; ++impact)
  {
    const GroundTouch inWest{ 1, Vec3::Zero(), 0, impact }, inEast{ 61, Vec3::Zero(), 0, impact };
    west.insert(surface.restitutionAt(inWest));
    east.insert(surface.restitutionAt(inEast));
    smooth.insert(surface.frictionAt(inWest));
    rough.insert(surface.frictionAt(inEast));
  }
  EXPECT_EQ(west.size(), 1u);
  EXPECT_EQ(smooth.size(), 1u);
  EXPECT_EQ(east.size(), 20u);
  EXPECT_EQ(rough.size(), 20u);
  EXPECT_EQ(surface.deviationPer(1), DeviationPer::Iteration);
  EXPECT_EQ(surface.deviationPer(2), DeviationPer::Impact);
}

namespace
{

std::vector<Trajectory> runs(const Terrain& terrain, int threads, int first, int count)
{
  std::vector<Rock> rocks(3);
  for (std::size_t k = 0; k < rocks.size(); ++k)
  {
    rocks[k].shape = makeShape(Shape::Cube, 1.0);
    rocks[k].position = Vec3(60.0, 80.0 + 20.0 * double(k), 130.0);
  }
  SimulationParameters p;
  p.endTime = 4.0;
  p.iterations = count;
  p.firstIteration = first;
  p.threads = threads;
  TrajectoryStore store;
  runEnsemble(terrain, rocks, p, store);
  return store.take();
}

} // namespace

TEST(Scatter, RunsAreTheSameBitsWhateverTheThreadsAndTheFirstIteration)
{
  for (const DeviationPer per : { DeviationPer::Impact, DeviationPer::Place })
  {
    const Terrain terrain = slope(per);
    const std::vector<Trajectory> one = runs(terrain, 1, 0, 4), three = runs(terrain, 3, 0, 4),
                                  last = runs(terrain, 1, 3, 1);
    for (std::size_t k = 0; k < one.size(); ++k)
    {
      EXPECT_EQ(one[k].summary.hash, three[k].summary.hash);
      if (k >= 9)
      {
        EXPECT_EQ(one[k].summary.hash, last[k - 9].summary.hash);
      }
    }
  }
}

TEST(Scatter, TheImpactsOfOneRunDiffer)
{
  const auto coefficients = [](DeviationPer per)
  {
    std::set<double> all;
    const auto trajectories = runs(slope(per), 1, 0, 1);
    for (const ImpactEvent& impact : trajectories.front().impacts)
    {
      all.insert(impact.restitution);
    }
    return all.size();
  };
  EXPECT_EQ(coefficients(DeviationPer::Iteration), 1u);
  EXPECT_GE(coefficients(DeviationPer::Impact), 3u);
  EXPECT_GE(coefficients(DeviationPer::Place), 3u);
}
