// Embankments and trees as explicit triangles: closed forms, and nothing goes through.

#include "base/errors.h"
#include "piles.h"
#include "slopes.h"
#include "terrain/Obstacles.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kSize = 100.0; // m

/// Level ground at z = 100 m, of 5 m cells.
Terrain level(const SurfaceMaterial& m)
{
  return makePlane(21, kSize, 0.0, 0.0, m);
}

/// Along x through the middle; its points are given so that it has joints.
Embankment dam(double height, double width, double slope)
{
  Embankment e;
  e.feature = 1;
  e.points = { { 20.0, 50.0 }, { 37.0, 50.0 }, { 48.5, 50.0 }, { 80.0, 50.0 } };
  e.height = height;
  e.crestWidth = width;
  e.mountainSlope = e.valleySlope = slope;
  return e;
}

Structures only(const Embankment& e)
{
  Structures s;
  s.embankments = { e };
  return s;
}

SimulationParameters rigidParameters(double endTime)
{
  SimulationParameters p;
  p.endTime = endTime;
  p.rigid = true;
  return p;
}

double auditError(const EnergyAudit& e)
{
  return std::abs(e.numerical) / std::max(e.released, 1.0);
}

} // namespace

TEST(Obstacles, AreClosedMeshesAboveTheGround)
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
TEST(Obstacles, CrestsAreAsHighAsAskedForBesideBends)
{
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  int bunches = 0;
  for (int repeat = 0; repeat < 200; ++repeat)
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
  EXPECT_GT(bunches, 40);
}

/// Whatever line is drawn: it is refused, or no face looks down and no number is lost.
TEST(Obstacles, WildLinesAreBuiltRightOrRefused)
{
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const Terrain ground = makeSlope(101, 1.0,
    [](double x, double y)
    { return 200.0 - 0.3 * x + std::sin(0.7 * y) + std::sin(0.5 * (x + y)); });
  int built = 0;
  for (int repeat = 0; repeat < 10000; ++repeat)
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
  EXPECT_GT(built, 2000);
}

TEST(Obstacles, AnEdgeBetweenPiecesOfAPlaneIsNoFeature)
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

/// A cube dropped flat on the crest comes back as from a plane, on any joint.
TEST(Obstacles, ReboundOnACrestIsThatOnAPlane)
{
  for (const double e : { 1.0, 0.6 })
  {
    Terrain terrain = level(material(e, 0.0));
    terrain.setStructures(only(dam(3.0, 4.0, 1.5)));
    const Terrain plane = level(material(e, 0.0));
    for (const double x : { 37.0, 43.1, 48.6 })
    {
      Rock rock;
      rock.shape = makeShape(Shape::Cube, 1.0);
      rock.position = Vec3(x, 50.0, 105.5); // 2 m over the crest
      const Trajectory t = simulate(terrain, rock, rigidParameters(1.0));
      rock.position.z() -= 3.0;
      const Trajectory flat = simulate(plane, rock, rigidParameters(1.0));
      ASSERT_EQ(t.summary.impacts, 1);
      const double ratio = t.impacts[0].velocityAfter.z() / -t.impacts[0].velocityBefore.z();
      EXPECT_NEAR(ratio, e, 1e-3); // the impact is resolved with eight steps
      EXPECT_NEAR(
        t.impacts[0].velocityAfter.z(), flat.impacts[0].velocityAfter.z(), 1e-3 * std::sqrt(20.0));
      EXPECT_GT(t.impacts[0].cfe, terrain.cfeCapacity());
      EXPECT_LT(auditError(t.summary.energy), 1e-6);
    }
  }
}

/// d = ½ g (sin α − cos α tan φ) t² [METHOD 9.2] on the side, across its internal edges.
TEST(Obstacles, ACubeSlidesDownTheSideAsCoulombSays)
{
  Terrain terrain = level(material(0.8, 10.0));
  Embankment e = dam(12.0, 2.0, 2.0);
  e.material = 1;
  Structures s = only(e);
  s.materials = { material(0.8, 20.0) }; // its own: 1 in 2 is 26.57°
  terrain.setStructures(s);
  const double alpha = std::atan(0.5);
  const Vec3 normal(0.0, std::sin(alpha), std::cos(alpha));
  for (const double x : { 37.0, 43.0, 48.5 })
  {
    Rock rock;
    rock.shape = makeShape(Shape::Cube, 1.0);
    rock.orientation = Quat::FromTwoVectors(Vec3::UnitZ(), normal);
    // 3 m below the crest's edge at y = 51 m.
    rock.position = Vec3(x, 51.0 + 4.0, 112.0 - 2.0) + 0.5 * normal;
    const double time = 1.5;
    const Trajectory t = simulate(terrain, rock, rigidParameters(time));
    const double way =
      0.5 * kGravity * (std::sin(alpha) - std::cos(alpha) * std::tan(radians(20.0))) * time * time;
    // The first step presses the cube down; METHOD 9.2's tolerance of sliding.
    EXPECT_NEAR((t.summary.stop - t.summary.start).norm(), way, 0.01 * way) << x;
    EXPECT_NEAR(t.summary.stop.x(), x, 1e-4) << x; // no edge turns it
    EXPECT_EQ(t.summary.impacts, 0);
  }
}

TEST(Obstacles, AWallStopsASlowRock)
{
  Terrain terrain = makePlane(41, 200.0, radians(25.0), 0.0, material(0.6, 20.0));
  Embankment e;
  e.points = { { 120.0, 60.0 }, { 120.0, 140.0 } };
  e.height = 3.5;
  e.crestWidth = 1.5;
  e.mountainSlope = 0.0;
  e.valleySlope = 0.5;
  terrain.setStructures(only(e));
  Rock rock;
  rock.shape = makeShape(Shape::Icosahedron, 1.0);
  rock.position = Vec3(105.0, 101.3, terrain.elevation(105.0, 101.3) + 1.5);
  rock.velocity = Vec3(6.0, 0.0, 0.0);
  SimulationParameters p = rigidParameters(60.0);
  const Trajectory t = simulate(terrain, rock, p);
  EXPECT_LT(t.summary.stop.x(), 119.3);
  Terrain bare(terrain, terrain.material(), {});
  EXPECT_GT(simulate(bare, rock, p).summary.stop.x(), 125.0);
  EXPECT_LT(auditError(t.summary.energy), 5e-3);
}

namespace
{

/// Shots from `distance` in the plane of x–y; a rock that has come to the far side below the top
/// has gone through.
template <typename Aim, typename Behind>
int shoot(const Terrain& terrain, int count, std::uint64_t seed, Aim&& aim, Behind&& behind)
{
  std::mt19937_64 random(seed);
  std::vector<Rock> rocks;
  for (int k = 0; k < count; ++k)
  {
    Rock rock;
    const auto uniform = [&](double a, double b)
    { return a + (b - a) * (double(random() >> 11) * 0x1p-53); };
    const Shape shapes[] = { Shape::Cube, Shape::Icosahedron, Shape::Octahedron };
    rock.shape = makeShape(shapes[k % 3], std::pow(10.0, uniform(-3.0, 1.0)));
    rock.orientation =
      Quat(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
    rock.angularVelocity = Vec3(uniform(-8, 8), uniform(-8, 8), uniform(-8, 8));
    aim(rock, uniform);
    rocks.push_back(rock);
  }
  SimulationParameters p = rigidParameters(0.45);
  p.outputInterval = 0.02;
  TrajectoryStore store(count, 1);
  runEnsemble(terrain, rocks, p, store);
  int through = 0;
  for (const Trajectory& t : store.trajectories())
  {
    through += std::any_of(t.samples.begin(), t.samples.end(), behind);
    EXPECT_LT(std::abs(t.summary.energy.numerical), 0.02 * t.summary.energy.released)
      << t.summary.rock;
  }
  return through;
}

} // namespace

TEST(Obstacles, NoShotGoesThroughAWall)
{
  Terrain terrain = level(material(0.5, 20.0));
  Embankment e = dam(30.0, 0.5, 0.0); // an upright wall, half a metre thick
  e.points = { { 5.0, 50.0 }, { 33.0, 50.0 }, { 60.0, 50.0 }, { 95.0, 50.0 } };
  terrain.setStructures(only(e));
  const int through = shoot(
    terrain, 10000, 7,
    [](Rock& rock, auto&& uniform)
    {
      rock.position = Vec3(uniform(25, 75), uniform(44, 46.5), uniform(108, 120));
      rock.velocity = Vec3(uniform(-15, 15), uniform(10, 60), uniform(-10, 10));
    },
    [](const Sample& at) { return at.position.y() > 50.0 && at.position.z() < 129.0; });
  EXPECT_EQ(through, 0);
}

TEST(Obstacles, NoShotGoesThroughATree)
{
  Terrain terrain = level(material(0.5, 20.0));
  Structures s;
  Tree tree;
  tree.position = { 50.0, 50.0 };
  tree.diameter = 0.4;
  tree.height = 30.0;
  s.trees = { tree };
  terrain.setStructures(s);
  // At the axis: what goes through keeps its way, what is stopped is turned off it.
  const int through = shoot(
    terrain, 10000, 8,
    [](Rock& rock, auto&& uniform)
    {
      rock.position = Vec3(50.0, uniform(44, 46), uniform(108, 120));
      rock.velocity = Vec3(0.0, uniform(10, 60), uniform(-10, 10));
      rock.angularVelocity.setZero();
    },
    [](const Sample& at)
    {
      return std::abs(at.position.x() - 50.0) < 0.05 && at.position.y() > 50.25 &&
        at.position.z() < 129.0;
    });
  EXPECT_EQ(through, 0);
}

// Whatever its shape and spin, a rock goes on as if stems of no capacity were not there: none
// carries it for a step before it breaks.
TEST(Obstacles, AStemWithoutCapacityDoesNotCarry)
{
  std::mt19937 random(31);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const Terrain bare = level(material(0.5, 20.0));
  std::size_t broken = 0;
  for (int k = 0; k < 400; ++k)
  {
    Rock rock;
    if (k % 2 == 0)
    {
      rock.shape = makeShape(Shape::Tetrahedron, 0.7);
    }
    else
    {
      rock.shape = makeBox(Vec3(0.15, 0.15, 3.0)).centred();
    }
    rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
    rock.position = Vec3(40.0, 50.0 + u(random), 112.0);
    rock.velocity = Vec3(30.0 + 15.0 * u(random), 0.0, 2.0);
    rock.angularVelocity = 20.0 * Vec3(u(random), u(random), u(random));
    Structures s;
    for (int i = 0; i < 4; ++i)
    {
      Tree tree;
      tree.feature = i;
      tree.position = { 45.0 + 3.0 * i, 50.0 + u(random) };
      tree.diameter = 0.5 + 0.3 * u(random);
      tree.height = 25.0;
      tree.capacity = 0.0;
      s.trees.push_back(tree);
    }
    Terrain forest = bare;
    forest.setStructures(s);
    SimulationParameters p = rigidParameters(0.5);
    p.endTime = 0.5; // before it comes to the ground
    const Trajectory through = simulate(forest, rock, p), free = simulate(bare, rock, p);
    broken += through.structures.size();
    EXPECT_LT((through.summary.stop - free.summary.stop).norm(), 1e-6) << "case " << k;
    EXPECT_NEAR(through.summary.energy.restitution, 0.0, 1e-9) << "case " << k;
  }
  EXPECT_GT(broken, 400u);
}

TEST(Obstacles, ATreeBreaksForMoreThanItsCapacityOnly)
{
  for (const double speed : { 15.0, 25.0 })
  {
    Terrain terrain = level(material(0.5, 20.0));
    Structures s;
    Tree tree;
    tree.feature = 7;
    tree.position = { 50.0, 50.0 };
    tree.diameter = 0.3;
    tree.capacity = stemCapacity(0.3);
    s.trees = { tree };
    EXPECT_NEAR(tree.capacity, 99.8e3, 0.2e3); // 38.7 · 30^2.31
    terrain.setStructures(s);
    Rock rock;
    rock.density = 1000.0;
    rock.shape = makeShape(Shape::Cube, 0.5);
    rock.position = Vec3(47.0, 50.0, 110.0);
    rock.velocity = Vec3(speed, 0.0, 0.0);
    const Trajectory t = simulate(terrain, rock, rigidParameters(0.5));
    const double energy = 0.5 * 500.0 * speed * speed; // 56 and 156 kJ
    if (energy < tree.capacity)
    {
      EXPECT_TRUE(t.structures.empty());
      EXPECT_LT(t.summary.stop.x(), 49.5);
      continue;
    }
    ASSERT_EQ(t.structures.size(), 1u);
    const StructureEvent& event = t.structures[0];
    EXPECT_EQ(event.outcome, StructureOutcome::TreeBroken);
    EXPECT_EQ(event.feature, 7);
    // What it has fallen by then adds m g h: less than 2 %.
    EXPECT_NEAR(event.kineticEnergy, energy, 0.02 * energy);
    EXPECT_NEAR(event.energyTaken, tree.capacity, 1e-6);
    EXPECT_NEAR(t.summary.energy.structures, tree.capacity, 1e-6 * tree.capacity);
    EXPECT_GT(t.summary.stop.x(), 52.0);
    EXPECT_LT(auditError(t.summary.energy), 1e-9);
  }
}

/// A forest changes nothing for a rock that passes beside it, and the bits do not depend on
/// threads.
TEST(Obstacles, ResultsAreTheSameForAnyThreads)
{
  Terrain terrain = makePlane(41, 400.0, radians(35.0), 0.0, material(0.7, 20.0));
  Structures s;
  std::mt19937_64 random(3);
  for (int k = 0; k < 4000; ++k)
  {
    Tree tree;
    tree.position = { 100.0 + 200.0 * (double(random() >> 11) * 0x1p-53),
      100.0 + 200.0 * (double(random() >> 11) * 0x1p-53) };
    tree.capacity = k % 2 == 0 ? 2e4 : 1e9;
    s.trees.push_back(tree);
  }
  terrain.setStructures(s);
  std::vector<Rock> rocks(24);
  for (int k = 0; k < 24; ++k)
  {
    rocks[k].shape = makeShape(Shape::Icosahedron, 0.3);
    rocks[k].position = Vec3(90.0, 110.0 + 7.0 * k, terrain.elevation(90.0, 110.0 + 7.0 * k) + 3.0);
    rocks[k].velocity = Vec3(8.0, 0.0, 0.0);
  }
  std::vector<std::uint64_t> hashes[2];
  std::size_t broken = 0;
  for (int run = 0; run < 2; ++run)
  {
    SimulationParameters p = rigidParameters(12.0);
    p.threads = run == 0 ? 1 : 4;
    TrajectoryStore store(24, 1);
    runEnsemble(terrain, rocks, p, store);
    for (const Trajectory& t : store.trajectories())
    {
      hashes[run].push_back(t.summary.hash);
      broken += t.structures.size();
      EXPECT_LT(auditError(t.summary.energy), 5e-3);
    }
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_GT(broken, 0u);
}

/// Cubes that rest against a stem are driven into it by a boulder: what its springs hold when it
/// breaks is a part of what it takes.
TEST(Obstacles, AStemThatBreaksInASqueezeTakesItsCapacity)
{
  const double angle = radians(35.0), capacity = 2e4;
  const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
  Pile pile;
  pile.ground = makePlane(81, 160.0, angle, 0.0, material(0.3, 15.0));
  Structures structures;
  Tree& stem = structures.trees.emplace_back();
  stem.feature = 1;
  stem.position = { 100.0, 80.0 };
  stem.diameter = 0.5;
  stem.height = 10.0;
  stem.capacity = capacity;
  pile.ground.setStructures(structures);
  for (int k = 0; k < 5; ++k)
  {
    const double edge = k == 4 ? 1.5 : 0.6, x = k == 4 ? 20.0 : 98.8 - 0.65 * k;
    Rock rock = brick(Vec3::Constant(edge), Vec3::Zero(), k);
    rock.orientation = Quat::FromTwoVectors(Vec3::UnitZ(), normal);
    rock.position =
      Vec3(x, 80.0, 100.0 - (x - 80.0) * std::tan(angle)) + (0.5 * edge + 0.001) * normal;
    pile.rocks.push_back(rock);
  }
  pile.parameters.endTime = 40.0;
  pile.parameters.rockFrictionAngle = radians(20.0);
  pile.make();
  for (const Trajectory& t : pile.fall->run())
  {
    ASSERT_EQ(t.structures.size(), 1u);
    EXPECT_NEAR(t.summary.energy.structures, capacity, 1e-9 * capacity);
    // Rounding, over some thousand steps.
    EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-9 * t.summary.energy.released);
  }
}

TEST(Obstacles, RefuseWhatCannotBeBuilt)
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
