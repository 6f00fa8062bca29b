// The implicit slope: numbering and geometry of CFEs (METHOD 5), lookup, bounds, patches,
// roughness.

#include "base/errors.h"
#include "base/random.h"
#include "form.h"
#include "slopes.h"
#include "terrain/Surface.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

Terrain randomTerrain(int columns, int rows, unsigned seed, double nodataShare = 0.0)
{
  GridGeometry g;
  g.columns = columns;
  g.rows = rows;
  g.cellSize = 2.5;
  g.xOrigin = 500000.0;
  g.yOrigin = 4000000.0;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> height(0.0, 5.0), chance(0.0, 1.0);
  std::vector<double> heights(std::size_t(g.nodeCount()));
  for (double& z : heights)
  {
    z = chance(random) < nodataShare ? std::nan("") : height(random);
  }
  return Terrain(g, heights);
}

} // namespace

TEST(Terrain, NumbersCfesAsThePaperDoes)
{
  // 3 × 3 nodes: 2 (n−1)(m−1) = 8 CFEs, numbered from 1 along the rows of the raster.
  const Terrain t = makeSlope(3, 1.0, [](double x, double y) { return x + 10.0 * y; });
  EXPECT_EQ(t.cfeCapacity(), 8);
  // Odd: upper left, lower right, lower left of the cell; row 0 is the northernmost.
  const auto odd = t.cfeNodes(1);
  EXPECT_EQ(std::set<std::int64_t>(odd.begin(), odd.end()), (std::set<std::int64_t>{ 0, 3, 4 }));
  const auto even = t.cfeNodes(2);
  EXPECT_EQ(std::set<std::int64_t>(even.begin(), even.end()), (std::set<std::int64_t>{ 0, 4, 1 }));
  const auto last = t.cfeNodes(8);
  EXPECT_EQ(std::set<std::int64_t>(last.begin(), last.end()), (std::set<std::int64_t>{ 4, 8, 5 }));
  for (std::int64_t id = 1; id <= 8; ++id)
  {
    EXPECT_GT(t.cfe(id).normal.z(), 0.0) << id;
    EXPECT_TRUE(t.hasCfe(id));
  }
  EXPECT_FALSE(t.hasCfe(0));
  EXPECT_FALSE(t.hasCfe(9));
}

TEST(Terrain, FindsTheCfeUnderAPlace)
{
  const Terrain t = randomTerrain(17, 11, 1, 0.05);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> x(-1.0, t.width() + 1.0), y(-1.0, t.height() + 1.0);
  int found = 0;
  for (int i = 0; i < 2000; ++i)
  {
    const double px = x(random), py = y(random);
    // The slow oracle: the triangle whose plan view holds the point.
    std::int64_t expected = 0;
    for (std::int64_t id = 1; id <= t.cfeCapacity() && expected == 0; ++id)
    {
      if (!t.hasCfe(id))
      {
        continue;
      }
      const auto n = t.cfe(id).nodes;
      bool inside = true;
      for (int k = 0; k < 3; ++k)
      {
        const Vec3 e = n[(k + 1) % 3] - n[k];
        inside = inside && e.x() * (py - n[k].y()) - e.y() * (px - n[k].x()) >= 0.0;
      }
      expected = inside ? id : 0;
    }
    EXPECT_EQ(t.cfeAt(px, py), expected);
    if (expected != 0)
    {
      ++found;
      const Cfe f = t.cfe(expected);
      const Vec3 p(px, py, t.elevation(px, py));
      // 5 m of relief: a few ulps of 10 m.
      EXPECT_NEAR(f.normal.dot(p - f.nodes[0]), 0.0, 1e-12);
    }
    else
    {
      EXPECT_TRUE(std::isnan(t.elevation(px, py)));
    }
  }
  EXPECT_GT(found, 1000);
}

TEST(Terrain, BoundsTheHeightOfABox)
{
  const Terrain t = randomTerrain(70, 45, 3);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> x(-5.0, t.width() + 5.0), size(0.1, 60.0);
  for (int i = 0; i < 500; ++i)
  {
    const double x0 = x(random), y0 = x(random) * t.height() / t.width();
    const double x1 = x0 + size(random), y1 = y0 + size(random);
    const double bound = t.maxHeight(x0, x1, y0, y1);
    for (int k = 0; k < 50; ++k)
    {
      const double s = k / 49.0, u = ((k * 7) % 50) / 49.0;
      const double z = t.elevation(x0 + s * (x1 - x0), y0 + u * (y1 - y0));
      EXPECT_TRUE(std::isnan(z) || z <= bound);
    }
  }
  EXPECT_EQ(t.maxHeight(-9.0, -8.0, 0.0, 1.0), -std::numeric_limits<double>::infinity());
}

TEST(Terrain, LeavesOutCfesThatTouchNodata)
{
  GridGeometry g;
  g.columns = g.rows = 3;
  g.cellSize = 1.0;
  std::vector<double> z(9, 1.0);
  z[4] = std::nan(""); // the middle node: six of the eight CFEs touch it
  const Terrain t(g, z);
  int existing = 0;
  for (std::int64_t id = 1; id <= 8; ++id)
  {
    existing += t.hasCfe(id);
  }
  EXPECT_EQ(existing, 2);
}

TEST(Terrain, RefusesWhatIsNoSlope)
{
  GridGeometry g;
  g.columns = 3;
  g.rows = 1;
  g.cellSize = 1.0;
  EXPECT_THROW(Terrain(g, std::vector<double>(3, 0.0)), DataError);
  g.rows = 3;
  EXPECT_THROW(Terrain(g, std::vector<double>(9, std::nan(""))), DataError);
  EXPECT_THROW(Terrain(g, std::vector<double>(9, INFINITY)), DataError);
  EXPECT_THROW(Terrain(g, std::vector<double>(8, 0.0)), DataError);
  g.cellSize = 0.0;
  EXPECT_THROW(Terrain(g, std::vector<double>(9, 0.0)), DataError);
  g.cellSize = 1.0;
  SurfaceMaterial m;
  m.restitution = 1.5;
  try
  {
    Terrain(g, std::vector<double>(9, 0.0), m);
    FAIL();
  }
  catch (const ParameterError& e)
  {
    EXPECT_NE(std::string(e.what()).find("RestitutionCoefficient is 1.5"), std::string::npos)
      << e.what();
  }
}

TEST(Terrain, RefusesARestitutionThatIsNone)
{
  const double nan = std::nan("");
  const struct
  {
    SurfaceMaterial material;
    const char* message; ///< Empty where the material is fine.
  } cases[] = {
    { { .restitutionModel = RestitutionModel::NormalTangential, .tangentialRestitution = 0.0 },
      "" },
    { { .restitutionModel = RestitutionModel::SpeedDependent, .restitutionSpeed = 0.1 }, "" },
    { { .restitutionModel = RestitutionModel(3) }, "RestitutionModel is 3" },
    { { .restitutionModel = RestitutionModel(-1) }, "RestitutionModel is -1" },
    { { .tangentialRestitution = 1.01 }, "TangentialRestitution is 1.01" },
    { { .tangentialRestitution = -0.1 }, "TangentialRestitution is -0.1" },
    { { .tangentialRestitution = nan }, "TangentialRestitution is nan" },
    { { .restitutionSpeed = 0.0 }, "RestitutionSpeed is 0" },
    { { .restitutionSpeed = -2.0 }, "RestitutionSpeed is -2" },
    { { .restitutionSpeed = INFINITY }, "RestitutionSpeed is inf" },
  };
  for (const auto& [material, message] : cases)
  {
    std::string said;
    try
    {
      material.validate();
    }
    catch (const ParameterError& e)
    {
      said = e.what();
    }
    EXPECT_EQ(said.empty(), std::string(message).empty()) << said;
    EXPECT_NE(said.find(message), std::string::npos) << said << " without " << message;
  }
}

TEST(Surface, DrawsRoughnessByRealisation)
{
  const Roughness rough{ 0.1, 0.2 };
  const Terrain t = makeSlope(
    101, 1.0, [](double, double) { return 0.0; }, {}, rough);
  const Surface a(t, 7, 0), again(t, 7, 0), other(t, 7, 1);
  double sum = 0.0, squares = 0.0, product = 0.0;
  const int n = 101 * 101;
  for (int row = 0; row < 101; ++row)
  {
    for (int column = 0; column < 101; ++column)
    {
      const double z = a.nodeHeight(row, column);
      EXPECT_EQ(z, again.nodeHeight(row, column));
      sum += z;
      squares += z * z;
      product += (z - 0.1) * (other.nodeHeight(row, column) - 0.1);
    }
  }
  const double mean = sum / n;
  // Four standard errors of 10⁴ draws.
  EXPECT_NEAR(mean, 0.1, 4.0 * 0.2 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n - mean * mean), 0.2, 4.0 * 0.2 / std::sqrt(2.0 * n));
  EXPECT_NEAR(product / n, 0.0, 4.0 * 0.04 / std::sqrt(n));
  EXPECT_GE(a.maxHeight(0, 100, 0, 100), 0.1 + largestDeviate * 0.2);
}

TEST(Surface, PatchKnowsRidgesAndFlats)
{
  // A roof: ridge along y at x = 5, smooth elsewhere.
  const Terrain roof = makeSlope(11, 1.0, [](double x, double) { return -std::abs(x - 5.0); });
  SurfacePatch patch;
  gatherPatch(Surface::asSurveyed(roof), 4.2, 5.8, 4.2, 5.8, patch);
  EXPECT_TRUE(patch.covers(4.2, 5.8, 4.2, 5.8));
  ASSERT_FALSE(patch.ridges.empty());
  for (const SurfacePatch::Ridge& r : patch.ridges)
  {
    for (int n : r.nodes)
    {
      EXPECT_EQ(patch.nodes[n].position.x(), 5.0);
    }
  }
  for (const SurfacePatch::Node& n : patch.nodes)
  {
    EXPECT_TRUE(!n.peak || n.position.x() == 5.0);
  }
  // A plane far up and steep has neither, whatever its rounding.
  const Terrain plane =
    makeSlope(41, 0.7, [](double x, double y) { return 3000.0 + 0.577 * x - 1.3 * y; });
  gatherPatch(Surface::asSurveyed(plane), 5.0, 20.0, 5.0, 20.0, patch);
  EXPECT_TRUE(patch.ridges.empty());
}

TEST(Surface, NoGroundIsInABallOverTheLid)
{
  // Waves with a hole: a ball that the lid clears has no node in it, and none is cleared whose box
  // has the hole or the edge in it.
  const auto isHole = [](double x, double y) { return std::hypot(x - 28.0, y - 12.0) < 2.5; };
  const Terrain slope = makeSlope(41, 1.0,
    [&](double x, double y)
    {
      return isHole(x, y) ? std::numeric_limits<double>::quiet_NaN()
                          : 0.5 * x + 2.0 * std::sin(0.4 * x) * std::cos(0.3 * y);
    });
  const Surface surface = Surface::asSurveyed(slope);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(0.0, 40.0), height(0.0, 12.0), size(0.3, 2.0);
  int cleared = 0, low = 0;
  const int count = someOf(4000, 400);
  for (int k = 0; k < count; ++k)
  {
    const Vec3 center(place(random), place(random), 0.0);
    const double half = 4.0, radius = size(random);
    HeightWindow window;
    window.gather(
      surface, center.x() - half, center.x() + half, center.y() - half, center.y() + half);
    const GroundHeightBound lid(window);
    const Vec3 at = center + Vec3(0.5, -0.5, 0.5 * center.x() + height(random));
    double nearest = std::numeric_limits<double>::infinity();
    bool whole = lid.covers(at, radius);
    for (int i = 0; i <= 40; ++i)
    {
      for (int j = 0; j <= 40; ++j)
      {
        const bool inside =
          std::abs(i - at.x()) <= radius + 1.0 && std::abs(j - at.y()) <= radius + 1.0;
        whole = whole && !(inside && isHole(i, j));
        const Vec3 node(i, j, 0.5 * i + 2.0 * std::sin(0.4 * i) * std::cos(0.3 * j));
        nearest = isHole(i, j) ? nearest : std::min(nearest, (node - at).norm());
      }
    }
    if (lid.isUnder(at, radius))
    {
      ++cleared;
      EXPECT_TRUE(whole);
      EXPECT_GT(nearest, radius);
    }
    low += nearest <= radius;
  }
  EXPECT_GT(cleared, count / 4); // both are met
  EXPECT_GT(low, count / 14);
  EXPECT_FALSE(GroundHeightBound().isUnder({ 20.0, 20.0, 1e6 }, 1.0));
}

TEST(Random, IsACounter)
{
  // Pinned: a change here changes every published result.
  EXPECT_EQ(normalDeviate(1, 0, Draw::Roughness, 0), normalDeviate(1, 0, Draw::Roughness, 0));
  EXPECT_NE(normalDeviate(1, 0, Draw::Roughness, 0), normalDeviate(2, 0, Draw::Roughness, 0));
  EXPECT_NE(normalDeviate(1, 0, Draw::Roughness, 0), normalDeviate(1, 1, Draw::Roughness, 0));
  EXPECT_NE(normalDeviate(1, 0, Draw::Roughness, 0), normalDeviate(1, 0, Draw::Restitution, 0));
  EXPECT_NE(normalDeviate(1, 0, Draw::Roughness, 0), normalDeviate(1, 0, Draw::Roughness, 1));
}
