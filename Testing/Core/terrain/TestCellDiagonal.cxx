// The cut of cells: one surface wherever heights are asked for, fair to left and right.

#include "slopes.h"

#include "contact/ground/heightOver.h"
#include "form.h"
#include "terrain/Surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

using namespace rockfall;
using rockfall::testing::runEnsemble;
using rockfall::testing::simulate;

namespace
{

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A square map of heights, north row first.
struct Map
{
  int nodes;
  std::vector<double> heights;

  double& at(int row, int column) { return heights[std::size_t(row) * nodes + column]; }
  /// Its north-west corner becomes the south-west one.
  Map turned() const
  {
    Map map = *this;
    for (int row = 0; row < nodes; ++row)
    {
      for (int column = 0; column < nodes; ++column)
      {
        map.at(nodes - 1 - column, row) = heights[std::size_t(row) * nodes + column];
      }
    }
    return map;
  }
  Terrain terrain(double cellSize, CellDiagonal diagonal, Roughness roughness = {}) const
  {
    GridGeometry g;
    g.columns = g.rows = nodes;
    g.cellSize = cellSize;
    g.diagonal = diagonal;
    return Terrain(g, heights, {}, roughness);
  }
};

Map randomMap(int nodes, double nodata)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> height(0.0, 3.0), chance(0.0, 1.0);
  Map map{ nodes, std::vector<double>(std::size_t(nodes) * nodes) };
  for (double& z : map.heights)
  {
    z = chance(random) < nodata ? kNone : height(random);
  }
  return map;
}

} // namespace

TEST(CellDiagonal, IsTheShorterFold)
{
  // The paper's where both folds are alike, and beside nodata.
  EXPECT_FALSE(isCutRising(CellDiagonal::ShorterFold, 1.0, 1.0, 0.0, 0.0));
  EXPECT_FALSE(isCutRising(CellDiagonal::ShorterFold, 1.0 + 1e-12, 1.0, 0.0, 0.0));
  EXPECT_TRUE(isCutRising(CellDiagonal::ShorterFold, 5.0, 1.0, 1.0, 0.0));
  EXPECT_FALSE(isCutRising(CellDiagonal::ShorterFold, 1.0, 5.0, 0.0, 1.0));
  EXPECT_FALSE(isCutRising(CellDiagonal::FromUpperLeft, 5.0, 1.0, 1.0, 0.0));
  EXPECT_FALSE(isCutRising(CellDiagonal::ShorterFold, 5.0, kNone, 1.0, 0.0));
}

TEST(CellDiagonal, NumbersTheTriangles)
{
  // The lower triangle has the lower side.
  Map map{ 2, { 5.0, 1.0, 1.0, 0.0 } };
  const Terrain t = map.terrain(1.0, CellDiagonal::ShorterFold);
  EXPECT_EQ(t.cfeNodes(1), (std::array<std::int64_t, 3>{ 2, 3, 1 }));
  EXPECT_EQ(t.cfeNodes(2), (std::array<std::int64_t, 3>{ 0, 2, 1 }));
  EXPECT_EQ(t.cfeAt(0.9, 0.2), 1);
  EXPECT_EQ(t.cfeAt(0.1, 0.8), 2);
}

TEST(CellDiagonal, AMapThatIsTurnedIsTheSameGround)
{
  const Map map = randomMap(9, 0.0), turned = map.turned();
  const Terrain a = map.terrain(1.0, CellDiagonal::ShorterFold),
                b = turned.terrain(1.0, CellDiagonal::ShorterFold);
  for (double x = 0.05; x < 8.0; x += 0.17)
  {
    for (double y = 0.03; y < 8.0; y += 0.19)
    {
      // From the north to the west.
      EXPECT_NEAR(a.elevation(x, y), b.elevation(8.0 - y, x), 1e-12);
    }
  }
}

TEST(CellDiagonal, AllAskersSeeOneSurface)
{
  const Map map = randomMap(9, 0.05);
  for (const CellDiagonal diagonal : { CellDiagonal::ShorterFold, CellDiagonal::FromUpperLeft })
  {
    for (const Roughness& roughness : { Roughness{}, Roughness{ 0.0, 0.3 },
           Roughness{ 0.0, 0.2, 0.8, {} } }) // none, of nodes, of finer nodes
    {
      const Terrain terrain = map.terrain(1.0, diagonal, roughness);
      const Surface surface(terrain, 5, 1);
      HeightWindow window;
      window.gather(surface, 0.1, 7.9, 0.1, 7.9);
      SurfacePatch patch;
      gatherPatch(surface, 0.1, 7.9, 0.1, 7.9, patch);
      int known = 0;
      for (double x = 0.05; x < 8.0; x += 0.13)
      {
        for (double y = 0.03; y < 8.0; y += 0.17)
        {
          const double z = surface.elevation(x, y), seen = window.elevation(x, y);
          const int i = patch.triangleAt(x, y);
          ASSERT_EQ(std::isnan(z), std::isnan(seen));
          ASSERT_EQ(std::isnan(z), i < 0);
          if (i >= 0)
          {
            ++known;
            const SurfacePatch::Triangle& t = patch.triangles[std::size_t(i)];
            EXPECT_NEAR(seen, z, 1e-12);
            EXPECT_NEAR(t.normal.dot(Vec3(x, y, z)), t.offset, 1e-12);
            // No CFE is steeper than the window says.
            const Eigen::Vector2d rise(-t.normal.x() / t.normal.z(), -t.normal.y() / t.normal.z());
            EXPECT_LE((rise - window.tilt()).norm(), window.relief() * (1.0 + 1e-9));
          }
        }
      }
      EXPECT_GT(known, 1500);
    }
  }
}

TEST(CellDiagonal, TrianglesOfAPatchAreOneMesh)
{
  const Terrain terrain = randomMap(9, 0.05).terrain(1.0, CellDiagonal::ShorterFold);
  SurfacePatch patch;
  gatherPatch(Surface::asSurveyed(terrain), 1.1, 6.9, 1.1, 6.9, patch);
  int rising = 0, falling = 0;
  std::set<std::int64_t> keys;
  for (int i = 0; i < patch.slopeTriangles; ++i)
  {
    const SurfacePatch::Triangle& t = patch.triangles[std::size_t(i)];
    (t.rising ? rising : falling) += 1;
    if (t.cfe == 0)
    {
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k)
    {
      EXPECT_TRUE(keys.insert(SurfacePatch::sideKey(t, int(k))).second || t.neighbours[k] >= 0);
      const int j = t.neighbours[k];
      if (j < 0 || j >= patch.slopeTriangles)
      {
        continue;
      }
      const SurfacePatch::Triangle& other = patch.triangles[std::size_t(j)];
      const auto back = std::find(other.neighbours.begin(), other.neighbours.end(), i);
      ASSERT_NE(back, other.neighbours.end());
      const auto b = std::size_t(back - other.neighbours.begin());
      EXPECT_EQ(other.nodes[b], t.nodes[(k + 1) % 3]);
      EXPECT_EQ(other.nodes[(b + 1) % 3], t.nodes[k]);
      EXPECT_EQ(other.bends[b], t.bends[k]);
    }
  }
  EXPECT_GT(rising, 20);
  EXPECT_GT(falling, 20);
  // A ridge rises over both of its wings, and each has a key of its own.
  keys.clear();
  for (const SurfacePatch::Ridge& ridge : patch.ridges)
  {
    EXPECT_TRUE(keys.insert(ridge.key).second);
  }
  // The neighbours of a peak are the other ends of its edges.
  int peaks = 0;
  for (int n = 0; n < patch.slopeNodes; ++n)
  {
    const SurfacePatch::Node& node = patch.nodes[std::size_t(n)];
    std::set<int> ends;
    bool whole = node.peak;
    for (int i = 0; i < patch.slopeTriangles; ++i)
    {
      const SurfacePatch::Triangle& t = patch.triangles[std::size_t(i)];
      if (std::find(t.nodes.begin(), t.nodes.end(), n) != t.nodes.end())
      {
        ends.insert(t.nodes.begin(), t.nodes.end());
        whole = whole && t.cfe != 0;
      }
    }
    ends.erase(n);
    if (whole)
    {
      ++peaks;
      EXPECT_EQ(std::set<int>(node.neighbours.begin(), node.neighbours.end()), ends);
    }
  }
  EXPECT_GT(peaks, 10);
}

TEST(CellDiagonal, WhatARockMeetsFromAboveIsTheGround)
{
  // Least height over the ground of a fine cloud of points of the rock.
  const Terrain terrain = randomMap(9, 0.0).terrain(1.0, CellDiagonal::ShorterFold);
  const Surface surface = Surface::asSurveyed(terrain);
  HeightWindow window;
  window.gather(surface, 0.1, 7.9, 0.1, 7.9);
  for (const Shape shape : { Shape::Cube, Shape::Eota111 })
  {
    for (int k = 0; k < 20; ++k)
    {
      const Block block(makeShape(shape, 2.0), 2700.0, 1e10, 0.25);
      BlockState state;
      state.position = Vec3(2.5 + 0.15 * k, 5.3 - 0.11 * k, 8.0);
      state.orientation = Quat(Eigen::AngleAxisd(0.9 * k, Vec3(1.0, 0.3 * k, 0.7).normalized()));
      PlacedBlock rock;
      rock.place(block, state);
      double least = std::numeric_limits<double>::infinity();
      for (const auto& face : block.shape().faces())
      {
        const Vec3& a = rock.vertices()[std::size_t(face[0])];
        for (std::size_t j = 1; j + 1 < face.size(); ++j)
        {
          const Vec3 u = rock.vertices()[std::size_t(face[j])] - a,
                     v = rock.vertices()[std::size_t(face[j + 1])] - a;
          for (double s = 0.0; s <= 1.0; s += 0.02)
          {
            for (double t = 0.0; s + t <= 1.0; t += 0.02)
            {
              const Vec3 p = a + s * u + t * v;
              least = std::min(least, p.z() - terrain.elevation(p.x(), p.y()));
            }
          }
        }
      }
      const double height = heightOver(rock, window, 0.0);
      EXPECT_LE(height, least + 1e-9);
      EXPECT_GT(height, least - 0.1); // points are 0.03 m apart, ground as steep as 70°
    }
  }
}

TEST(CellDiagonal, WhiteRoughnessLeadsRocksNeitherLeftNorRight)
{
  // 30° for 100 m, then flat, of cells of 2 m with a roughness of 0.2 m in each node: a plane that
  // falls one way has no left and no right, whichever way it falls. One diagonal for all cells leads
  // rocks 20 m aside.
  constexpr int nodes = 111; // 220 m
  constexpr double cell = 2.0, size = (nodes - 1) * cell;
  Map map{ nodes, {} };
  for (int row = 0; row < nodes; ++row)
  {
    for (int column = 0; column < nodes; ++column)
    {
      map.heights.push_back(std::max(0.0, 100.0 - cell * column) * std::tan(radians(30.0)));
    }
  }
  SurfaceMaterial ground;
  ground.restitutionModel = RestitutionModel::NormalTangential;
  ground.restitution = 0.4;
  ground.frictionAngle = radians(25.0);
  Rock rock;
  rock.shape = makeShape(Shape::Eota111, 1.0);
  Eigen::Vector2d place(-size / 2 + 5.0, 0.0), down(1.0, 0.0); // from the middle
  SimulationParameters p;
  p.endTime = 40.0;
  p.outputInterval = 5.0;
  p.iterations = rockfall::testing::someOf(250, 120);
  double all = 0.0, allSquares = 0.0;
  int count = 0;
  for (int turn = 0; turn < 4; ++turn)
  {
    GridGeometry g;
    g.columns = g.rows = nodes;
    g.cellSize = cell;
    const Terrain terrain(g, map.heights, ground, Roughness{ 0.0, 0.2 });
    rock.position = Vec3(size / 2 + place.x(), size / 2 + place.y(), 0.0);
    rock.position.z() = terrain.elevation(rock.position.x(), rock.position.y()) + 2.0;
    double sum = 0.0, squares = 0.0;
    TrajectoryStore store(1, p.iterations);
    p.seed = turn + 1;
    runEnsemble(terrain, std::span<const Rock>(&rock, 1), p, store);
    for (const Trajectory& t : store.trajectories())
    {
      const Eigen::Vector2d way = (t.summary.stop - t.summary.start).head<2>();
      const double left = down.x() * way.y() - down.y() * way.x();
      sum += left;
      squares += left * left;
    }
    const double mean = sum / p.iterations;
    const double deviation = std::sqrt(squares / p.iterations - mean * mean);
    EXPECT_LT(std::abs(mean), 3.0 * deviation / std::sqrt(p.iterations)) << "turn " << turn;
    all += sum;
    allSquares += squares;
    count += p.iterations;
    map = map.turned();
    place = { -place.y(), place.x() };
    down = { -down.y(), down.x() };
  }
  const double mean = all / count, deviation = std::sqrt(allSquares / count - mean * mean);
  EXPECT_LT(std::abs(mean), 2.0 * deviation / std::sqrt(count))
    << mean << " +- " << deviation / std::sqrt(count);
  RecordProperty("mean", std::to_string(mean));
}
