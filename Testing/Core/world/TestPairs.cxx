// Two rocks that meet: momentum, angular momentum, energy, restitution.

#include "angularMomentum.h"
#include "base/errors.h"
#include "piles.h"
#include "slopes.h"
#include "world/World.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

Rock rockAt(Shape shape, const Vec3& place, const Vec3& velocity, std::int64_t id)
{
  Rock rock;
  rock.blockId = id;
  rock.shape = makeShape(shape, 1.0);
  rock.position = place;
  rock.velocity = velocity;
  return rock;
}

struct Totals
{
  Vec3 momentum = Vec3::Zero();
  Vec3 angular = Vec3::Zero();
  double energy = 0.0;
};

Totals totalsOf(const World& fall, const std::vector<Block>& blocks)
{
  Totals t;
  for (int i = 0; i < fall.rocks(); ++i)
  {
    const BlockState& s = fall.state(i);
    t.momentum += blocks[i].mass() * s.velocity;
    t.angular += blocks[i].mass() * (s.position - Vec3(200, 200, 0)).cross(s.velocity) +
      angularMomentum(blocks[i], s);
    t.energy += rigidKineticEnergy(blocks[i], s);
  }
  return t;
}

constexpr std::array<std::pair<Shape, Shape>, 6> kPairsOfShapes = { {
  { Shape::Cube, Shape::Cube },
  { Shape::Cube, Shape::Icosahedron },
  { Shape::Tetrahedron, Shape::Octahedron },
  { Shape::Eota221, Shape::Eota221 },
  { Shape::Dodecahedron, Shape::Tetrahedron },
  { Shape::Icosahedron, Shape::Icosahedron },
} };

/// A rock whose vertex 0 (or face 0) looks along `direction`.
Quat facing(const Vec3& own, const Vec3& direction)
{
  return turnBetween(own, direction);
}

struct Meeting
{
  Totals before, after;
  std::vector<ImpactEvent> events;
};

Meeting meet(const std::vector<Rock>& rocks, double e, double friction)
{
  const Terrain ground = abyss();
  SimulationParameters p;
  p.gravity = 0.0;
  p.endTime = 1.0;
  p.rockRockContact = true;
  p.rockRestitution = e;
  p.rockFrictionAngle = radians(friction);
  const std::vector<Block> blocks = blocksOf(rocks);
  const Surface surface(ground, p.seed, 0);
  World fall(surface, rocks, blocks, p);
  fall.release();
  Meeting m;
  m.before = totalsOf(fall, blocks);
  while (fall.advance())
  {
  }
  m.after = totalsOf(fall, blocks);
  m.events = fall.rock(0).trajectory().impacts;
  return m;
}

} // namespace

TEST(Pairs, AnyMeetingKeepsMomentaAndAnElasticOneEnergy)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int met = 0;
  for (const auto& shapes : kPairsOfShapes)
  {
    for (int k = 0; k < 40; ++k)
    {
      std::vector<Rock> rocks = {
        rockAt(shapes.first, Vec3(198.0, 200.0, 0.0), Vec3(5.0, 0.0, 0.0), 1),
        rockAt(shapes.second, Vec3(202.0, 200.0, 0.0), Vec3(-3.0, 0.0, 0.0), 2),
      };
      for (Rock& rock : rocks)
      {
        rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
        rock.position += 0.3 * Vec3(0.0, u(random), u(random));
        rock.angularVelocity = Vec3(u(random), u(random), u(random));
      }
      // Every other one with friction and restitution: momenta are kept all the same.
      const bool elastic = k % 2 == 0;
      const Meeting m = elastic ? meet(rocks, 1.0, 0.0) : meet(rocks, 0.5, 30.0);
      const double momentum = 2500.0 * 8.0;
      EXPECT_LT((m.after.momentum - m.before.momentum).norm(), 1e-10 * momentum);
      EXPECT_LT((m.after.angular - m.before.angular).norm(), 1e-10 * momentum * 2.0);
      met += !m.events.empty();
      if (elastic)
      {
        // Most are within 1e-6; what is left is the step that an impact is resolved in.
        EXPECT_NEAR(m.after.energy, m.before.energy, 0.01 * m.before.energy);
      }
      else
      {
        EXPECT_LE(m.after.energy, m.before.energy * (1.0 + 1e-9));
      }
    }
  }
  EXPECT_EQ(met, 240);
}

TEST(Pairs, LossIsThatOfTheCoefficientOfRestitution)
{
  // A vertex on a face, head-on and oblique: one contact, so that ½ μ (1 − e²) v² is exact.
  int measured = 0;
  for (const auto& shapes : kPairsOfShapes)
  {
    for (double e : { 0.2, 0.5, 0.8 })
    {
      for (int k = 0; k < 4; ++k)
      {
        std::vector<Rock> rocks = {
          rockAt(shapes.first, Vec3(198.0, 200.0, 0.0), Vec3(5.0, 0.3 * k, 0.0), 1),
          rockAt(shapes.second, Vec3(202.0, 200.0 + 0.04 * k, 0.05 * k), Vec3(-3.0, 0.0, 0.0), 2),
        };
        rocks[0].orientation =
          facing(rocks[0].shape.vertices()[0], Vec3::UnitX() + 0.05 * k * Vec3::UnitZ());
        rocks[1].orientation = facing(rocks[1].shape.normals()[0], -Vec3::UnitX());
        const Meeting m = meet(rocks, e, 0.0);
        ASSERT_GE(m.events.size(), 1u);
        if (m.events.size() > 1)
        {
          continue;
        }
        ++measured;
        // The loss ½ μ (1 − e²) v² with the impulse μ (1 + e) v.
        const ImpactEvent& event = m.events.front();
        const double expected = 0.5 * (1.0 - e) * event.impulse * event.approachSpeed;
        const double loss = m.before.energy - m.after.energy;
        EXPECT_NEAR(loss, expected, 0.01 * expected)
          << shapeName(shapes.first) << " on " << shapeName(shapes.second) << ", e " << e;
        EXPECT_NEAR(event.energyLoss, loss, 0.001 * loss);
        EXPECT_EQ(event.otherRock, 1);
        // The impulse itself: 1/μ = Σ 1/m + (x × n)·I⁻¹(x × n).
        double mobility = 0.0;
        for (int i = 0; i < 2; ++i)
        {
          const Block block(rocks[i].shape, rocks[i].density, rocks[i].youngModulus, 0.1);
          const Mat3 r = rocks[i].orientation.toRotationMatrix();
          const Vec3 place = rocks[i].position + event.time * rocks[i].velocity;
          mobility +=
            block.mobility(r.transpose() * event.normal, r.transpose() * (event.position - place));
        }
        const double impulse = (1.0 + e) * event.approachSpeed / mobility;
        EXPECT_NEAR(event.impulse, impulse, 0.01 * impulse);
      }
    }
  }
  EXPECT_GE(measured, 50);
}

/// Face on face, of boxes of any proportions: all corners stop the whole of them together.
TEST(Pairs, LossOfFacesThatMeetIsThatOfTheCoefficientOfRestitution)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(0.2, 1.7);
  for (const double e : { 0.2, 0.5, 0.8 })
  {
    constexpr int cases = 40;
    double mean = 0.0;
    for (int k = 0; k < cases; ++k)
    {
      std::vector<Rock> rocks = {
        brick(Vec3(u(random), u(random), u(random)), Vec3(198.0, 200.0, 0.0), 1),
        brick(Vec3(u(random), u(random), u(random)), Vec3(202.0, 200.0, 0.0), 2),
      };
      rocks[0].velocity = Vec3(5.0, 0.0, 0.0);
      rocks[1].velocity = Vec3(-3.0, 0.0, 0.0);
      const std::vector<Block> blocks = blocksOf(rocks);
      const double mass = 1.0 / (1.0 / blocks[0].mass() + 1.0 / blocks[1].mass());
      const double expected = 0.5 * mass * (1.0 - e * e) * 64.0;
      const Meeting m = meet(rocks, e, 30.0);
      const double off = (m.before.energy - m.after.energy) / expected - 1.0;
      mean += off / cases;
      // Resolved with eight steps, which begin anywhere in it: e is within 0.005.
      EXPECT_LT(std::abs(off), 0.02) << e << ", " << k;
    }
    EXPECT_LT(std::abs(mean), 0.005) << e;
  }
}

// Couples of cubes in one run, a vertex on a face in line with both centroids: the loss is
// ½ μ (1 − e²) v² with μ = m/2 and the e of the couple's two materials.
TEST(Pairs, EachPairOfMaterialsHasItsRestitution)
{
  const struct
  {
    const char *first, *second;
    double e;
  } couples[] = {
    { "schist", "schist", 0.2 },
    { "schist", "marble", 0.9 },
    { "Marble", "Schist ", 0.9 }, // in the other order, written in another way
    { "marble", "marble", 0.6 },  // no row: as RockRestitution
    { "schist", "", 0.6 },        // no material, likewise
    { "concrete", "schist", 0.6 },
  };
  SimulationParameters p;
  p.gravity = 0.0;
  p.endTime = 0.6;
  p.rockRockContact = true;
  p.rockRestitution = 0.6;
  p.rockContactPairs = { { "schist", "schist", { 0.2, 0.0, 0.0 } },
    { "SCHIST", "marble", { 0.9, 0.0, 0.0 } } };
  std::vector<Rock> rocks;
  for (const auto& couple : couples)
  {
    const double y = 100.0 + 10.0 * double(rocks.size());
    Rock one = rockAt(Shape::Cube, Vec3(198.0, y, 0.0), Vec3(5.0, 0.0, 0.0), 1);
    Rock other = rockAt(Shape::Cube, Vec3(202.0, y, 0.0), Vec3(-3.0, 0.0, 0.0), 2);
    one.orientation = facing(one.shape.vertices()[0], Vec3::UnitX());
    other.orientation = facing(other.shape.normals()[0], -Vec3::UnitX());
    one.material = couple.first;
    other.material = couple.second;
    rocks.push_back(one);
    rocks.push_back(other);
  }
  const Terrain ground = abyss();
  const std::vector<Block> blocks = blocksOf(rocks);
  const Surface surface(ground, p.seed, 0);
  World fall(surface, rocks, blocks, p);
  const auto energyOf = [&](int i) { return rigidKineticEnergy(blocks[i], fall.state(i)); };
  fall.release();
  const double before = energyOf(0) + energyOf(1); // the same of all
  while (fall.advance())
  {
  }
  for (int k = 0; k < int(std::size(couples)); ++k)
  {
    const double e = couples[k].e, v = 8.0, mu = 0.5 * blocks[0].mass();
    const double expected = 0.5 * mu * (1.0 - e * e) * v * v;
    const double loss = before - energyOf(2 * k) - energyOf(2 * k + 1);
    // What is left is the step that an impact is resolved in.
    EXPECT_NEAR(loss, expected, 0.01 * expected) << couples[k].first << " on " << couples[k].second;
    ASSERT_EQ(fall.rock(2 * k).trajectory().impacts.size(), 1u);
    EXPECT_EQ(fall.rock(2 * k).trajectory().impacts.front().restitution, e);
  }
}

TEST(Pairs, ContactsOfMaterialsAreChecked)
{
  const auto refused = [](std::vector<RockContactPair> pairs, const std::string& what)
  {
    SimulationParameters p;
    p.rockContactPairs = std::move(pairs);
    try
    {
      p.validate();
      ADD_FAILURE() << what << " is taken";
    }
    catch (const ParameterError& error)
    {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  refused({ { "a", "b", {} }, { "B", "a ", {} } }, "\"B\" and \"a \" is there twice");
  refused({ { "a", " ", {} } }, "without a name");
  refused({ { "a", "b", { 1.5, 0.0, 0.0 } } }, "the restitution is 1.5");
  refused({ { "a", "b", { 0.5, radians(95.0), 0.0 } } }, "the friction angle is 95");
  refused({ { "a", "b", { 0.5, 0.0, -2.0 } } }, "the cohesion is -2");
  std::vector<RockContactPair> many;
  for (int k = 0; k < 256; ++k)
  {
    many.push_back({ std::to_string(k), std::to_string(k), {} });
  }
  refused(many, "256 materials");
}

TEST(Pairs, NewtonsCradle)
{
  // Five cubes in a row, the first comes: the last leaves, the others stay.
  std::vector<Rock> rocks;
  for (int i = 0; i < 5; ++i)
  {
    rocks.push_back(rockAt(Shape::Cube, Vec3(198.0 + (i > 0 ? 1.5 + 1.01 * i : 0.0), 200.0, 0.0),
      Vec3(i == 0 ? 4.0 : 0.0, 0.0, 0.0), i));
  }
  const Terrain ground = abyss();
  SimulationParameters p;
  p.gravity = 0.0;
  p.endTime = 1.0;
  p.rockRockContact = true;
  p.rockRestitution = 1.0;
  const std::vector<Block> blocks = blocksOf(rocks);
  const Surface surface(ground, p.seed, 0);
  World fall(surface, rocks, blocks, p);
  fall.release();
  const Totals before = totalsOf(fall, blocks);
  while (fall.advance())
  {
  }
  const Totals after = totalsOf(fall, blocks);
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-10 * before.momentum.norm());
  EXPECT_NEAR(after.energy, before.energy, 0.01 * before.energy);
  for (int i = 0; i < 5; ++i)
  {
    // Gaps of 1 cm: an impact lasts 3.5 ms, in which the struck cube goes 7 mm, so that it is over
    // before the next begins.
    EXPECT_NEAR(fall.state(i).velocity.x(), i == 4 ? 4.0 : 0.0, 0.04);
  }
}

TEST(Pairs, AnImpactIsTheSameBesideOthers)
{
  // A slender box strikes a heavy one; beside that one, and never touching it, stands another one
  // that a cube rubs along in the same substep: one island. Newton's restitution and friction give
  // some of the slender boxes more energy than they have, which is taken back; what the cube loses
  // may not pay for it.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto rock = [](const Polyhedron& shape, const Vec3& place, std::int64_t id)
  {
    Rock made = rockAt(Shape::Cube, place, Vec3::Zero(), id);
    made.shape = shape;
    return made;
  };
  const auto energyOf = [](const std::vector<Rock>& rocks, double time)
  {
    Pile pile;
    pile.ground = abyss();
    pile.rocks = rocks;
    pile.parameters.gravity = 0.0;
    pile.parameters.endTime = 0.02;
    pile.parameters.rockRestitution = 1.0;
    pile.parameters.rockFrictionAngle = radians(80.0);
    pile.start();
    pile.run(time);
    return rigidKineticEnergy(pile.blocks[0], pile.fall->state(0)) +
      rigidKineticEnergy(pile.blocks[1], pile.fall->state(1));
  };
  int limited = 0;
  for (int k = 0; k < 100; ++k)
  {
    std::vector<Rock> rocks = {
      rock(makeBox(Vec3(1.0, 0.1, 0.1)), Vec3(197.0, 200.0, 0.0), 1),
      rock(makeBox(Vec3(4.0, 4.0, 4.0)), Vec3(200.0, 200.0, 0.0), 2),
      rock(makeBox(Vec3(4.0, 4.0, 4.0)), Vec3(204.002, 200.0, 0.0), 3),
      rock(makeBox(Vec3(0.5, 0.5, 0.5)), Vec3(207.0, 200.0, 0.0), 4),
    };
    rocks[0].orientation = Quat(Eigen::AngleAxisd(0.8 + 0.5 * u(random), Vec3::UnitZ()));
    rocks[0].velocity = Vec3(5.0, 2.0 * u(random), 0.0);
    rocks[0].angularVelocity = Vec3(0.0, 0.0, 3.0 * u(random));
    rocks[3].velocity = Vec3(-5.0, 10.0, 0.0);
    // Both are as far away as they come within half a step.
    const auto stand = [&](Rock& of, double face, double side)
    {
      double most = -1e9;
      for (const Vec3& v : of.shape.vertices())
      {
        most = std::max(most, side * (of.orientation * v).x());
      }
      of.position.x() = face - side * (most + 0.0125);
    };
    stand(rocks[0], 198.0, 1.0);
    stand(rocks[3], 206.002, -1.0);
    const std::vector<Rock> pair(rocks.begin(), rocks.begin() + 2);
    const double before = energyOf(pair, 0.0), after = energyOf(pair, 0.02);
    EXPECT_LE(after, before * (1.0 + 1e-9)) << k;
    EXPECT_NEAR(energyOf(rocks, 0.02), after, 1e-6 * before) << k;
    limited += after > before * (1.0 - 1e-9);
  }
  EXPECT_GT(limited, 5);
}
