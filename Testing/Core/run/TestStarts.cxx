// Rocks that are released in an embankment, or in ground that roughness raised, are lifted out of
// it: as far as it takes and no farther, at the rims of holes as well.

#include "base/errors.h"
#include "contact/ground/clearance.h"
#include "contact/ground/features.h"
#include "gisFiles.h"
#include "rock/placement.h"
#include "slopes.h"
#include "terrain/Obstacles.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// Numbers with a fixed seed.
class Numbers
{
public:
  explicit Numbers(unsigned seed)
    : random_(seed)
  {
  }
  double operator()(double a, double b)
  {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  Quat attitude()
  {
    std::normal_distribution<double> n;
    return Quat(n(random_), n(random_), n(random_), n(random_)).normalized();
  }
  /// Any convex shape of this volume.
  Polyhedron shape(int kind, double volume)
  {
    const Shape shapes[] = { Shape::Cube, Shape::Tetrahedron, Shape::Icosahedron, Shape::Eota221 };
    if (kind % 6 < 4)
    {
      return makeShape(shapes[kind % 6], volume);
    }
    if (kind % 6 == 4)
    {
      return makeBox(Vec3(1.0, (*this)(0.3, 1.0), (*this)(0.1, 3.0))).centred().withVolume(volume);
    }
    std::vector<Vec3> points(8);
    for (Vec3& p : points)
    {
      p = Vec3((*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1));
    }
    return Polyhedron::convexHull(points).centred().withVolume(volume);
  }

private:
  std::mt19937 random_;
};

/// An embankment of 3 m along y, over x = 50 m, on ground at 100 m.
Terrain withDam(double slope, double width, std::vector<Eigen::Vector2d> points, double bumps = 0.0)
{
  Terrain terrain = makeSlope(
    51, 2.0,
    [=](double x, double y) { return 100.0 + bumps * std::sin(0.7 * x) * std::cos(0.5 * y); },
    material(0.3, 30.0));
  Embankment e;
  e.feature = 1;
  e.points = std::move(points);
  e.height = 3.0;
  e.crestWidth = width;
  e.mountainSlope = e.valleySlope = slope;
  Structures s;
  s.embankments = { e };
  terrain.setStructures(s);
  return terrain;
}

/// Uneven ground about 5 m high, a fifth of whose nodes have no height.
Terrain withHoles(unsigned seed)
{
  Numbers number(seed);
  return makeSlope(
    21, 1.0,
    [&](double, double)
    {
      const double z = 5.0 + number(-0.4, 0.4);
      return number(0.0, 1.0) < 0.2 ? std::numeric_limits<double>::quiet_NaN() : z;
    },
    material(0.5, 30.0));
}

const std::vector<Eigen::Vector2d> straight{ { 50.0, 10.0 }, { 50.0, 90.0 } };
const std::vector<Eigen::Vector2d> bent{ { 50.0, 42.0 }, { 51.0, 50.0 }, { 49.0, 58.0 } };

/// What is under a rock that stands there.
SurfacePatch patchUnder(const Surface& surface, const PlacedBlock& rock)
{
  SurfacePatch patch;
  gatherPatch(
    surface, rock.lower().x(), rock.upper().x(), rock.lower().y(), rock.upper().y(), patch);
  if (const Obstacles* obstacles = surface.terrain().obstacles())
  {
    obstacles->append(rock.lower().x() - 1.0, rock.upper().x() + 1.0, rock.lower().y() - 1.0,
      rock.upper().y() + 1.0, {}, patch);
  }
  return patch;
}

/// Of ground and embankment.
double topAt(const SurfacePatch& patch, const Vec3& p)
{
  double top = -1e300;
  for (const SurfacePatch::Triangle& t : patch.triangles)
  {
    if (t.cfe != 0 && t.normal.z() > 1e-6 && isStraightOver(patch, t, p))
    {
      top = std::max(top, p.z() + (t.offset - t.normal.dot(p)) / t.normal.z());
    }
  }
  return top;
}

/// By separating axes, which know nothing of heights.
bool isClear(const Block& block, BlockState state, double raised, const SurfacePatch& patch)
{
  state.position.z() += raised;
  PlacedBlock rock;
  rock.place(block, state);
  const double forever = std::numeric_limits<double>::infinity();
  return clearance(rock, state, patch, 0.0, forever).distance > 0.0 &&
    state.position.z() > topAt(patch, state.position);
}

} // namespace

TEST(Starts, LiftIsWhatItTakesAndNoMore)
{
  Numbers number(5);
  int lifted = 0, edges = 0;
  for (const double slope : { 0.0, 0.2, 1.5 })
  {
    for (const double width : { 1.0, 4.0 })
    {
      for (const bool bends : { false, true })
      {
        const Terrain terrain = withDam(slope, width, bends ? bent : straight, bends ? 0.4 : 0.0);
        for (int k = 0; k < 120; ++k)
        {
          const Block block(number.shape(k, std::pow(10.0, number(-2.0, 1.5))), 2500.0, 1e10, 0.1);
          BlockState state;
          state.orientation = number.attitude();
          const double off = 0.5 * width + 3.0 * slope + block.radius();
          // Over the ends as well, where it bends.
          state.position =
            Vec3(50.0 + off * number(-1, 1), bends ? number(40.0, 60.0) : number(20.0, 80.0), 0.0);
          state.position.z() = touchingHeight(Surface::asSurveyed(terrain), block.shape(),
                                 state.orientation, state.position.x(), state.position.y()) +
            std::max(0.0, number(-1.0, 2.0));
          PlacedBlock rock;
          rock.place(block, state);
          const SurfacePatch patch = patchUnder(Surface::asSurveyed(terrain), rock);
          const double lift = liftOut(rock, patch), hair = 1e-5 * block.radius();
          const std::string at = "slope " + std::to_string(slope) + " width " +
            std::to_string(width) + (bends ? " bent " : " ") + std::to_string(k);
          EXPECT_TRUE(isClear(block, state, lift + 2.0 * hair, patch)) << at;
          if (lift > 0.0)
          {
            EXPECT_FALSE(isClear(block, state, lift - hair, patch)) << at;
            ++lifted;
            // Commonly no corner of the rock is in the body, and none of the body's in the rock.
            bool seen = false;
            for (const Vec3& v : rock.vertices())
            {
              seen = seen || topAt(patch, v) > v.z();
            }
            for (const SurfacePatch::Node& n : patch.nodes)
            {
              seen = seen || rock.faceDistance(rock.outermostFace(n.position), n.position) < 0.0;
            }
            edges += !seen;
          }
        }
      }
    }
  }
  EXPECT_GT(lifted, 700);
  EXPECT_GT(edges, 20);
}

TEST(Starts, NoRockThatStartsInAnEmbankmentEndsInIt)
{
  Numbers number(9);
  for (const double slope : { 0.0, 0.2, 1.5 })
  {
    for (const double width : { 1.0, 10.0 })
    {
      const Terrain terrain = withDam(slope, width, straight);
      std::vector<Rock> rocks(100);
      for (int k = 0; k < 100; ++k)
      {
        Rock& rock = rocks[std::size_t(k)];
        rock.blockId = k;
        rock.shape = number.shape(k, number(0.1, 2.0));
        rock.orientation = number.attitude();
        const double off = 0.5 * width + number(0.0, 1.0) * (3.0 * slope + rock.shape.radius());
        rock.position = Vec3(50.0 + (k % 2 ? off : -off), 12.0 + 0.76 * k, 0.0);
        rock.position.z() = touchingHeight(Surface::asSurveyed(terrain), rock.shape,
          rock.orientation, rock.position.x(), rock.position.y());
      }
      SimulationParameters p;
      p.endTime = 3.0;
      p.rigid = true;
      TrajectoryStore store(100, 1);
      runEnsemble(terrain, rocks, p, store);
      for (const Trajectory& t : store.trajectories())
      {
        for (const Sample& at : t.samples)
        {
          const double down = 103.0 - at.position.z();
          const bool inside =
            down > 0.0 && std::abs(at.position.x() - 50.0) < 0.5 * width + slope * down;
          ASSERT_FALSE(inside) << "slope " << slope << " width " << width << " rock "
                               << t.summary.blockId << " at " << at.time << " s, "
                               << at.position.transpose();
        }
      }
    }
  }
}

/// A rock beside an upright wall stands on the ground, whatever the last digits of its place.
TEST(Starts, WhatOnlyTouchesAWallStaysDown)
{
  const Terrain terrain = withDam(0.0, 1.0, straight);
  for (const double off : { -1e-8, -1e-15, 0.0, 1e-15, 1e-8, -1e-3 })
  {
    Rock rock;
    rock.shape = makeShape(Shape::Cube, 1.0);
    rock.position = Vec3(49.0 + off, 50.0, 100.5);
    SimulationParameters p;
    p.endTime = 0.1;
    EXPECT_EQ(simulate(terrain, rock, p).samples.front().position, rock.position) << off;
    rock.position.x() = 49.0 + 1e-4;
    EXPECT_NEAR(simulate(terrain, rock, p).samples.front().position.z(), 103.5, 1e-5);
  }
}

/// A slope whose heights, and a rock whose height, were kept in single precision.
TEST(Starts, AHairInTheSlopeByRoundingIsSetOntoIt)
{
  for (const double base : { 0.0, 450.0, 3000.0 })
  {
    const auto height = [&](double x, double) { return base + 60.0 - 0.57 * x; };
    const Terrain terrain = makeSlope(
      11, 10.0, [&](double x, double y) { return double(float(height(x, y))); },
      material(0.5, 30.0));
    const double rounding = 6e-8 * (base + 60.0);
    for (const Shape shape : { Shape::Cube, Shape::Icosahedron, Shape::Tetrahedron })
    {
      for (const double x : { 33.3, 50.0, 61.7 })
      {
        Rock rock;
        rock.shape = makeShape(shape, 1.0);
        rock.position = Vec3(x, 47.0, 0.0);
        const double touching = touchingHeight(Surface::asSurveyed(terrain), rock.shape,
          rock.orientation, rock.position.x(), rock.position.y());
        SimulationParameters p;
        p.endTime = 0.05;
        for (const double deep : { rounding, 0.5 * rounding, 1e-6 })
        {
          rock.position.z() = touching - deep;
          const double start = simulate(terrain, rock, p).samples.front().position.z();
          EXPECT_GE(start, touching - 3e-6) << base << ", " << x << ", " << deep;
          EXPECT_LE(start, touching + 1e-5) << base << ", " << x << ", " << deep;
        }
        // What is no rounding stays an error.
        rock.position.z() = touching - 2e-3;
        EXPECT_THROW(simulate(terrain, rock, p), PlacementError) << base << ", " << x;
      }
    }
  }
}

/// A ridge of the ground cuts an edge of a rock as a crest does.
TEST(Starts, RoughGroundIsClearOfEdgesToo)
{
  Roughness roughness;
  roughness.mean = 0.3;
  roughness.deviation = 0.1;
  const Terrain rough = makeSlope(
    61, 0.5, [](double x, double) { return 40.0 - 0.5 * x; }, material(0.5, 30.0), roughness);
  Numbers number(4);
  for (int k = 0; k < 60; ++k)
  {
    Rock rock;
    rock.shape = number.shape(k, number(0.02, 2.0));
    rock.orientation = number.attitude();
    rock.position = Vec3(number(5.0, 25.0), number(5.0, 25.0), 0.0);
    rock.position.z() = touchingHeight(Surface::asSurveyed(rough), rock.shape, rock.orientation,
      rock.position.x(), rock.position.y());
    SimulationParameters p;
    p.endTime = 0.01;
    p.seed = 3;
    const Block block(rock.shape, 2500.0, 1e10, 0.1);
    BlockState state;
    state.orientation = rock.orientation;
    state.position = simulate(rough, rock, p).samples.front().position;
    PlacedBlock placed;
    placed.place(block, state);
    EXPECT_EQ(liftOut(placed, patchUnder(Surface(rough, p.seed, 0), placed)), 0.0) << k;
    EXPECT_LT(state.position.z() - rock.position.z(), 1.5) << k;
  }
}

TEST(Starts, AnEdgeAcrossARidgeOfTheSlopeIsInsideIt)
{
  // A ridge along y at x = 15 m, 1 in 2 to either side, and a bar across it.
  const Terrain terrain =
    makeSlope(61, 0.5, [](double x, double) { return 40.0 - 0.5 * std::abs(x - 15.0); });
  Rock rock;
  rock.blockId = 5;
  rock.shape = makeBox(Vec3(4.0, 0.3, 0.3)).centred();
  rock.orientation = Quat(Eigen::AngleAxisd(radians(45.0), Vec3::UnitX()));
  rock.position = Vec3(15.0, 15.1, 40.0 + 0.15 * std::sqrt(2.0) - 0.1);
  SimulationParameters p;
  p.endTime = 0.1;
  EXPECT_TRUE(holds(messageOf<PlacementError>([&] { simulate(terrain, rock, p); }),
    { "block 5", "starts inside the slope, by 0.1" }));
  rock.position.z() += 0.1 + 1e-7;
  EXPECT_NO_THROW(simulate(terrain, rock, p));
}

/// A triangle beside nodata ends in an edge that is a ridge of nothing, and cuts rocks as one does.
TEST(Starts, RimsOfHolesAreClearOfEdgesToo)
{
  Numbers number(6);
  int lifted = 0, overHoles = 0;
  for (int k = 0; k < 300; ++k)
  {
    const Terrain terrain = withHoles(1000 + unsigned(k));
    const Surface surface = Surface::asSurveyed(terrain);
    const Block block(number.shape(k, number(0.05, 1.0)), 2500.0, 1e10, 0.1);
    BlockState state;
    state.orientation = number.attitude();
    // Over the outer edge as well.
    state.position = Vec3(number(0.0, 20.0), number(0.0, 20.0), 0.0);
    const double touching = touchingHeight(
      surface, block.shape(), state.orientation, state.position.x(), state.position.y());
    const bool hole = std::isnan(touching);
    state.position.z() = hole ? 5.0 : touching;
    state.position.z() -= number(0.0, 0.8) * block.radius();
    PlacedBlock rock;
    rock.place(block, state);
    const SurfacePatch patch = patchUnder(surface, rock);
    const double lift = liftOut(rock, patch), hair = 1e-5 * block.radius();
    EXPECT_TRUE(isClear(block, state, lift + 2.0 * hair, patch)) << k;
    if (lift > 0.0)
    {
      EXPECT_FALSE(isClear(block, state, lift - hair, patch)) << k;
      ++lifted;
      overHoles += hole;
    }
    if (!hole)
    {
      // What was set down is clear, but for what of it is beyond the outer edge.
      const Vec3 &low = rock.lower(), &high = rock.upper();
      if (low.x() > 0.0 && low.y() > 0.0 && high.x() < 20.0 && high.y() < 20.0)
      {
        EXPECT_TRUE(isClear(block, state, touching - state.position.z() + 2.0 * hair, patch)) << k;
        EXPECT_NEAR(state.position.z() + lift, touching, hair) << k;
      }
    }
  }
  EXPECT_GT(lifted, 200);
  EXPECT_GT(overHoles, 50);
}

TEST(Starts, ABarOverARimLeansOnIt)
{
  // Level ground at 20 m with a hole from x = 8 m on, and a bar on an edge that dips into it by
  // 30°.
  const Terrain terrain = makeSlope(21, 1.0,
    [](double x, double y)
    {
      const bool hole = x > 8.5 && x < 14.5 && y > 6.5 && y < 14.5;
      return hole ? std::numeric_limits<double>::quiet_NaN() : 20.0;
    });
  const double dip = radians(30.0), half = 0.15 * std::sqrt(2.0);
  Rock rock;
  rock.blockId = 5;
  rock.shape = makeBox(Vec3(4.0, 0.3, 0.3)).centred();
  rock.orientation = Quat(Eigen::AngleAxisd(dip, Vec3::UnitY())) *
    Quat(Eigen::AngleAxisd(radians(45.0), Vec3::UnitX()));
  // No node of the rim is under it: they are at whole metres.
  rock.position = Vec3(7.8, 10.5, 0.0);
  const double height = 20.0 + half / std::cos(dip) + 0.2 * std::tan(dip);
  EXPECT_NEAR(touchingHeight(Surface::asSurveyed(terrain), rock.shape, rock.orientation, 7.8, 10.5),
    height, 1e-12);
  SimulationParameters p;
  p.endTime = 0.1;
  rock.position.z() = height - 0.1;
  EXPECT_TRUE(holds(messageOf<PlacementError>([&] { simulate(terrain, rock, p); }),
    { "block 5", "starts inside the slope, by 0.1" }));
  rock.position.z() = height + 1e-7;
  EXPECT_NO_THROW(simulate(terrain, rock, p));
}

/// Roughness raises rims into rocks, too. What is lifted out of one falls and makes no energy.
TEST(Starts, RocksLiftedOutOfRimsFallFromThere)
{
  Numbers number(7);
  int rocks = 0;
  for (int k = 0; k < 100; ++k)
  {
    Roughness roughness;
    roughness.mean = 0.3;
    roughness.deviation = 0.2;
    const Terrain holes = withHoles(unsigned(k));
    const Terrain terrain = makeSlope(
      21, 1.0, [&](double x, double y) { return holes.nodeHeight(20 - int(y), int(x)); },
      material(0.5, 30.0), roughness);
    Rock rock;
    rock.shape = number.shape(k, number(0.05, 1.0));
    rock.orientation = number.attitude();
    rock.position = Vec3(number(2.0, 18.0), number(2.0, 18.0), 0.0);
    rock.position.z() = touchingHeight(Surface::asSurveyed(terrain), rock.shape, rock.orientation,
      rock.position.x(), rock.position.y());
    if (std::isnan(rock.position.z()))
    {
      continue;
    }
    ++rocks;
    SimulationParameters p;
    p.endTime = 2.0;
    p.seed = 3;
    const Trajectory trajectory = simulate(terrain, rock, p);
    const Block block(rock.shape, 2500.0, 1e10, 0.1);
    BlockState state;
    state.orientation = rock.orientation;
    state.position = trajectory.samples.front().position;
    PlacedBlock placed;
    placed.place(block, state);
    EXPECT_EQ(liftOut(placed, patchUnder(Surface(terrain, p.seed, 0), placed)), 0.0) << k;
    EXPECT_TRUE(
      isClear(block, state, 2e-5 * block.radius(), patchUnder(Surface(terrain, p.seed, 0), placed)))
      << k;
    for (const Sample& sample : trajectory.samples)
    {
      const double fallen = state.position.z() - sample.position.z();
      EXPECT_GT(
        kGravity * fallen + 0.03 * kGravity * block.radius(), 0.5 * sample.velocity.squaredNorm())
        << k << " at " << sample.time << " s";
    }
  }
  EXPECT_GT(rocks, 30);
}
