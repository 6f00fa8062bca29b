// Embankments and trees as explicit triangles: closed forms, and nothing goes through.

#include "dams.h"
#include "form.h"
#include "law/settings.h"
#include "piles.h"
#include "rigidFor.h"
#include "slopes.h"
#include "terrain/Obstacles.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

double auditError(const EnergyAudit& e)
{
  return std::abs(e.numerical) / std::max(e.released, 1.0);
}

} // namespace

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
      const Trajectory t = simulate(terrain, rock, rigidFor(1.0));
      rock.position.z() -= 3.0;
      const Trajectory flat = simulate(plane, rock, rigidFor(1.0));
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
    rock.orientation = turnBetween(Vec3::UnitZ(), normal);
    // 3 m below the crest's edge at y = 51 m.
    rock.position = Vec3(x, 51.0 + 4.0, 112.0 - 2.0) + 0.5 * normal;
    const double time = 1.5;
    const Trajectory t = simulate(terrain, rock, rigidFor(time));
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
  SimulationParameters p = rigidFor(60.0);
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
  SimulationParameters p = rigidFor(0.45);
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
    terrain, someOf(10000, 2000), 7,
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
    terrain, someOf(10000, 2000), 8,
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
    SimulationParameters p = rigidFor(0.5);
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
    const Trajectory t = simulate(terrain, rock, rigidFor(0.5));
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
    EXPECT_NEAR(event.energyTaken, 0.98 * tree.capacity, 1e-4 * tree.capacity); // in the middle
    EXPECT_NEAR(t.summary.energy.structures, event.energyTaken, 1e-6 * tree.capacity);
    EXPECT_GT(t.summary.stop.x(), 52.0);
    EXPECT_LT(auditError(t.summary.energy), 1e-9);
  }
}

/// ΔE/E = −0.046 + 1.026 / (1 + 10^(−8.007 (0.58 − o))) of 194 kJ for a rock of twice as much, to
/// either side, alone and in a mass fall.
TEST(Obstacles, AStemTakesTheShareOfItsOffset)
{
  const double capacity = stemCapacity(0.4), speed = 20.0;
  EXPECT_NEAR(capacity, 194e3, 1e3);
  const double shares[][2] = { { 0.0, 0.97998 }, { 0.5, 0.78897 }, { 0.7, 0.05521 }, { 0.9, 0.0 },
    { 0.98, 0.0 } };
  for (const auto& [offset, share] : shares)
  {
    for (const double side : { 1.0, -1.0 })
    {
      for (const bool together : { false, true })
      {
        SCOPED_TRACE(::testing::Message() << offset << ' ' << side << ' ' << together);
        Pile pile;
        pile.ground = level(material(0.5, 20.0));
        Structures s;
        Tree tree;
        tree.position = { 50.0, 50.0 };
        tree.diameter = 0.4;
        tree.height = 20.0;
        tree.capacity = capacity;
        s.trees = { tree };
        pile.ground.setStructures(s);
        Rock rock = brick(Vec3(1, 1, 1), Vec3(48.0, 50.0 + side * offset * (0.5 + 0.2), 110.0), 0);
        rock.density = 4.0 * capacity / (speed * speed);
        rock.velocity = Vec3(speed, 0.0, 0.0);
        pile.parameters = rigidFor(0.3);
        pile.rocks = { rock };
        Trajectory t;
        if (together)
        {
          pile.make();
          t = pile.fall->run().at(0);
        }
        else
        {
          t = simulate(pile.ground, rock, pile.parameters);
        }
        ASSERT_EQ(t.structures.size(), 1u);
        const bool stands = (1.0 - offset * offset) * 2.0 < 1.0;
        EXPECT_EQ(t.structures[0].outcome,
          stands ? StructureOutcome::TreePassed : StructureOutcome::TreeBroken);
        EXPECT_NEAR(t.structures[0].energyTaken, share * capacity, 1e-3 * capacity);
        EXPECT_NEAR(t.summary.energy.structures, share * capacity, 1e-3 * capacity);
        EXPECT_GT(t.summary.stop.x(), 51.0);
        // Aside on the side on which it passes: along the stem that stands, or by the push of one
        // that breaks, that far off the axis.
        const double aside = side * (t.summary.stop.y() - rock.position.y());
        const double towards = speed * std::sqrt(1.0 - offset * offset);
        const double push = towards -
          std::sqrt(std::max(0.0, towards * towards - share * speed * speed / 2.0)); // share v²/4
        const double across = stands ? towards : offset * push;
        EXPECT_NEAR(aside, across * (0.3 - t.structures[0].time), 0.02 * across + 1e-6);
        EXPECT_LT(auditError(t.summary.energy), 1e-9);
      }
    }
  }
}

/// Hit half way to its side, a stem holds 0.789 of its capacity; of more it takes that much, and
/// stands while less than its capacity comes towards its axis.
TEST(Obstacles, AStemHoldsTheShareOfItsOffset)
{
  const double capacity = stemCapacity(0.4), speed = 20.0, offset = 0.5;
  for (const double energy : { 0.7, 0.85, 1.3, 1.4 })
  {
    SCOPED_TRACE(energy);
    Terrain ground = level(material(0.5, 20.0));
    Structures s;
    Tree tree;
    tree.position = { 50.0, 50.0 };
    tree.diameter = 0.4;
    tree.height = 20.0;
    tree.capacity = capacity;
    s.trees = { tree };
    ground.setStructures(s);
    Rock rock = brick(Vec3(1, 1, 1), Vec3(48.0, 50.0 + offset * (0.5 + 0.2), 110.0), 0);
    rock.density = 2.0 * energy * capacity / (speed * speed);
    rock.velocity = Vec3(speed, 0.0, 0.0);
    const Trajectory t = simulate(ground, rock, rigidFor(0.3));
    if (energy < 0.789)
    {
      EXPECT_TRUE(t.structures.empty());
      EXPECT_LT(t.summary.stop.x(), 50.0);
      continue;
    }
    ASSERT_EQ(t.structures.size(), 1u);
    EXPECT_EQ(t.structures[0].outcome,
      energy < 1.333 ? StructureOutcome::TreePassed : StructureOutcome::TreeBroken);
    EXPECT_NEAR(t.structures[0].energyTaken, 0.789 * capacity, 1e-3 * capacity);
    EXPECT_GT(t.summary.stop.x(), 49.8); // it stood at 49.3 m when it touched
    EXPECT_GT(t.summary.stop.y(), rock.position.y() + 0.1);
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
    SimulationParameters p = rigidFor(12.0);
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
    rock.orientation = turnBetween(Vec3::UnitZ(), normal);
    rock.position =
      Vec3(x, 80.0, 100.0 - (x - 80.0) * std::tan(angle)) + (0.5 * edge + 0.001) * normal;
    pile.rocks.push_back(rock);
  }
  pile.parameters.endTime = 40.0;
  pile.parameters.rockFrictionAngle = radians(20.0);
  pile.make();
  std::size_t broken = 0;
  for (const Trajectory& t : pile.fall->run())
  {
    // For the others it is gone, too, with what springs against it hold; one that slips past it
    // leaves next to nothing.
    double taken = 0.0;
    for (const StructureEvent& event : t.structures)
    {
      const bool breaks = event.outcome == StructureOutcome::TreeBroken;
      broken += breaks;
      taken += event.energyTaken;
      EXPECT_TRUE(!breaks || std::abs(taken / capacity - 0.98) < 0.01) << taken;
    }
    EXPECT_NEAR(t.summary.energy.structures, taken, 1e-9 * capacity);
    // Rounding over some thousand steps, and what lifts a rock out of a loose overlap.
    const double radius = pile.blocks[std::size_t(t.summary.rock)].radius();
    const double lifted = t.summary.mass * pile.parameters.gravity * kLooseOverlap * radius;
    EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-9 * t.summary.energy.released + lifted);
  }
  EXPECT_EQ(broken, 1u);
}
