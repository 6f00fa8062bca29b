// Stones that far heavier rocks press against the ground, or against each other, get no more of
// their energy than an impact can give them.

#include "form.h"
#include "law/settings.h"
#include "piles.h"
#include "rock/placement.h"
#include "solve/island/SoftSolver.h"
#include "terrain/structures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

Quat anyAttitude(std::mt19937_64& random)
{
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const double w = u(random), x = u(random), y = u(random), z = u(random);
  return Quat(w, x, y, z).normalized();
}

double deepest(const Trajectory& t)
{
  double most = 0.0;
  for (const Sample& s : t.samples)
  {
    most = std::max(most, -s.heightOverGround);
  }
  return most;
}

/// Level ground and an upright wall of 6 m with its face at this x, so thick (m).
Pile levelWithWall(double face, double width, double timeStep)
{
  Pile pile;
  pile.ground = makeSlope(
    41, 5.0, [](double, double) { return 0.0; }, material(0.5, 20.0));
  Embankment wall;
  wall.points = { { face + 0.5 * width, 20.0 }, { face + 0.5 * width, 180.0 } };
  wall.height = 6.0;
  wall.crestWidth = width;
  wall.mountainSlope = wall.valleySlope = 0.0;
  Structures structures;
  structures.embankments = { wall };
  pile.ground.setStructures(structures);
  pile.parameters.timeStep = timeStep;
  pile.parameters.endTime = 0.8;
  pile.parameters.outputInterval = 0.01;
  pile.parameters.rockRestitution = 0.3;
  return pile;
}

} // namespace

// An icosahedron of 75 t straight down on one so many times smaller that lies on the ground.
TEST(Pinched, StoneUnderABoulderIsNotShotOut)
{
  for (const double ratio : { 5.0, 10.0, 20.0, 50.0, 100.0 })
  {
    for (const double speed : { 10.0, 30.0 })
    {
      for (int seed = 0; seed < someOf(6, 1); ++seed)
      {
        SCOPED_TRACE("1:" + std::to_string(int(ratio)) + ", seed " + std::to_string(seed));
        std::mt19937_64 random{ std::uint64_t(seed) };
        std::uniform_real_distribution<double> u(-1.0, 1.0);
        Pile pile;
        pile.awake = false;
        pile.ground = makeSlope(
          81, 5.0, [](double, double) { return 0.0; }, material(0.4, 30.0));
        pile.parameters.timeStep = seed % 2 == 0 ? 0.002 : 0.005;
        pile.parameters.endTime = 1.5;
        const Surface bare = Surface::asSurveyed(pile.ground);
        Rock stone, boulder;
        boulder.blockId = 1;
        boulder.shape = makeShape(Shape::Icosahedron, 30.0);
        boulder.orientation = anyAttitude(random);
        stone.shape = makeShape(Shape::Icosahedron, 30.0 / std::pow(ratio, 3));
        stone.orientation = anyAttitude(random);
        const double r = stone.shape.radius();
        const auto over = [&](Rock& rock, double x, double y, double up)
        {
          const double z = touchingHeight(bare, rock.shape, rock.orientation, x, y);
          rock.position = Vec3(x, y, z + up);
        };
        over(stone, 200.0, 200.0, 0.0);
        const double x = 200.0 + 0.3 * u(random), y = 200.0 + 0.3 * u(random);
        over(boulder, x, y, 3.0 * r);
        boulder.velocity.z() = -speed;
        pile.rocks = { stone, boulder };
        pile.make();
        const std::vector<Trajectory> runs = pile.fall->run();
        const Trajectory& t = runs[0];
        // What a wall that comes at this speed can give it, without loss.
        EXPECT_LT(t.summary.maxSpeed, 2.0 * speed);
        EXPECT_LT(deepest(t), 0.25 * r);
        EXPECT_LT((t.samples.back().position - stone.position).norm(), 0.4 * speed);
        // What went in is pressed out again, which raises the rocks.
        EXPECT_GT(t.samples.back().heightOverGround, -0.1 * r);
        for (std::size_t i = 0; i < runs.size(); ++i)
        {
          const double out = i == 0 ? 0.25 * r : kLooseOverlap * pile.blocks[i].radius();
          const double raised = pile.blocks[i].mass() * kGravity * out;
          const EnergyAudit& e = runs[i].summary.energy;
          EXPECT_LT(std::abs(e.numerical), 1e-5 * 75e3 * speed * speed + raised);
        }
      }
    }
  }
}

TEST(Pinched, OverlapThatABounceLeavesHoldsNoEnergy)
{
  // A cube in the slope or in another one, open, that leaves by a bounce but is still in there at
  // the end of the step; once it is pushed by the contact, once it flies up as fast as that anyway.
  const Block block(makeShape(Shape::Cube, 1.0), 2500.0, 1e9, 0.2);
  for (int k = 0; k < 4; ++k)
  {
    SCOPED_TRACE(k);
    const bool between = k % 2 == 0, pushed = k < 2;
    std::array<BlockState, 2> states;
    states[0].velocity.z() = pushed ? -1.0 : 5.0;
    states[1].position.z() = -0.9;
    Contact c;
    c.point = Vec3(0.0, 0.0, -0.5);
    c.normal = Vec3::UnitZ();
    c.distance = -0.1;
    c.stiffness = c.shearStiffness = 1e9;
    std::vector<IslandContact> contacts(1);
    contacts[0].contact = &c;
    contacts[0].first = 0;
    contacts[0].second = between ? 1 : -1;
    contacts[0].restitution = 0.5;
    std::vector<IslandBody> bodies(between ? 2 : 1);
    for (std::size_t i = 0; i < bodies.size(); ++i)
    {
      bodies[i].block = &block;
      bodies[i].state = &states[i];
    }
    SoftSolver solver;
    const StepRequest request = lastingStep(1e-3, 0.0);
    for (int step = 0; step < 2; ++step)
    {
      contacts[0].closed = c.closed();
      solver.step(request, bodies, contacts, Accept::Any);
      EXPECT_NEAR(states[0].velocity.z() - states[1].velocity.z(), pushed ? 0.5 : 5.0, 0.02);
      EXPECT_LT(c.distance, -0.075); // goes at 10 m/s at most
      EXPECT_GT(c.gap(), -1e-9);
    }
  }
}

TEST(Pinched, WhatASpringHoldsIsAllThatALoadGets)
{
  // A stone that is pressed into the slope in the middle of an impact, with boulders of up to 1000
  // times its mass on it: it leaves no faster than the energy of its spring drives all of them.
  for (const double mass : { 1e-2, 1.0, 30.0, 1000.0 })
  {
    SCOPED_TRACE(mass);
    const Block stone(makeShape(Shape::Cube, 0.03), 2500.0, 1e9, 0.2);
    const Block boulder(makeShape(Shape::Cube, 0.03 * mass), 2500.0, 1e9, 0.2);
    const double h = 5e-3, half = 0.5 * std::cbrt(0.03), other = 0.5 * std::cbrt(0.03 * mass);
    std::array<BlockState, 2> states;
    states[1].position.z() = half + other;
    std::array<Contact, 2> touches;
    std::vector<IslandContact> contacts(2);
    for (std::size_t k = 0; k < 2; ++k)
    {
      Contact& c = touches[k];
      c.normal = Vec3::UnitZ();
      c.point = Vec3(0.0, 0.0, k == 0 ? -half : half);
      c.stiffness = c.shearStiffness = 1e9;
      c.stopped = stone.mass();
      contacts[k].contact = &c;
    }
    touches[0].state = ContactState::Sliding;
    touches[0].distance = -4e-3;
    contacts[0].first = 0;
    contacts[0].closed = true;
    contacts[0].reboundSpeed = bounceLeft(touches[0], 0.0);
    touches[1].distance = 1e-6;
    contacts[1].first = 1;
    contacts[1].second = 0;
    std::vector<IslandBody> bodies(2);
    bodies[0].block = &stone;
    bodies[1].block = &boulder;
    for (std::size_t i = 0; i < 2; ++i)
    {
      bodies[i].state = &states[i];
    }
    const double stored = touches[0].springEnergy();
    EXPECT_NEAR(contacts[0].reboundSpeed, std::sqrt(2.0 * stored / stone.mass()), 1e-3);
    SoftSolver solver;
    const StepRequest request = lastingStep(h, 0.0);
    solver.step(request, bodies, contacts, Accept::Any);
    const double moving =
      rigidKineticEnergy(stone, states[0]) + rigidKineticEnergy(boulder, states[1]);
    EXPECT_LT(moving, 1.05 * stored);
    EXPECT_GE(states[0].velocity.z(), -1e-12);
  }
}

TEST(Pinched, StepThatMissesDeeplyIsCut)
{
  // Rows of what a look finds are carried straight back from the end of the step: from deep in a
  // rock a shorter step is surer.
  const Block block(makeShape(Shape::Cube, 1.0), 2500.0, 1e9, 0.2);
  for (const double missed : { 0.5 * kCutMiss, 2.0 * kCutMiss })
  {
    for (const Accept accept : { Accept::Settled, Accept::Any })
    {
      SCOPED_TRACE(std::to_string(missed) + ", accept " + std::to_string(int(accept)));
      BlockState state;
      state.velocity.z() = -1.0;
      Contact c;
      c.point = Vec3(0.0, 0.0, -0.5);
      c.normal = Vec3::UnitZ();
      c.distance = 0.1;
      c.stiffness = c.shearStiffness = 1e9;
      std::vector<IslandContact> contacts(1);
      contacts[0].contact = &c;
      contacts[0].first = 0;
      std::vector<IslandBody> bodies(1);
      bodies[0].block = &block;
      bodies[0].state = &state;
      SoftSolver solver;
      solver.begin(lastingStep(1e-3, 0.0), accept, bodies, contacts);
      ASSERT_TRUE(solver.asksForALook());
      EndDetectionOutcome seen;
      seen.missed = missed;
      solver.goOn(seen);
      const bool cut = missed > kCutMiss && accept != Accept::Any;
      EXPECT_EQ(solver.asksForALook(), !cut);
      if (!cut)
      {
        solver.goOn({});
      }
      EXPECT_EQ(solver.finish().accepted, !cut);
      EXPECT_NEAR(state.position.z(), cut ? 0.0 : -1e-3, 1e-12);
    }
  }
}

// A boulder drives a stone against an upright wall. Behind its far side, too, it is not drawn in.
TEST(Pinched, StoneBetweenABoulderAndAThinWallStaysBeforeIt)
{
  const auto runs = [](double width, double side, double boulder, double speed, double step)
  {
    constexpr double face = 100.0; // m, along x
    Pile pile = levelWithWall(face, width, step);
    const double x = face - 0.05 - 0.5 * side;
    pile.rocks = { brick(Vec3(side, side, side), Vec3(x, 100.0, 0.5 * side + 0.001), 0),
      brick(Vec3(boulder, boulder, boulder),
        Vec3(x - 0.5 * side - 0.5 * boulder - 0.5, 100.0, 0.5 * boulder + 0.01), 1) };
    pile.rocks[1].velocity = Vec3(speed, 0.0, 0.0);
    pile.make();
    return pile.fall->run();
  };
  for (const double step : { 0.01, 0.005 })
  {
    for (const double side : { 0.3, 0.5 })
    {
      for (const double boulder : { 1.5, 2.5 })
      {
        for (const double speed : { 10.0, 25.0 })
        {
          for (const double width : { 0.125, 0.25, 1.0, 4.0 })
          {
            SCOPED_TRACE(::testing::Message()
              << "wall " << width << " m, stone " << side << " m, boulder " << boulder << " m, "
              << speed << " m/s, step " << step << " s");
            const std::vector<Trajectory> rocks = runs(width, side, boulder, speed, step);
            for (const Sample& s : rocks[0].samples)
            {
              EXPECT_LT(s.position.x() + 0.5 * side, 100.0 + 0.05 * side) << s.time;
            }
          }
        }
      }
    }
  }
}

// A boulder drives a plate, thinner than its way within a step, flat against an upright wall.
TEST(Pinched, PlateBetweenABoulderAndAWallDoesNotGoThrough)
{
  constexpr double face = 100.0; // m, along x
  for (const double thickness : { 0.05, 0.1, 0.2 })
  {
    for (const double width : { 0.15, 0.3, 1.0 })
    {
      for (const double speed : { 15.0, 25.0 })
      {
        for (const double gap : { 0.02, 0.1, 0.3 })
        {
          SCOPED_TRACE(::testing::Message() << "plate " << thickness << " m, wall " << width
                                            << " m, " << speed << " m/s, gap " << gap << " m");
          Pile pile = levelWithWall(face, width, 0.005);
          pile.rocks = { brick(Vec3(thickness, 1.0, 1.0),
                           Vec3(face - gap - 0.5 * thickness, 100.0, 0.501), 0),
            brick(Vec3(1.5, 1.5, 1.5), Vec3(face - gap - thickness - 0.9, 100.0, 0.76), 1) };
          pile.rocks[1].velocity = Vec3(speed, 0.0, 0.0);
          pile.make();
          const std::vector<Trajectory> runs = pile.fall->run();
          for (const Sample& s : runs.front().samples)
          {
            ASSERT_LT(s.position.x(), face + 0.02) << s.time;
          }
        }
      }
    }
  }
}

TEST(Pinched, StonesAmongFallingBouldersAreNotShotOut)
{
  // Three boulders of 10 m³ and twelve stones of 1:5 to 1:12 fall 25 m and more onto a bench.
  for (int seed = 0; seed < 12; ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937_64 random{ std::uint64_t(seed) };
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    Pile pile;
    pile.awake = false;
    pile.ground = makeSlope(
      101, 4.0, [](double x, double) { return x < 120.0 ? 200.0 : 200.0 - 0.466 * (x - 120.0); },
      material(0.35, 32.0));
    pile.parameters.endTime = 6.0;
    for (int k = 0; k < 15; ++k)
    {
      Rock rock;
      rock.blockId = k;
      const bool large = k < 3;
      const double ratio = 8.5 + 3.5 * u(random);
      rock.shape = makeShape(Shape(2 + k % 3), large ? 10.0 : 10.0 / std::pow(ratio, 3));
      rock.orientation = anyAttitude(random);
      const double x = large ? 110.0 + 3.2 * k : 108.5 + 0.8 * (k - 3) + 0.1 * u(random);
      const double y = 200.0 + (large ? 0.5 : 0.7) * u(random);
      rock.position = Vec3(x, y, large ? 229.0 : 225.0);
      pile.rocks.push_back(rock);
    }
    pile.make();
    const std::vector<Trajectory> runs = pile.fall->run();
    for (std::size_t k = 3; k < runs.size(); ++k)
    {
      const Trajectory& t = runs[k];
      const double lowest = std::min(200.0, t.samples.back().position.z()) - 1.0;
      const double fallen = std::sqrt(2.0 * kGravity * (pile.rocks[0].position.z() - lowest));
      EXPECT_LT(t.summary.maxSpeed, 2.0 * fallen) << k;
      EXPECT_GT(t.samples.back().heightOverGround, -0.1 * pile.rocks[k].shape.radius()) << k;
    }
  }
}
