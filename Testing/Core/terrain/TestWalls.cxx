// Where the ground ends at a hole of nodata it goes down in an upright wall: its rim carries what
// stands over it as long as that is balanced, and nothing gets into the ground from the hole.

#include "bruteForce.h"
#include "form.h"
#include "piles.h"
#include "rock/placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

using Vec2 = Eigen::Vector2d;

constexpr double kLevel = 20.0; // of level ground, m

/// Level ground of 21 × 21 m, without the nodes of which `hole` is true.
Terrain levelWithout(const std::function<bool(double, double)>& hole, double cellSize = 1.0)
{
  return makeSlope(
    int(std::lround(20.0 / cellSize)) + 1, cellSize,
    [&](double x, double y)
    { return hole(x, y) ? std::numeric_limits<double>::quiet_NaN() : kLevel; },
    material(0.5, 30.0));
}

/// How much of what is 1 cm around a place is ground, of 16.
int groundAround(const Terrain& terrain, double x, double y)
{
  int count = 0;
  for (int k = 0; k < 16; ++k)
  {
    const double angle = radians(22.5 * k);
    count += terrain.cfeAt(x + 0.01 * std::cos(angle), y + 0.01 * std::sin(angle)) != 0;
  }
  return count;
}

/// A unit cube on level ground.
Rock cubeAt(double x, double y, double turned = 0.0)
{
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.orientation = Quat(Eigen::AngleAxisd(turned, Vec3::UnitZ()));
  rock.position = Vec3(x, y, kLevel + 0.5);
  return rock;
}

/// How far it goes within some time, m, without being taken for at rest.
double wayOf(const Terrain& terrain, const Rock& rock, double duration)
{
  Pile pile;
  pile.ground = terrain;
  pile.rocks = { rock };
  pile.parameters.endTime = 2.0 * duration;
  pile.start();
  const std::vector<Vec3> from = pile.places();
  double way = 0.0;
  while (pile.fall->time() < duration && way < 0.5 && pile.fall->advance())
  {
    way = std::max(way, pile.drift(from));
  }
  return way;
}

/// Of its kinetic energy and its height, J: what the numerics made of nothing.
double gained(const Trajectory& trajectory)
{
  return -trajectory.summary.energy.numerical;
}

/// Numbers with a fixed seed.
struct Numbers
{
  std::mt19937 random;
  double operator()(double a, double b)
  {
    return std::uniform_real_distribution<double>(a, b)(random);
  }
  Quat attitude()
  {
    std::normal_distribution<double> n;
    return Quat(n(random), n(random), n(random), n(random)).normalized();
  }
  Polyhedron shape(int kind, double volume)
  {
    const Shape shapes[] = { Shape::Cube, Shape::Tetrahedron, Shape::Icosahedron, Shape::Eota221 };
    if (kind % 5 < 4)
    {
      return makeShape(shapes[kind % 5], volume);
    }
    std::vector<Vec3> points(10);
    for (Vec3& p : points)
    {
      p = Vec3((*this)(-1, 1), (*this)(-1, 1), (*this)(-1.5, 1.5));
    }
    return Polyhedron::convexHull(points).centred().withVolume(volume);
  }
};

/// How deep a point is in the ground, by the shortest way straight up or level, m.
double depthInGround(const Surface& surface, const Vec3& p)
{
  double depth = surface.elevation(p.x(), p.y()) - p.z();
  if (!(depth > 0.0))
  {
    return 0.0; // over it, or over a hole
  }
  for (int k = 0; k < 32; ++k)
  {
    const Vec2 direction(std::cos(k * radians(11.25)), std::sin(k * radians(11.25)));
    for (double way = 0.02 * depth; way < depth; way += 0.02 * depth)
    {
      const double z = surface.elevation(p.x() + way * direction.x(), p.y() + way * direction.y());
      depth = !(z > p.z()) ? way : depth;
    }
  }
  return depth;
}

/// Where a rock got to, and how deep (in radii) any vertex of it ever was in the ground, or a node
/// of the ground in it. A node whose triangles all touch nodata is none.
struct Run
{
  Trajectory trajectory;
  double deepest = 0.0;
};

Run watch(const Terrain& terrain, const Rock& rock, double endTime)
{
  Pile pile;
  pile.ground = terrain;
  pile.rocks = { rock };
  pile.parameters.endTime = endTime;
  pile.awake = false;
  pile.make();
  const GridGeometry& g = terrain.geometry();
  PlacedBlock placed;
  Run run;
  const auto look = [&](double)
  {
    placed.place(pile.blocks[0], pile.fall->state(0));
    for (const Vec3& p : placed.vertices())
    {
      run.deepest = std::max(run.deepest, depthInGround(*pile.surface, p));
    }
    const Vec3 lower = placed.lower() / g.cellSize, upper = placed.upper() / g.cellSize;
    for (int x = std::max(0, int(lower.x())); x <= upper.x() && x < g.columns; ++x)
    {
      for (int y = std::max(0, int(lower.y())); y <= upper.y() && y < g.rows; ++y)
      {
        const Vec3 node = terrain.node(g.rows - 1 - y, x);
        if (!std::isnan(node.z()) && groundAround(terrain, node.x(), node.y()) > 0)
        {
          run.deepest =
            std::max(run.deepest, -placed.faceDistance(placed.outermostFace(node), node));
        }
      }
    }
    return true;
  };
  run.trajectory = pile.fall->run(look).front();
  run.deepest /= pile.blocks[0].radius();
  return run;
}

} // namespace

TEST(Walls, CubesThatOverhangByLessThanHalfStand)
{
  // `out`: the direction in which the hole lies from (10, 10).
  struct Side
  {
    std::function<bool(double, double)> hole;
    Vec2 out;
    double turned;
  };
  const double half = std::sqrt(0.5), eighth = radians(45.0);
  const Side sides[] = {
    { [](double x, double) { return x > 10.1 && x < 18.0; }, { 1.0, 0.0 }, 0.0 },
    { [](double x, double) { return x < 9.9 && x > 2.0; }, { -1.0, 0.0 }, 0.0 },
    { [](double, double y) { return y > 10.1 && y < 18.0; }, { 0.0, 1.0 }, 0.0 },
    { [](double, double y) { return y < 9.9 && y > 2.0; }, { 0.0, -1.0 }, 0.0 },
    // Along the diagonals of the cells, and across them in steps.
    { [](double x, double y) { return x + y > 20.1; }, { half, half }, eighth },
    { [](double x, double y) { return x + y < 19.9; }, { -half, -half }, eighth },
    { [](double x, double y) { return x > y + 0.1; }, { half, -half }, eighth },
    // Corners of the ground and of the hole.
    { [](double x, double y) { return x > 10.1 || y > 10.1; }, { half, half }, 0.0 },
    { [](double x, double y) { return x > 10.1 && y > 10.1; }, { half, half }, 0.0 },
    // On to the edge of the DEM, and askew.
    { [](double x, double) { return x > 10.1; }, { 1.0, 0.0 }, 0.0 },
    { [](double x, double) { return x > 10.1 && x < 18.0; }, { 1.0, 0.0 }, radians(30.0) },
  };
  for (const double cellSize : { 0.5, 1.0, 5.0 })
  {
    for (const Side& side : sides)
    {
      const Terrain terrain = levelWithout(side.hole, cellSize);
      for (const double inside : { 0.4, 0.2, 0.05, 0.005 })
      {
        const Vec2 p = Vec2(10.0, 10.0) - inside * side.out;
        EXPECT_LT(wayOf(terrain, cubeAt(p.x(), p.y(), side.turned), 10.0), 1e-3)
          << cellSize << " m, out " << side.out.transpose() << ", inside " << inside;
      }
    }
  }
}

TEST(Walls, CubesThatSlideOutByMoreThanHalfTipIn)
{
  // On slippery ground, from so far inside that they come to rest before or only beyond half.
  const double speed = 0.3, friction = 1.0;
  const double way = speed * speed / (2.0 * kGravity * std::tan(radians(friction)));
  for (const double cellSize : { 0.5, 1.0, 5.0 })
  {
    for (const double azimuth : { 0.0, 45.0, 90.0, 180.0, 225.0, 270.0 })
    {
      const Vec2 out(std::cos(radians(azimuth)), std::sin(radians(azimuth)));
      const Terrain terrain = makeSlope(
        int(std::lround(20.0 / cellSize)) + 1, cellSize,
        [&](double x, double y)
        {
          const double beyond = out.dot(Vec2(x - 10.0, y - 10.0));
          return beyond > 0.1 ? std::numeric_limits<double>::quiet_NaN() : kLevel;
        },
        material(0.5, friction));
      for (const double inside : { 0.5 * way, way + 0.05 })
      {
        const Vec2 p = Vec2(10.0, 10.0) - inside * out;
        Rock rock = cubeAt(p.x(), p.y(), radians(azimuth));
        rock.velocity = speed * Vec3(out.x(), out.y(), 0.0);
        SimulationParameters parameters;
        parameters.endTime = 20.0;
        const Trajectory trajectory = simulate(terrain, rock, parameters);
        const TrajectorySummary& end = trajectory.summary;
        EXPECT_EQ(end.fate, inside < way ? Fate::LeftDomain : Fate::Rested)
          << cellSize << " m, to " << azimuth << ", inside " << inside;
        if (inside > way)
        {
          EXPECT_NEAR(out.dot(Vec2(end.stop.x() - p.x(), end.stop.y() - p.y())), way, 0.03);
          EXPECT_NEAR(end.stop.z(), kLevel + 0.5, 1e-3);
        }
        else
        {
          EXPECT_LT(end.stop.z(), kLevel);
          EXPECT_GT(out.dot(Vec2(end.stop.x() - 10.0, end.stop.y() - 10.0)), 0.0);
        }
        EXPECT_GT(end.energy.numerical, -1e-3 * end.energy.released);
      }
    }
  }
}

/// Any cube over any holes, level and tilted, if its centroid is over ground.
TEST(Walls, WhatIsBalancedStands)
{
  Numbers number{ std::mt19937(11) };
  int stand = 0;
  for (int k = 0; k < 300; ++k)
  {
    const double share = k % 3 == 0 ? 0.05 : 0.3;
    const double angle = k % 4 < 2 ? 0.0 : radians(15.0), azimuth = number(-3.0, 3.0);
    const Terrain plane =
      makePlane(k % 2 == 0 ? 41 : 21, 20.0, angle, azimuth, material(0.5, 40.0));
    const GridGeometry& g = plane.geometry();
    const Terrain terrain = makeSlope(
      g.columns, g.cellSize,
      [&](double x, double y)
      {
        return number(0.0, 1.0) < share ? std::numeric_limits<double>::quiet_NaN()
                                        : plane.elevation(x, y);
      },
      plane.material());
    Rock rock = cubeOnPlane(20.0, angle, azimuth, 0.0);
    rock.orientation = rock.orientation * Eigen::AngleAxisd(number(0.0, 1.5), Vec3::UnitZ());
    const double dx = number(-8.0, 8.0), dy = number(-8.0, 8.0);
    rock.position +=
      Vec3(dx, dy, plane.elevation(10.0 + dx, 10.0 + dy) - plane.elevation(10.0, 10.0));
    if (groundAround(terrain, rock.position.x(), rock.position.y()) < 16)
    {
      continue;
    }
    ++stand;
    EXPECT_LT(wayOf(terrain, rock, 5.0), 1e-3) << k;
  }
  EXPECT_GT(stand, 100);
}

TEST(Walls, WhatFallsBesideAndOnThemDoesNotGetIntoTheGround)
{
  Numbers number{ std::mt19937(5) };
  const int count = someOf(300, 30);
  int left = 0, rested = 0;
  for (int k = 0; k < count; ++k)
  {
    const double share = k % 2 == 0 ? 0.02 : 0.15;
    const double tilt = number(0.0, 0.6), rough = k % 3 == 0 ? 0.0 : 0.3;
    const Terrain ground = makeSlope(
      41, k % 4 < 2 ? 0.7 : 2.0,
      [&](double x, double)
      {
        const double z = 60.0 - tilt * x + number(-rough, rough);
        return number(0.0, 1.0) < share ? std::numeric_limits<double>::quiet_NaN() : z;
      },
      material(0.5, 30.0));
    Rock rock;
    rock.shape = number.shape(k, number(0.1, 2.0));
    rock.orientation = number.attitude();
    const double size = ground.width();
    rock.position = Vec3(size * number(0.3, 0.6), size * number(0.3, 0.6), 0.0);
    rock.position.z() = touchingHeight(Surface::asSurveyed(ground), rock.shape, rock.orientation,
      rock.position.x(), rock.position.y());
    if (std::isnan(rock.position.z()))
    {
      continue;
    }
    rock.position.z() += number(0.01, 3.0);
    rock.velocity = Vec3(number(-4, 4), number(-4, 4), number(-4, 0));
    rock.angularVelocity = Vec3(number(-3, 3), number(-3, 3), number(-3, 3));
    const auto& [trajectory, depth] = watch(ground, rock, 10.0);
    EXPECT_LT(depth, 0.1) << k;
    left +=
      trajectory.summary.fate == Fate::LeftDomain || trajectory.summary.fate == Fate::LostInNodata;
    rested += trajectory.summary.fate == Fate::Rested;
    const EnergyAudit& e = trajectory.summary.energy;
    EXPECT_LT(gained(trajectory), 1e-2 * e.released) << k;
  }
  EXPECT_GT(left, someOf(30, 1));
  EXPECT_GT(rested, someOf(50, 2));
}

/// The line of an edge may pass behind an upright ridge whose top is still clear of the rock.
TEST(Walls, WhatIsOverACornerOfTheGroundHasNotItsRidgeBesideIt)
{
  const Terrain terrain = levelWithout([](double x, double y) { return x > 10.1 || y > 10.1; });
  const Surface surface = Surface::asSurveyed(terrain);
  const Vec3 top(10.0, 10.0, kLevel);
  SurfacePatch patch;
  gatherPatch(surface, 7.0, 13.0, 7.0, 13.0, patch);
  ASSERT_GT(patch.wallTriangles, 0);
  Numbers number{ std::mt19937(17) };
  const Polyhedron shape = makeShape(Shape::Tetrahedron, 1.0);
  const Block block(shape, 2700.0, 1e11, 0.2);
  int near = 0;
  for (int k = 0; k < 5000; ++k)
  {
    BlockState state;
    state.orientation = number.attitude();
    // The top is a little under somewhere in a face that looks down.
    const Vec3 normal = state.orientation * shape.normals()[0];
    if (normal.z() > -0.1)
    {
      continue;
    }
    Vec3 inFace = Vec3::Zero();
    double sum = 0.0;
    for (const int v : shape.faces()[0])
    {
      const double share = number(0.0, 1.0);
      inFace += share * shape.vertices()[std::size_t(v)];
      sum += share;
    }
    state.position = top - state.orientation * Vec3(inFace / sum) - number(1e-4, 0.01) * normal;
    PlacedBlock placed;
    placed.place(block, state);
    std::vector<Contact> contacts;
    findEntrancesBruteForce(placed, patch, 0.02, contacts);
    for (const Contact& c : contacts)
    {
      near += c.kind == ContactKind::FaceVertex;
      EXPECT_FALSE(
        c.kind == ContactKind::EdgeEdge && c.distance < 0.0 && std::abs(c.normal.z()) < 1e-9)
        << k << ": " << c.distance << " m";
    }
  }
  EXPECT_GT(near, 200);
}

TEST(Walls, ASlopeAroundAHoleThatIsHigherThanARockDoesNotEndItsRun)
{
  // With nodes higher than the rock within its reach, or within some cells of it, all the same.
  const auto slope = [](double inclination, double x) { return 100.0 - inclination * x; };
  const auto withHole = [&](double inclination, double friction)
  {
    return makeSlope(
      41, 1.0,
      [&, inclination](double x, double y)
      {
        return x == 20.0 && y == 20.0 ? std::numeric_limits<double>::quiet_NaN()
                                      : slope(inclination, x);
      },
      material(0.5, friction));
  };
  // A slab of 3 m slides onto it and comes to rest there.
  const double angle = radians(35.0);
  const Vec3 down(std::cos(angle), 0.0, -std::sin(angle));
  Rock slab;
  slab.shape = makeBox({ 3.0, 3.0, 0.6 });
  slab.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  slab.position = Vec3(18.2, 20.0, slope(std::tan(angle), 18.2)) +
    0.3 * Vec3(std::sin(angle), 0.0, std::cos(angle));
  slab.velocity =
    std::sqrt(2.0 * 1.8 * kGravity * (std::cos(angle) - std::sin(angle)) / std::cos(angle)) * down;
  SimulationParameters p;
  p.endTime = 20.0;
  const Terrain slanting = withHole(std::tan(angle), 45.0);
  const TrajectorySummary slid = simulate(slanting, slab, p).summary;
  EXPECT_EQ(slid.fate, Fate::Rested);
  EXPECT_EQ(slanting.cfeAt(slid.stop.x(), slid.stop.y()), 0);
  EXPECT_NEAR((slid.stop - slab.position).dot(down), 1.8 / std::cos(angle), 0.05);
  // One that flies over it goes on.
  Rock flying;
  flying.shape = makeShape(Shape::Cube, 0.1);
  flying.position = Vec3(12.0, 20.0, slope(1.0, 12.0) + 1.0);
  flying.velocity = Vec3(15.0, 0.0, -15.0);
  const TrajectorySummary flew = simulate(withHole(1.0, 20.0), flying, p).summary;
  EXPECT_TRUE(flew.fate != Fate::LostInNodata || flew.stop.x() > 25.0) << flew.stop.transpose();
}

TEST(Walls, NothingPassesUnderTheFarSideOfAHole)
{
  // Over a hole of 10 m, too slow to reach the other side: against the wall and down.
  const Terrain terrain = levelWithout([](double x, double) { return x > 5.1 && x < 14.9; });
  for (const double speed : { 5.0, 10.0, 15.0, 30.0 })
  {
    Rock rock;
    rock.shape = makeShape(Shape::Eota221, 0.3);
    rock.position = Vec3(4.0, 10.3, kLevel + 1.0);
    rock.velocity = Vec3(speed, 0.0, 0.0);
    SimulationParameters p;
    p.endTime = 20.0;
    const Trajectory trajectory = simulate(terrain, rock, p);
    if (speed < 20.0)
    {
      EXPECT_EQ(trajectory.summary.fate, Fate::LostInNodata) << speed;
      EXPECT_GT(trajectory.summary.stop.x(), 4.5) << speed;
      EXPECT_LT(trajectory.summary.stop.x(), 15.0) << speed;
      EXPECT_LT(trajectory.summary.stop.z(), kLevel) << speed;
    }
    else
    {
      EXPECT_GT(trajectory.summary.stop.x(), 15.0) << speed;
      EXPECT_GT(trajectory.summary.stop.z(), kLevel) << speed;
    }
  }
}

TEST(Walls, AHoleThatARockDoesNotComeNearIsNothingToIt)
{
  Numbers number{ std::mt19937(3) };
  const auto height = [](double x, double y)
  { return 100.0 - 0.7 * x + 0.3 * std::sin(2.1 * x) * std::cos(1.3 * y); };
  const auto bump = [&](double x, double y) { return height(x, y); };
  const Terrain whole = makeSlope(81, 1.0, bump, material(0.5, 30.0));
  const Terrain holed = makeSlope(
    81, 1.0,
    [&](double x, double y)
    { return x > 60.0 || y < 15.0 ? std::numeric_limits<double>::quiet_NaN() : height(x, y); },
    material(0.5, 30.0));
  int compared = 0;
  for (int k = 0; k < 20; ++k)
  {
    Rock rock;
    rock.shape = number.shape(k, 0.5);
    rock.orientation = number.attitude();
    rock.position = Vec3(number(10.0, 20.0), number(30.0, 60.0), 0.0);
    rock.position.z() = height(rock.position.x(), rock.position.y()) + 3.0;
    SimulationParameters p;
    p.endTime = 30.0;
    const Trajectory a = simulate(whole, rock, p), b = simulate(holed, rock, p);
    const std::size_t count = std::min(a.samples.size(), b.samples.size());
    ASSERT_GT(count, 3u);
    for (std::size_t i = 0; i < count; ++i)
    {
      const Vec3& q = a.samples[i].position;
      // A flight is looked at over no more than this at once.
      if (q.x() > 40.0 || q.y() < 30.0)
      {
        break;
      }
      ++compared;
      ASSERT_EQ(q, b.samples[i].position) << k << " at " << a.samples[i].time << " s";
      ASSERT_EQ(a.samples[i].velocity, b.samples[i].velocity) << k;
    }
  }
  EXPECT_GT(compared, 1000);
}
