// Roughness as a field over the map: its statistics, and that nodes do not matter.

#include "slopes.h"

#include "base/errors.h"
#include "terrain/Surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace rockfall;
using rockfall::testing::makeSlope;
using rockfall::testing::runEnsemble;

namespace
{

constexpr double kNoHeight = std::numeric_limits<double>::quiet_NaN();

double plane(double x, double y)
{
  return 100.0 - 0.5 * x + 0.1 * y;
}

/// A plane of 40 m.
Terrain slope(double cellSize, const Roughness& roughness)
{
  return makeSlope(int(std::lround(40.0 / cellSize)) + 1, cellSize, plane, {}, roughness);
}

/// Of many places, farther from each other than the field remembers, in many iterations.
template <typename Use>
void visitPlaces(Use&& use)
{
  for (int iteration = 0; iteration < 60; ++iteration)
  {
    const RoughField field{ 7, std::uint32_t(iteration) };
    for (int k = 0; k < 400; ++k)
    {
      // Phases all over the squares of the lattice.
      use(field, 1e6 + 17.3 * (k % 20) + 0.0137 * k, 2e5 - 19.1 * (k / 20) + 0.0291 * k);
    }
  }
}
constexpr int kPlaces = 60 * 400;

} // namespace

TEST(Roughness, TheFieldIsNormal)
{
  double sum = 0.0, square = 0.0, cube = 0.0, fourth = 0.0;
  visitPlaces(
    [&](const RoughField& field, double x, double y)
    {
      const double f = field.gaussian(x, y, 2.0);
      sum += f;
      square += f * f;
      cube += f * f * f;
      fourth += f * f * f * f;
    });
  // Standard errors of the moments of n normal deviates: 1/√n, √2/√n, √15/√n, √96/√n; four each.
  const double se = 4.0 / std::sqrt(double(kPlaces));
  EXPECT_NEAR(sum / kPlaces, 0.0, se);
  EXPECT_NEAR(square / kPlaces, 1.0, std::sqrt(2.0) * se);
  EXPECT_NEAR(cube / kPlaces, 0.0, std::sqrt(15.0) * se);
  EXPECT_NEAR(fourth / kPlaces, 3.0, std::sqrt(96.0) * se);
}

TEST(Roughness, TheFieldIsCorrelatedAsStated)
{
  const double length = 2.0;
  for (const double lag : { 0.25, 0.5, 1.0, 1.5, 2.5 })
  {
    for (const double angle : { 0.0, 0.4, 0.785 })
    {
      double product = 0.0;
      visitPlaces(
        [&](const RoughField& field, double x, double y)
        {
          product += field.gaussian(x, y, length) *
            field.gaussian(
              x + lag * length * std::cos(angle), y + lag * length * std::sin(angle), length);
        });
      const double wanted = std::exp(-lag * lag);
      const double se = std::sqrt((1.0 + wanted * wanted) / kPlaces);
      EXPECT_NEAR(product / kPlaces, wanted, 0.012 + 3.0 * se) << lag << " at " << angle;
    }
  }
}

TEST(Roughness, ObstaclesAreOfThreeHeightsByChance)
{
  // Nearly all places under a top of one kind have its height: count the tops by the level between.
  const Roughness roughness{ 0.0, 0.0, 1.0, { 0.1, 0.5, 2.0 } };
  int over[3] = {};
  double highest = 0.0;
  const int squares = 150;
  const RoughField field{ 3, 0 };
  // Area above 0.9 of each height, per square: of a cap of height H, level z is passed within
  // (r/w)² < 1 − √(z/H), w = ℓ/2.
  const double levels[3] = { 0.09, 0.45, 1.8 };
  const int steps = 8 * squares;
  for (int i = 0; i < steps; ++i)
  {
    for (int j = 0; j < steps; ++j)
    {
      const double z = field.obstacles(i / 8.0 + 0.03, j / 8.0 + 0.05, roughness);
      highest = std::max(highest, z);
      for (int k = 0; k < 3; ++k)
      {
        over[k] += z > levels[k];
      }
    }
  }
  EXPECT_LE(highest, 2.0);
  EXPECT_GT(highest, 1.9);
  // Where caps are placed at random, one a square, a place is under one of area A with chance A.
  const auto area = [](double level, double height)
  { return level < height ? M_PI * 0.25 * (1.0 - std::sqrt(level / height)) : 0.0; };
  for (int k = 0; k < 3; ++k)
  {
    // A place is under none of the caps of the squares around, which are about independent.
    const double covered =
      0.7 * area(levels[k], 0.1) + 0.2 * area(levels[k], 0.5) + 0.1 * area(levels[k], 2.0);
    const double share = double(over[k]) / (double(steps) * steps);
    // n squares: the share deviates by √(p(1−p)/n) at most; overlaps take some 10 % of much.
    EXPECT_NEAR(
      share, covered, 4.0 * std::sqrt(covered / (squares * squares)) + 0.5 * covered * covered)
      << k;
  }
}

TEST(Roughness, CommonNodesAreTheSameWhateverTheCells)
{
  for (const Roughness& roughness :
    { Roughness{ 0.1, 0.2, 1.0, {} }, Roughness{ 0.0, 0.0, 2.0, { 0.1, 0.3, 0.6 } } })
  {
    const Terrain fine = slope(0.25, roughness);
    const Surface a(fine, 9, 4);
    double spread = 0.0;
    for (const double cell : { 0.5, 1.0, 2.0, 5.0 })
    {
      const Terrain coarse = slope(cell, roughness);
      const Surface b(coarse, 9, 4);
      EXPECT_NEAR(b.grid().cellSize * (b.grid().columns - 1), 40.0, 1e-9);
      EXPECT_LE(b.grid().cellSize, roughness.resolvedBy() * (1.0 + 1e-9));
      for (double x = 5.0; x < 40.0; x += 5.0)
      {
        for (double y = 5.0; y < 40.0; y += 5.0)
        {
          const auto node = [&](const Surface& s)
          {
            return s.nodeHeight(int(std::lround((40.0 - y) / s.grid().cellSize)),
              int(std::lround(x / s.grid().cellSize)));
          };
          // The same field, raised to what its facets need.
          const auto field = [&](const Surface& s)
          {
            const double raised = roughness.onNodes(s.grid().cellSize).deviation;
            const double height = node(s) - plane(x, y) - roughness.mean;
            return roughness.deviation > 0.0 ? height / raised : height;
          };
          EXPECT_NEAR(field(a), field(b), 1e-9);
          EXPECT_NEAR(b.elevation(x, y), node(b), 1e-9);
          spread = std::max(spread, std::abs(node(b) - plane(x, y)));
        }
      }
    }
    EXPECT_GT(spread, 0.1);
  }
}

TEST(Roughness, RememberedNodesAreOfTheirOwnSurface)
{
  // Terrains, seeds and iterations turn by turn, at nodes 64 rows apart, which share a place in the table; one
  // terrain stands where another one stood.
  const Roughness field{ 0.0, 0.1, 1.0, { 0.1, 0.2, 0.4 } }, drawn{ 0.0, 0.1 };
  std::vector<double> heights;
  for (int round = 0; round < 2; ++round)
  {
    std::vector<double> again;
    for (const Roughness& roughness : { field, drawn, Roughness{ 0.0, 0.2, 1.0, {} } })
    {
      const Terrain terrain = slope(2.0, roughness);
      const Surface surfaces[] = { Surface(terrain, 1, 0), Surface(terrain, 1, 1),
        Surface(terrain, 2, 0) };
      const Surface copy = surfaces[1];
      const int rows = surfaces[0].grid().rows, columns = surfaces[0].grid().columns;
      for (int row = 1; row < rows; row += 8)
      {
        for (int column = 1; column < columns; column += 16)
        {
          for (const Surface& surface : surfaces)
          {
            again.push_back(surface.nodeHeight(row, column));
            EXPECT_EQ(surface.nodeHeight(row, column), again.back());
          }
          EXPECT_EQ(copy.nodeHeight(row, column), again[again.size() - 2]);
          // Of one that nothing is known of yet.
          EXPECT_EQ(Surface(terrain, 1, 1).nodeHeight(row, column), again[again.size() - 2]);
          EXPECT_NE(again[again.size() - 1], again[again.size() - 2]);
          EXPECT_NE(again[again.size() - 3], again[again.size() - 2]);
        }
      }
    }
    EXPECT_TRUE(round == 0 || heights == again);
    heights = again;
  }
}

TEST(Roughness, SlopesOfFacetsDoNotDependOnTheCells)
{
  // Root mean square of the facets' slope, of which the field has σ√2/ℓ. Facets of ½ ℓ keep 94 % of
  // it, of nodes that are raised by 8 %; ten thousands of facets agree within 1 %.
  const Roughness roughness{ 0.0, 0.1, 1.0, {} };
  for (const double cell : { 0.5, 0.8, 2.0, 5.0 })
  {
    double square = 0.0;
    int count = 0;
    const Terrain terrain = slope(cell, roughness);
    for (int iteration = 0; iteration < 20; ++iteration)
    {
      const Surface s(terrain, 1, iteration);
      for (int row = 0; row < s.grid().rows; ++row)
      {
        for (int column = 0; column + 1 < s.grid().columns; ++column)
        {
          const double rise =
            (s.nodeHeight(row, column + 1) - s.nodeHeight(row, column)) / s.grid().cellSize + 0.5;
          square += rise * rise;
          ++count;
        }
      }
    }
    const double whole = 0.1 * std::sqrt(2.0);
    EXPECT_NEAR(std::sqrt(square / count), 1.005 * whole, 0.02 * whole) << cell;
  }
}

TEST(Roughness, TheGroundHasTheDeviationThatIsTyped)
{
  // Between nodes, too, whatever the cells: straight from node to node it had 0.93 of it.
  const Roughness roughness{ 0.0, 0.1, 1.0, {} };
  for (const double cell : { 0.25, 0.5, 1.0, 2.0, 5.0 })
  {
    double square = 0.0;
    int count = 0;
    const Terrain terrain = slope(cell, roughness);
    for (int iteration = 0; iteration < 20; ++iteration)
    {
      const Surface s(terrain, 3, iteration);
      for (double x = 1.03; x < 39.0; x += 2.17)
      {
        for (double y = 1.01; y < 39.0; y += 2.31)
        {
          square += std::pow(s.elevation(x, y) - plane(x, y), 2);
          ++count;
        }
      }
    }
    // Places 2 ℓ apart are independent: four standard errors of n deviates.
    EXPECT_NEAR(std::sqrt(square / count), 0.1, 4.0 * 0.1 / std::sqrt(2.0 * count)) << cell;
  }
}

TEST(Roughness, ThePapersIsDrawnNodeByNode)
{
  // The height of a node is what its number draws, whatever is cut elsewhere.
  const Terrain terrain = slope(2.0, { 0.1, 0.2 });
  const Surface surface(terrain, 5, 6);
  EXPECT_EQ(surface.grid().parts, 1);
  for (int k = 0; k < 20; ++k)
  {
    EXPECT_EQ(surface.nodeHeight(k, 3),
      terrain.nodeHeight(k, 3) + (0.1 + 0.2 * normalDeviate(5, 6, Draw::Roughness, 21 * k + 3)));
  }
}

TEST(Roughness, ClassesHaveTheirOwn)
{
  Terrain terrain = slope(2.0, { 0.0, 0.2, 1.0, {} });
  // West: as the slope. Middle: smooth. East: the paper's.
  std::vector<std::uint8_t> cells(400);
  for (int cell = 0; cell < 400; ++cell)
  {
    cells[std::size_t(cell)] = cell % 20 < 7 ? 1 : cell % 20 < 14 ? 2 : 3;
  }
  MaterialClasses classes;
  classes.names = { "west", "middle", "east" };
  classes.materials.resize(3);
  classes.roughness = { terrain.roughness(), {}, { 0.0, 0.3 } };
  classes.cells = cells;
  terrain.setRestitutionClasses(classes);
  const Surface surface(terrain, 5, 6);
  EXPECT_EQ(surface.grid().parts, 4);
  const Terrain everywhere = slope(2.0, { 0.0, 0.2, 1.0, {} }), drawn = slope(2.0, { 0.0, 0.3 });
  const Surface plain(everywhere, 5, 6), paper(drawn, 5, 6);
  for (int row = 4; row < 70; ++row)
  {
    EXPECT_EQ(surface.nodeHeight(row, 11), plain.nodeHeight(row, 11));
    const double x = 40 * surface.grid().cellSize, y = 40.0 - row * surface.grid().cellSize;
    EXPECT_NEAR(surface.nodeHeight(row, 40), plane(x, y), 1e-9);
    EXPECT_NEAR(surface.nodeHeight(row, 70), paper.elevation(70 * surface.grid().cellSize, y),
      1e-9); // on the paper's facets
  }
}

TEST(Roughness, PartsOfACellAreOnItsTrianglesAndHolesStayHoles)
{
  GridGeometry g;
  g.columns = g.rows = 4;
  g.cellSize = 3.0;
  std::vector<double> heights = { 9, 7, 8, 6, 5, kNoHeight, 4, 7, 3, 6, 2, 5, 4, 3, 6, 1 };
  const Terrain terrain(g, heights, {}, { 0.0, 1e-12, 2.0, {} });
  const Surface surface(terrain, 1, 0);
  ASSERT_EQ(surface.grid().parts, 3);
  for (double x = 0.01; x < 9.0; x += 0.07)
  {
    for (double y = 0.013; y < 9.0; y += 0.07)
    {
      const double before = terrain.elevation(x, y), now = surface.elevation(x, y);
      EXPECT_EQ(std::isnan(before), std::isnan(now)) << x << " " << y;
      if (!std::isnan(before))
      {
        EXPECT_NEAR(before, now, 1e-9) << x << " " << y;
      }
    }
  }
  // Triangles of the patch have the numbers of the CFEs that they are parts of.
  SurfacePatch patch;
  gatherPatch(surface, 0.1, 8.9, 0.1, 8.9, patch);
  int found = 0;
  for (double x = 0.11; x < 9.0; x += 0.07)
  {
    for (double y = 0.05; y < 9.0; y += 0.07)
    {
      const int i = patch.triangleAt(x, y);
      const std::int64_t cfe = terrain.cfeAt(x, y);
      EXPECT_EQ(i >= 0 ? patch.triangles[std::size_t(i)].cfe : 0, cfe) << x << " " << y;
      found += i >= 0;
    }
  }
  EXPECT_GT(found, 5000);
}

TEST(Roughness, NothingIsHigherThanItsBound)
{
  const Terrain terrain = slope(2.0, { 0.2, 0.3, 1.0, { 0.2, 0.5, 1.0 } });
  double most = 0.0;
  for (int iteration = 0; iteration < 5; ++iteration)
  {
    const Surface surface(terrain, 5, iteration);
    for (int row = 0; row < surface.grid().rows; ++row)
    {
      for (int column = 0; column < surface.grid().columns; ++column)
      {
        const double x = column * surface.grid().cellSize;
        const double y = 40.0 - row * surface.grid().cellSize;
        most = std::max(most, surface.nodeHeight(row, column) - plane(x, y));
      }
    }
  }
  EXPECT_LE(most, terrain.roughnessHeight());
  EXPECT_GT(most, 1.2);
}

TEST(Roughness, WhatCannotBeIsRefused)
{
  EXPECT_THROW((Roughness{ 0.0, -0.1 }.validate()), ParameterError);
  EXPECT_THROW((Roughness{ 0.0, 0.1, -1.0, {} }.validate()), ParameterError);
  EXPECT_THROW((Roughness{ 0.0, 0.0, 0.0, { 0.1, 0.2, 0.3 } }.validate()), ParameterError);
  EXPECT_THROW((Roughness{ 0.0, 0.0, 1.0, { 0.1, -0.2, 0.3 } }.validate()), ParameterError);
  EXPECT_THROW(slope(5.0, { 0.0, 0.1, 0.04, {} }), ParameterError); // 250 parts of a cell
}

namespace
{

std::uint64_t hashOfRun(const Terrain& terrain, int threads)
{
  std::vector<Rock> rocks(4);
  for (std::size_t k = 0; k < rocks.size(); ++k)
  {
    rocks[k].shape = makeShape(Shape::Cube, 0.5);
    rocks[k].position = Vec3(8.0, 8.0 + 6.0 * double(k), 100.0);
  }
  SimulationParameters p;
  p.endTime = 3.0;
  p.iterations = 2;
  p.threads = threads;
  TrajectoryStore store;
  runEnsemble(terrain, rocks, p, store);
  std::uint64_t hash = 0;
  for (const Trajectory& t : store.trajectories())
  {
    hash = hash * 31 + t.summary.hash;
  }
  return hash;
}

} // namespace

TEST(Roughness, RunsAreTheSameBitsWhateverTheThreads)
{
  const Terrain terrain = slope(2.0, { 0.0, 0.1, 1.0, { 0.1, 0.2, 0.4 } });
  const std::uint64_t one = hashOfRun(terrain, 1);
  EXPECT_EQ(one, hashOfRun(terrain, 3));
  EXPECT_EQ(one, hashOfRun(terrain, 1)); // what was remembered does not matter
  EXPECT_NE(one, hashOfRun(slope(2.0, { 0.0, 0.1, 1.0, {} }), 1));
}
