// The meshes of embankments: closed, as high as asked for, or refused.

#include "base/errors.h"
#include "dams.h"
#include "form.h"
#include "terrain/Obstacles.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

TEST(Embankments, AreClosedMeshesAboveTheGround)
{
  Terrain terrain = makeSlope(
    41, 5.0, [](double x, double y) { return 100.0 + 0.3 * x + 2.0 * std::sin(0.1 * y); });
  Embankment e;
  e.points = { { 40.0, 40.0 }, { 90.0, 60.0 }, { 100.0, 120.0 }, { 160.0, 130.0 } };
  e.height = 4.0;
  e.crestWidth = 1.0;
  e.mountainSlope = 0.5;
  e.valleySlope = 1.25;
  terrain.setStructures(only(e));
  const ObstacleMesh& mesh = terrain.obstacles()->mesh();
  int open = 0;
  for (const ObstacleMesh::Triangle& t : mesh.triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      if (t.neighbours[k] < 0)
      {
        // Only feet are open, and they are under the ground.
        ++open;
        const Vec3& p = mesh.nodes[t.nodes[k]].position;
        EXPECT_LT(p.z(), terrain.elevation(p.x(), p.y()) - 0.4);
      }
      else
      {
        const auto& back = mesh.triangles[t.neighbours[k]].neighbours;
        EXPECT_EQ(std::count(back.begin(), back.end(), &t - mesh.triangles.data()), 1);
      }
    }
  }
  EXPECT_GT(open, 2 * 3 + 2); // the crest follows the ground
  // The mountain side (uphill, towards larger x on the first piece, so on its right) has the slope
  // that was asked for.
  const Eigen::Vector2d right = Eigen::Vector2d(20.0, -50.0).normalized();
  int sides = 0;
  for (const ObstacleMesh::Triangle& t : mesh.triangles)
  {
    const double out = right.dot(t.normal.head<2>());
    if (out > 0.5 && t.normal.z() > 0.1 && mesh.nodes[t.nodes[0]].position.x() < 80.0)
    {
      ++sides;
      EXPECT_NEAR(t.normal.z() / out, 0.5, 0.05);
    }
  }
  EXPECT_GT(sides, 2);
}

/// On rough ground, with bends, the crest is as high over the ground as was asked for all along its
/// axis, and no face looks down: on the inner sides of bends there is less room than stations.
TEST(Embankments, CrestsAreAsHighAsAskedForBesideBends)
{
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  int bunches = 0;
  for (int repeat = 0; repeat < someOf(200, 20); ++repeat)
  {
    const double waves[] = { 0.3 + u(random), 0.3 + u(random), 6.3 * u(random), 6.3 * u(random) };
    const double roughness = u(random), fall = 0.4 * u(random);
    const Terrain ground = makeSlope(121, 1.0,
      [&](double x, double y)
      {
        return 200.0 - fall * x + roughness * std::sin(waves[0] * y + waves[2]) +
          roughness * std::sin(waves[1] * (x + y) + waves[3]);
      });
    Embankment e;
    e.height = 2.0 + 3.0 * u(random);
    e.crestWidth = 0.5 + 3.0 * u(random);
    e.mountainSlope = u(random) < 0.2 ? 0.0 : 1.5 * u(random);
    e.valleySlope = u(random) < 0.2 ? 0.0 : 1.5 * u(random);
    double direction = 1.57;
    e.points = { { 50.0, 30.0 } };
    for (int k = 0; k < 3; ++k)
    {
      e.points.push_back(
        e.points.back() + 20.0 * Eigen::Vector2d(std::cos(direction), std::sin(direction)));
      direction += 1.2 * (u(random) - 0.5);
    }
    ObstacleMesh mesh;
    addEmbankment(e, ground, mesh);
    double lowest = 10.0, highest = 0.0;
    for (const ObstacleMesh::Triangle& t : mesh.triangles)
    {
      EXPECT_GT(t.normal.z(), -1e-9) << repeat;
    }
    const auto top = [&](double x, double y)
    {
      double z = -1.0;
      for (const ObstacleMesh::Triangle& t : mesh.triangles)
      {
        const Vec3 &a = mesh.nodes[t.nodes[0]].position, &b = mesh.nodes[t.nodes[1]].position,
                   &c = mesh.nodes[t.nodes[2]].position;
        const double area = (b - a).head<2>().x() * (c - a).y() - (b - a).y() * (c - a).x();
        const double v = ((x - a.x()) * (c - a).y() - (y - a.y()) * (c - a).x()) / area;
        const double w = ((b - a).x() * (y - a.y()) - (b - a).y() * (x - a.x())) / area;
        if (area > 1e-9 && v >= -1e-9 && w >= -1e-9 && v + w <= 1.0 + 1e-9)
        {
          z = std::max(z, a.z() + v * (b - a).z() + w * (c - a).z());
        }
      }
      return z;
    };
    for (std::size_t k = 0; k + 1 < e.points.size(); ++k)
    {
      for (double f = 0.003; f < 1.0; f += 0.0083)
      {
        const Eigen::Vector2d p = (1.0 - f) * e.points[k] + f * e.points[k + 1];
        const double over = top(p.x(), p.y()) - ground.elevation(p.x(), p.y());
        lowest = std::min(lowest, over / e.height);
        highest = std::max(highest, over / e.height);
      }
    }
    // A station where the crest would be off by 5 %, looked for four times a cell.
    EXPECT_NEAR(lowest, 1.0, 0.07) << repeat;
    EXPECT_NEAR(highest, 1.0, 0.07) << repeat;
    // Strings of unlike lengths.
    std::size_t feet = 0;
    for (const ObstacleMesh::Node& n : mesh.nodes)
    {
      feet += n.position.z() < ground.elevation(n.position.x(), n.position.y());
    }
    bunches += 5 * feet < 2 * mesh.nodes.size();
  }
  EXPECT_GT(bunches, someOf(40, 0));
}

/// Whatever line is drawn: it is refused, or no face looks down and no number is lost.
TEST(Embankments, WildLinesAreBuiltRightOrRefused)
{
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const Terrain ground = makeSlope(101, 1.0,
    [](double x, double y)
    { return 200.0 - 0.3 * x + std::sin(0.7 * y) + std::sin(0.5 * (x + y)); });
  int built = 0;
  for (int repeat = 0; repeat < someOf(10000, 2000); ++repeat)
  {
    Embankment e;
    e.height = 0.3 + 5.0 * u(random);
    e.crestWidth = 0.2 + 5.0 * u(random);
    e.mountainSlope = u(random) < 0.2 ? 0.0 : 2.0 * u(random);
    e.valleySlope = u(random) < 0.2 ? 0.0 : 2.0 * u(random);
    Eigen::Vector2d p(30.0 + 40.0 * u(random), 30.0 + 40.0 * u(random));
    e.points = { p };
    for (int k = 1 + int(5.0 * u(random)); k > 0; --k)
    {
      const double length = u(random) < 0.3 ? 0.5 : 20.0;
      const double east = u(random) - 0.5, north = u(random) - 0.5;
      p += length * Eigen::Vector2d(east, north);
      e.points.push_back(p);
    }
    ObstacleMesh mesh;
    try
    {
      addEmbankment(e, ground, mesh);
    }
    catch (const DataError&)
    {
      continue;
    }
    ++built;
    for (const ObstacleMesh::Triangle& t : mesh.triangles)
    {
      EXPECT_GE(t.normal.z(), -1e-9) << repeat; // not of a number that is none
    }
  }
  EXPECT_GT(built, someOf(2000, 400));
}

TEST(Embankments, AnEdgeBetweenPiecesOfAPlaneIsNoFeature)
{
  Terrain terrain = level(material(1.0, 0.0));
  terrain.setStructures(only(dam(3.0, 4.0, 1.5)));
  const ObstacleMesh& mesh = terrain.obstacles()->mesh();
  int ridges = 0;
  for (const ObstacleMesh::Triangle& t : mesh.triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      ridges += t.bends[k] > 0;
      EXPECT_GE(t.bends[k], 0);
    }
  }
  // Two edges of the crest in three pieces, and four edges around each end: each on two triangles.
  EXPECT_EQ(ridges, 2 * (2 * 3 + 2 * 4));
}

TEST(Embankments, RefuseWhatCannotBeBuilt)
{
  const auto message = [](const Embankment& e, double angle)
  {
    Terrain terrain = makePlane(21, kSize, radians(angle), 0.5 * std::numbers::pi, {});
    try
    {
      terrain.setStructures(only(e));
    }
    catch (const Error& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto has = [](const std::string& text, const std::string& part)
  { return text.find(part) != std::string::npos; };
  EXPECT_EQ(message(dam(3.0, 1.0, 1.5), 20.0), "");
  EXPECT_TRUE(has(message(dam(-3.0, 1.0, 1.5), 0.0), "height of the embankment is -3"));
  EXPECT_TRUE(has(message(dam(3.0, 0.0, 1.5), 0.0), "width of the crest is 0"));
  EXPECT_TRUE(has(message(dam(3.0, 1.0, -1.0), 0.0), "slope of a side is -1"));
  EXPECT_TRUE(has(message(dam(3.0, 1.0, 1.5), 35.0), "comes to the edge of the terrain"));
  Embankment e = dam(3.0, 1.0, 1.5);
  e.points.back().x() = 500.0;
  EXPECT_TRUE(has(message(e, 0.0), "no ground"));
  e = dam(3.0, 1.0, 1.5);
  e.elevation = 40.0;
  EXPECT_TRUE(has(message(e, 0.0), "under the ground all along"));
  e = dam(3.0, 1.0, 1.5);
  e.points = { { 20.0, 50.0 }, { 50.0, 50.0 }, { 20.0, 50.5 } };
  EXPECT_TRUE(has(message(e, 0.0), "turns back on itself"));
  e.points = { { 20.0, 50.0 }, { 22.0, 50.0 }, { 22.0, 52.0 }, { 20.0, 52.0 } };
  EXPECT_TRUE(has(message(e, 0.0), "fold over themselves"));
  // A hook at the end that is shorter than the crest is wide.
  e = dam(4.852, 0.656, 0.0);
  e.points = { { 50.0, 50.0 }, { 49.7, 50.0 }, { 49.5, 50.4 }, { 49.8, 50.4 }, { 57.8, 42.2 } };
  EXPECT_TRUE(has(message(e, 0.0), "fold over themselves"));
}
