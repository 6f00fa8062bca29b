// Stems that lie on the ground: where they are, what they hold, and what one that breaks takes.

#include "dams.h"
#include "piles.h"
#include "rigidFor.h"
#include "slopes.h"
#include "terrain/Obstacles.h"
#include "terrain/stemHit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kSpeed = 20.0; // m/s

/// Of 1 m, along y through the middle of the slope.
Tree lying(double capacity, double diameter = 1.0)
{
  Tree tree;
  tree.feature = 6;
  tree.position = { 50.0, 40.0 };
  tree.end = { 50.0, 60.0 };
  tree.diameter = diameter;
  tree.capacity = capacity;
  return tree;
}

Terrain levelWith(const std::vector<Tree>& trees)
{
  Terrain ground = level(material(0.5, 20.0));
  Structures s;
  s.trees = trees;
  ground.setStructures(s);
  return ground;
}

/// A cube of 0.5 m with this energy (J), so fast that it falls by millimetres before it hits.
Rock shot(const Vec3& from, const Vec3& way, double energy)
{
  Rock rock = brick(Vec3(0.5, 0.5, 0.5), from, 0);
  rock.velocity = kSpeed * way.normalized();
  rock.density = 2.0 * energy / (kSpeed * kSpeed * 0.125);
  return rock;
}

Trajectory run(const Terrain& ground, const Rock& rock, double seconds, bool together = false)
{
  if (!together)
  {
    return simulate(ground, rock, rigidFor(seconds));
  }
  Pile pile;
  pile.ground = ground;
  pile.parameters = rigidFor(seconds);
  pile.rocks = { rock };
  pile.make();
  return pile.fall->run().at(0);
}

constexpr double kCapacity = 50e3; // J

} // namespace

/// A cylinder on a plane touches it: its axis is a radius over it, its top a diameter, and its foot
/// is under ground all along, however it lies.
TEST(LyingStems, LieOnTheGround)
{
  const double slope = radians(30.0), r = 0.3;
  const Terrain ground = makePlane(41, 200.0, slope, 0.0, material(0.5, 20.0));
  for (const double angle : { 0.0, 0.5 * M_PI, 1.0, 4.0 })
  {
    Tree tree = lying(kCapacity, 2.0 * r);
    tree.position = { 100.0, 100.0 };
    tree.end = tree.position + 12.0 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    Structures s;
    s.trees = { tree };
    const Obstacles obstacles(s, ground);
    const LyingStem* stem = obstacles.lyingOf(0);
    ASSERT_NE(stem, nullptr);
    const auto over = [&](const Vec3& p)
    { return (p.z() - ground.elevation(p.x(), p.y())) * std::cos(slope); };
    EXPECT_NEAR(over(stem->from), r, 1e-9);
    EXPECT_NEAR(over(stem->to), r, 1e-9);
    double top = 0.0;
    for (int k = 0; k < int(Obstacles::lyingShape().nodes.size()); ++k)
    {
      const Vec3 p = obstacles.treeCorner(0, k);
      top = std::max(top, over(p));
      const bool foot = Obstacles::lyingShape().nodes[std::size_t(k)].position.z() < 0.0;
      EXPECT_EQ(over(p) < 0.0, foot) << k;
    }
    // The octagon about the circle.
    EXPECT_GE(top, 2.0 * r * (1.0 - 1e-9));
    EXPECT_LE(top, r + r / std::cos(M_PI / 8.0) + 1e-9);
    // Outward, so that contacts push away from it.
    const Vec3 middle = 0.5 * (stem->from + stem->to);
    for (int k = 0; k < int(Obstacles::lyingShape().triangles.size()); ++k)
    {
      const Vec3 corner =
        obstacles.treeCorner(0, Obstacles::lyingShape().triangles[std::size_t(k)].nodes[0]);
      EXPECT_GT(obstacles.treeNormal(0, k).dot(corner - middle), 0.0) << k;
    }
    EXPECT_TRUE(obstacles.isInTree(0, middle));
    EXPECT_FALSE(obstacles.isInTree(0, middle + Vec3(0, 0, 2.0 * r)));
  }
}

/// One that bridges a hollow deeper than it is thick, or a rise higher than its top, is asked after.
TEST(LyingStems, AreAskedAfterOverHollowsAndInTheGround)
{
  const auto notes = [](double rise)
  {
    GridGeometry g;
    g.columns = g.rows = 41;
    g.cellSize = 1.0;
    std::vector<double> heights(std::size_t(g.nodeCount()), 100.0);
    for (int row = 18; row <= 22; ++row)
    {
      std::fill_n(heights.begin() + row * g.columns, g.columns, 100.0 + rise);
    }
    const Terrain ground(g, heights, material(0.5, 20.0));
    Structures s;
    Tree tree = lying(kCapacity, 0.5);
    tree.position = { 20.0, 12.0 };
    tree.end = { 20.0, 28.0 };
    s.trees = { tree, tree };
    s.trees[1].position.y() = 5.0;
    s.trees[1].end.y() = 10.0; // on level ground
    std::vector<std::string> told;
    Obstacles(s, ground).askAfterLying(told);
    return told;
  };
  EXPECT_TRUE(notes(0.0).empty());
  EXPECT_TRUE(notes(-0.4).empty());
  ASSERT_EQ(notes(-0.8).size(), 1u);
  EXPECT_EQ(
    notes(-0.8)[0].find(
      "1 of 2 stems that lie look implausible, first feature 6, up to 0.8 m over the ground"),
    0u)
    << notes(-0.8)[0];
  EXPECT_TRUE(notes(0.4).empty());
  ASSERT_EQ(notes(0.8).size(), 1u);
  EXPECT_NE(notes(0.8)[0].find("first feature 6, up to 0.3 m under it"), std::string::npos)
    << notes(0.8)[0];
}

/// Square, from either side: of no more than its capacity it throws the rock back, of more it takes
/// 0.98 of it; alone and in a mass fall.
TEST(LyingStems, HoldUpToTheirCapacity)
{
  const Terrain ground = levelWith({ lying(kCapacity) });
  for (const double side : { 1.0, -1.0 })
  {
    for (const bool together : { false, true })
    {
      SCOPED_TRACE(::testing::Message() << side << ' ' << together);
      const Vec3 from(50.0 - side * 1.5, 50.0, 100.5), way(side, 0.0, 0.0);
      const Trajectory held = run(ground, shot(from, way, 0.95 * kCapacity), 0.2, together);
      EXPECT_TRUE(held.structures.empty());
      EXPECT_LT(side * (held.summary.stop.x() - 50.0), -0.75);
      EXPECT_LT(std::abs(held.summary.energy.numerical), 1e-6 * kCapacity);

      const Trajectory broke = run(ground, shot(from, way, 2.0 * kCapacity), 0.2, together);
      ASSERT_EQ(broke.structures.size(), 1u);
      EXPECT_EQ(broke.structures[0].outcome, StructureOutcome::TreeBroken);
      EXPECT_EQ(broke.structures[0].feature, 6);
      EXPECT_NEAR(broke.structures[0].energyTaken, stemShare(0.0) * kCapacity, 2e-3 * kCapacity);
      EXPECT_NEAR(
        broke.summary.energy.structures, broke.structures[0].energyTaken, 1e-6 * kCapacity);
      EXPECT_GT(side * (broke.summary.stop.x() - 50.0), 1.0);
      EXPECT_LT(std::abs(broke.summary.energy.numerical), 1e-9 * kCapacity);
    }
  }
}

/// Over its axis by o, it breaks where (1 − o²) E is above its capacity, takes the share of o, and
/// pushes the rock up; else the rock goes on over it and loses nothing to it.
TEST(LyingStems, TakeTheShareOfTheOffset)
{
  const Terrain ground = levelWith({ lying(kCapacity) });
  for (const double times : { 1.2, 3.0, 8.0 })
  {
    for (const double offset : { 0.3, 0.5, 0.7, 0.9 })
    {
      SCOPED_TRACE(::testing::Message() << times << ' ' << offset);
      const Vec3 from(48.8, 50.0, 100.5 + offset * 0.75);
      const Trajectory t = run(ground, shot(from, Vec3::UnitX(), times * kCapacity), 0.1);
      const bool breaks = (1.0 - offset * offset) * times > 1.0;
      ASSERT_EQ(t.structures.size(), breaks ? 1u : 0u);
      if (!breaks)
      {
        EXPECT_EQ(t.summary.energy.structures, 0.0);
        EXPECT_EQ(t.summary.impacts, 1);
        continue;
      }
      // By then it has fallen by millimetres: the offset is that of its way past the axis.
      const StructureEvent& event = t.structures[0];
      const Vec3 along = event.velocity.normalized(), side(-along.z(), 0.0, along.x());
      const double reach = 0.25 * side.lpNorm<1>() + 0.5;
      const double met = side.dot(event.position - Vec3(50.0, 50.0, 100.5)) / reach;
      EXPECT_NEAR(met, offset, 0.03);
      EXPECT_NEAR(event.energyTaken, stemShare(met) * kCapacity, 1e-6 * kCapacity);
      EXPECT_NEAR(t.summary.energy.structures, event.energyTaken, 1e-6 * kCapacity);
      EXPECT_GT(t.summary.stop.x(), event.position.x() + 0.1);
      // Nothing below the height that it would have had without the stem.
      const double time = 0.1, fallen = 0.5 * kGravity * time * time;
      EXPECT_GT(t.summary.stop.z(), from.z() - fallen - 1e-6);
    }
  }
}

/// A ball of 0.5 m that rolls at a stem of 0.2 m: o = 0.3 / 0.7.
TEST(LyingStems, AreMetByRollingBallsAtTheDifferenceOfRadii)
{
  const double radius = 0.5, r = 0.2, offset = (radius - r) / (radius + r);
  const Terrain ground = levelWith({ lying(kCapacity, 2.0 * r) });
  for (const double times : { 1.1, 1.4 }) // of 1 / (1 − o²) = 1.225
  {
    Rock ball;
    ball.shape = makeShape(Shape::Sphere, 4.0 / 3.0 * M_PI * std::pow(radius, 3));
    ball.density =
      2.0 * times * kCapacity / (kSpeed * kSpeed * 4.0 / 3.0 * M_PI * std::pow(radius, 3));
    ball.position = Vec3(48.9, 50.0, 100.0 + radius);
    ball.velocity = kSpeed * Vec3::UnitX();
    const Trajectory t = run(ground, ball, 0.1);
    ASSERT_EQ(t.structures.size(), times > 1.225 ? 1u : 0u);
    for (const StructureEvent& event : t.structures)
    {
      EXPECT_NEAR(event.energyTaken, stemShare(offset) * kCapacity, 0.01 * kCapacity);
      EXPECT_NEAR(
        event.position.x(), 50.0 - std::sqrt(0.49 - 0.09), 0.03); // the octagon is about the circle
    }
  }
}

/// Along the stem, at either end of it.
TEST(LyingStems, AreHitAtTheirEnds)
{
  const Terrain ground = levelWith({ lying(kCapacity) });
  for (const double end : { 1.0, -1.0 })
  {
    SCOPED_TRACE(end);
    const Vec3 from(50.0, 50.0 + end * 11.5, 100.5), way(0.0, -end, 0.0);
    const Trajectory held = run(ground, shot(from, way, 0.95 * kCapacity), 0.1);
    EXPECT_TRUE(held.structures.empty());
    EXPECT_GT(end * (held.summary.stop.y() - 50.0), 10.25);
    const Trajectory broke = run(ground, shot(from, way, 2.0 * kCapacity), 0.1);
    ASSERT_EQ(broke.structures.size(), 1u);
    EXPECT_NEAR(broke.structures[0].energyTaken, stemShare(0.0) * kCapacity, 2e-3 * kCapacity);
    // Just beside the end nothing is met.
    const Vec3 past(48.5, 50.0 + end * 10.26, 100.5);
    const Trajectory missed = run(ground, shot(past, Vec3::UnitX(), kCapacity), 0.15);
    EXPECT_TRUE(missed.structures.empty());
    EXPECT_EQ(missed.summary.impacts, 0);
  }
}

/// What passes over it is not touched; what is released in it loses it.
TEST(LyingStems, AreMetByWhatTouchesThem)
{
  const Terrain ground = levelWith({ lying(kCapacity) }), bare = level(material(0.5, 20.0));
  const Rock over = shot(Vec3(49.0, 50.0, 101.27), Vec3(1.0, 0.0, 0.02), 3.0 * kCapacity);
  const Trajectory past = run(ground, over, 0.1);
  EXPECT_LT((past.summary.stop - run(bare, over, 0.1).summary.stop).norm(), 1e-9);
  EXPECT_EQ(past.summary.impacts, 0);
  const Rock within = shot(Vec3(50.0, 50.0, 100.5), Vec3::UnitX(), 0.1 * kCapacity);
  const Trajectory t = run(ground, within, 0.1);
  EXPECT_TRUE(t.structures.empty());
  EXPECT_NEAR(t.summary.stop.x(), 52.0, 1e-9);
}

/// None of 3000 rocks of 1 to 500 l goes through an unbreakable one.
TEST(LyingStems, NoShotGoesThrough)
{
  const Terrain ground = levelWith({ lying(std::numeric_limits<double>::infinity(), 2.0) });
  std::mt19937_64 random(5);
  const auto uniform = [&](double a, double b)
  { return a + (b - a) * (double(random() >> 11) * 0x1p-53); };
  std::vector<Rock> rocks(3000);
  for (Rock& rock : rocks)
  {
    rock.shape = makeShape(
      uniform(0, 1) < 0.5 ? Shape::Cube : Shape::Octahedron, std::pow(10.0, uniform(-3.0, -0.3)));
    rock.orientation =
      Quat(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
    rock.angularVelocity = Vec3(uniform(-8, 8), uniform(-8, 8), uniform(-8, 8));
    rock.position = Vec3(uniform(44, 47.5), uniform(46, 54), uniform(101, 102.5));
    rock.velocity = Vec3(uniform(10, 50), uniform(-5, 5), uniform(-10, 2));
  }
  SimulationParameters p = rigidFor(0.4);
  p.outputInterval = 0.02;
  TrajectoryStore store(int(rocks.size()), 1);
  runEnsemble(ground, rocks, p, store);
  for (const Trajectory& t : store.trajectories())
  {
    // Under its top (102 m) between its flanks (49 and 51 m).
    EXPECT_FALSE(std::any_of(t.samples.begin(), t.samples.end(),
      [](const Sample& at)
      { return std::abs(at.position.x() - 50.0) < 0.5 && at.position.z() < 101.9; }))
      << t.summary.rock;
    EXPECT_LT(std::abs(t.summary.energy.numerical), 0.02 * t.summary.energy.released);
  }
}

/// One that a rock of a mass fall has broken is gone for the others.
TEST(LyingStems, AreGoneForTheNextOfAFall)
{
  Pile pile;
  pile.ground = levelWith({ lying(kCapacity) });
  pile.parameters = rigidFor(0.25);
  Rock first = shot(Vec3(49.0, 55.0, 100.5), Vec3::UnitX(), 3.0 * kCapacity),
       second = shot(Vec3(47.5, 45.0, 100.5), Vec3::UnitX(), 0.5 * kCapacity);
  second.blockId = 1;
  for (const bool together : { false, true })
  {
    pile.rocks = together ? std::vector<Rock>{ first, second } : std::vector<Rock>{ second };
    pile.make();
    const Trajectory last = pile.fall->run().back();
    EXPECT_TRUE(last.structures.empty());
    EXPECT_EQ(last.summary.stop.x() > 51.0, together);
  }
}
