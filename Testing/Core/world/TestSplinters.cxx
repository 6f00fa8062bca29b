// Thin and long rocks with sharp points, of very different sizes: what cubes do not show.

#include "form.h"
#include "piles.h"
#include "rock/placement.h"
#include "solve/island/SoftSolver.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// A hull of twelve random points, thin and long like rock that has split off.
Polyhedron splinter(std::mt19937& random, double size)
{
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  std::vector<Vec3> corners;
  for (int k = 0; k < 12; ++k)
  {
    const double x = u(random), y = u(random), z = u(random);
    corners.push_back(size * Vec3(x, 0.3 * y, 1.5 * z));
  }
  return Polyhedron::convexHull(corners).centred();
}

} // namespace

// Wherever two splinters overlap they touch, as deep as the best axis says: their sharp points may
// lie behind faces that look more towards the other one.
TEST(Splinters, WhatOverlapsTouches)
{
  std::mt19937 random(17);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const int count = someOf(3000, 500);
  int overlapping = 0;
  for (int k = 0; k < count; ++k)
  {
    const double ratio = std::pow(10.0, 0.8 * u(random));
    const std::array<Block, 2> blocks = { Block(splinter(random, 1.0), 2500.0, 1e9, 0.2),
      Block(splinter(random, ratio), 2500.0, 1e9, 0.2) };
    std::array<PlacedBlock, 2> placed;
    std::array<PairBody, 2> bodies;
    std::array<BlockState, 2> states;
    PairAxis last;
    std::vector<Contact> touches;
    for (BlockState& s : states)
    {
      s.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
    }
    const Vec3 way = Vec3(u(random), u(random), u(random)).normalized();
    const double smaller = std::min(blocks[0].radius(), blocks[1].radius());
    // Into each other in steps, the axis remembered, turning a little.
    for (int step = 0; step < 400; ++step)
    {
      states[1].position = (blocks[0].radius() + blocks[1].radius() - 0.01 * step * smaller) * way;
      states[1].orientation =
        (Quat(1.0, 0.005 * u(random), 0.005 * u(random), 0.005 * u(random)) * states[1].orientation)
          .normalized();
      for (int i : { 0, 1 })
      {
        placed[i].place(blocks[i], states[i]);
        bodies[i].update(placed[i]);
      }
      last = findAxis(bodies[0], bodies[1], last, 0.0);
      if (last.distance >= 0.0)
      {
        continue;
      }
      ++overlapping;
      const double depth = -bestAxis(bodies[0], bodies[1]).distance;
      // An axis stays as long as none is better by 1e-3 of the smaller radius, no edges by 2e-3.
      EXPECT_GE(-last.distance, depth - 1e-12);
      EXPECT_LE(-last.distance, depth + 2.1e-3 * smaller);
      findTouches(bodies[0], bodies[1], last, 0.0, touches);
      if (depth <= 0.0)
      {
        continue;
      }
      ASSERT_FALSE(touches.empty()) << "case " << k << ", step " << step;
      if (depth > 0.05 * smaller)
      {
        break;
      }
    }
  }
  EXPECT_GT(overlapping, 3 * count);
}

// Splinters that hit each other fast and spinning are stopped by their springs within about 1 % of
// the smaller one's radius, which is what these are made stiff enough for by the speeds of the
// centroids; spin may add to it.
TEST(Splinters, DoNotPassIntoEachOther)
{
  std::mt19937 random(23);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const Terrain ground = abyss();
  int met = 0;
  for (int k = 0; k < 150; ++k)
  {
    SimulationParameters p;
    p.gravity = 0.0;
    p.timeStep = 0.01;
    p.endTime = 0.8;
    p.rockRockContact = true;
    p.rockRestitution = 0.9;
    p.rockFrictionAngle = radians(30.0);
    std::vector<Rock> rocks(2);
    for (int i : { 0, 1 })
    {
      Rock& rock = rocks[i];
      rock.blockId = i;
      rock.shape = splinter(random, i == 0 ? 1.0 : std::pow(10.0, 0.5 * (u(random) - 1.0)));
      rock.position = Vec3(200.0 + (i == 0 ? -2.0 : 2.0), 200.0, 0.0);
      rock.velocity = Vec3(i == 0 ? 6.0 : -6.0, 0.5 * u(random), 0.5 * u(random));
      rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
      rock.angularVelocity = 10.0 * Vec3(u(random), u(random), u(random));
    }
    const std::vector<Block> blocks = blocksOf(rocks);
    const Surface surface(ground, p.seed, 0);
    World fall(surface, rocks, blocks, p);
    fall.release();
    double deepest = 0.0;
    while (fall.advance())
    {
      deepest = std::max(deepest,
        deepestOverlap(
          2, [&](int i) -> const Block& { return blocks[i]; },
          [&](int i) -> const BlockState& { return fall.state(i); }));
    }
    met += !fall.rock(0).trajectory().impacts.empty();
    EXPECT_LT(deepest, 0.02 * std::min(blocks[0].radius(), blocks[1].radius())) << "case " << k;
  }
  EXPECT_GT(met, 100);
}

// A rock that has taken off knows for how long nothing can be touched. That holds from the take-off
// on, and not for any later flight: it would end below the slope.
TEST(Splinters, WhatFliesIsOverTheSlope)
{
  for (const unsigned seed : { 1u, 3u })
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    Pile pile;
    pile.awake = false;
    pile.ground = makeSlope(
      41, 3.0,
      [](double x, double y) {
        return 0.02 * (x - 60.0) * (x - 60.0) + 3.0 * std::sin(y / 5.0) + 2.0 * std::cos(x / 4.0);
      },
      material(0.6, 40.0));
    pile.parameters.timeStep = 0.01;
    pile.parameters.endTime = 4.0;
    pile.parameters.rockFrictionAngle = radians(30.0);
    pile.parameters.rockRestitution = 0.5;
    for (int k = 0; k < someOf(120, 40); ++k)
    {
      Rock rock;
      rock.blockId = k;
      rock.shape = splinter(random, 0.25 * std::pow(10.0, 0.85 * u(random)));
      rock.position = Vec3(51.0 + 6.0 * u(random), 51.0 + 6.0 * u(random), 40.0 + 20.0 * u(random));
      rock.velocity = Vec3(10.0 * u(random), 5.0 * u(random), -15.0 * (1.0 + u(random)));
      rock.angularVelocity = 20.0 * Vec3(u(random), u(random), u(random));
      pile.rocks.push_back(rock);
    }
    pile.start();
    PlacedBlock placed;
    int flying = 0;
    for (bool goOn = true; goOn;)
    {
      goOn = pile.fall->advance();
      for (int k = 0; k < pile.fall->rocks(); ++k)
      {
        if (!pile.fall->rock(k).body().contacts.empty())
        {
          continue;
        }
        ++flying;
        placed.place(pile.blocks[k], pile.fall->state(k));
        for (const Vec3& p : placed.vertices())
        {
          // Where there is no ground, the elevation is NaN. Flight ends a hair over the slope.
          EXPECT_FALSE(pile.surface->elevation(p.x(), p.y()) - p.z() > 1e-9)
            << "seed " << seed << ", rock " << k << " at " << pile.fall->time() << " s";
        }
      }
    }
    EXPECT_GT(flying, someOf(40000, 8000));
  }
}

// Newton's law of restitution with friction may make energy under a long lever: an impact is scaled
// down to what makes none.
TEST(Splinters, BounceMakesNoEnergy)
{
  std::mt19937 random(41);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int bounced = 0;
  for (int k = 0; k < 800; ++k)
  {
    const bool between = k % 2 != 0, rough = k % 4 < 2;
    const std::array<Block, 2> blocks = { Block(splinter(random, 1.0), 2500.0, 1e9, 0.2),
      Block(splinter(random, std::pow(10.0, 0.8 * u(random))), 2500.0, 1e9, 0.2) };
    std::array<BlockState, 2> before;
    for (BlockState& s : before)
    {
      s.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
      s.velocity = 5.0 * Vec3(u(random), u(random), u(random));
      s.spin = 10.0 * Vec3(u(random), u(random), u(random));
    }
    // The lowest vertex of the first on the second, somewhere, or on the slope.
    PlacedBlock placed;
    placed.place(blocks[0], before[0]);
    const Vec3 point = *std::min_element(placed.vertices().begin(), placed.vertices().end(),
      [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
    before[1].position =
      point - blocks[1].radius() * Vec3(0.5 * u(random), 0.5 * u(random), 0.3 + 0.1 * u(random));
    const auto velocityAt = [&](const BlockState& s) -> Vec3
    { return s.velocity + s.angularVelocity().cross(point - s.position); };
    Vec3 relative = velocityAt(before[0]);
    relative -= between ? velocityAt(before[1]) : Vec3(Vec3::Zero());
    const double approach = -relative.z();
    if (approach < 1.0)
    {
      continue;
    }
    ++bounced;
    std::array<BlockState, 2> states = before;
    Contact c;
    c.point = point;
    c.normal = Vec3::UnitZ();
    c.distance = 1e-6;
    c.stiffness = c.shearStiffness = 1e9;
    std::vector<IslandContact> contacts(1);
    contacts[0].contact = &c;
    contacts[0].first = 0;
    contacts[0].second = between ? 1 : -1;
    contacts[0].friction = rough ? 1.0 : 0.0;
    contacts[0].restitution = k % 8 < 4 ? 1.0 : 0.8;
    std::vector<IslandBody> bodies(between ? 2 : 1);
    double energy = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i)
    {
      bodies[i].block = &blocks[i];
      bodies[i].state = &states[i];
      energy -= rigidKineticEnergy(blocks[i], states[i]);
    }
    SoftSolver solver;
    const StepRequest request = lastingStep(1e-4, 0.0); // so short that nothing turns
    solver.step(request, bodies, contacts, Accept::Any);
    for (std::size_t i = 0; i < bodies.size(); ++i)
    {
      energy += rigidKineticEnergy(blocks[i], states[i]);
    }
    const double incoming = 0.5 * c.normalForce * request.duration * approach;
    EXPECT_LT(energy, 0.01 * incoming) << "case " << k;
    if (!rough)
    {
      EXPECT_GT(energy, -(1.0 - 0.8 * 0.8 + 0.02) * incoming) << "case " << k;
    }
  }
  EXPECT_GT(bounced, 300);
}

// What turns a hundred times more easily about itself than across is spun up by any error of the
// turn, and by any impulse that the next one has to take back.
TEST(Splinters, NeedlesGainNothing)
{
  for (int seed = 0; seed < someOf(20, 4); ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937 random{ std::uint32_t(seed) };
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    Pile pile;
    pile.ground = makeSlope(
      41, 1.0, [](double x, double) { return 0.4 * std::abs(x - 20.0); }, material(0.3, 5.0));
    pile.parameters.rockRestitution = 0.3;
    pile.parameters.rockFrictionAngle = radians(64.0);
    const Surface bare = Surface::asSurveyed(pile.ground);
    for (int k = 0; k < 8; ++k)
    {
      // The last two are 30 times as heavy, and fall on the others.
      const double thick = std::pow(10.0, -1.5 + 0.5 * u(random));
      Rock rock =
        brick(k < 6 ? Vec3(0.2, 0.2 * thick, 0.2 * thick) : Vec3::Constant(0.06), Vec3::Zero(), k);
      rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
      const double x = 20.0 + 0.1 * u(random), y = 20.0 + 0.1 * u(random);
      rock.position =
        Vec3(x, y, touchingHeight(bare, rock.shape, rock.orientation, x, y) + 0.05 + 0.2 * k);
      rock.angularVelocity = 5.0 * Vec3(u(random), u(random), u(random));
      pile.rocks.push_back(rock);
    }
    pile.start();
    const auto energy = [&](std::size_t i)
    {
      const BlockState& state = pile.fall->state(int(i));
      return rigidKineticEnergy(pile.blocks[i], state) +
        pile.blocks[i].mass() * kGravity * state.position.z();
    };
    double released = 0.0, left = 0.0;
    for (std::size_t i = 0; i < 8; ++i)
    {
      released += energy(i);
    }
    while (pile.fall->time() < 2.0)
    {
      pile.fall->advance();
      left = 0.0;
      for (std::size_t i = 0; i < 8; ++i)
      {
        left += energy(i);
      }
      ASSERT_LE(left, 1.0001 * released);
    }
  }
}
