// A rock that comes near others goes on with softer springs: the same energy, the same rebound.

#include "piles.h"
#include "rock/parts/SlopeSprings.h"
#include "solve/island/island.h"

#include <gtest/gtest.h>

using namespace rockfall;
using namespace rockfall::testing;

TEST(Joining, KeepsTheEnergyAndTheReboundOfAnImpact)
{
  const Terrain ground = floorSlope();
  const Surface surface(ground, 1, 0);
  const Block block(makeShape(Shape::Cube, 1.0), 2500.0, 1e10, 0.2);
  SimulationParameters p;
  p.rockRockContact = true;
  SlopeSprings springs(surface, p, block);
  RockBody body(block);
  body.stiff = true;
  body.state.position = Vec3(50.0, 50.0, 0.5);
  body.state.velocity = Vec3(0.0, 0.0, -1.0);
  body.placed.place(block, body.state);
  springs.beginContact(body);
  for (const double turn : { 0.0, 0.4 }) // about x, rad
  {
    body.state.orientation = Quat(Eigen::AngleAxisd(turn, Vec3::UnitX()));
    body.placed.place(block, body.state);
    Contact c;
    c.normal = Vec3::UnitZ();
    c.point = Vec3(50.4, 50.3, 0.0);
    c.cfe = ground.cfeAt(50.0, 50.0);
    springs.part(body);
    springs.give(c, body, 0.6);
    c.state = ContactState::Locked;
    c.distance = -2e-5;
    c.offset = 1e-5;
    c.slip = Vec3(1e-5, 0.0, 0.0);
    body.contacts = { c };
    ASSERT_NEAR(springs.leastPenalty(), 1e8 * block.mass(), 1.0);

    springs.join(body);
    const Contact& softer = body.contacts[0];
    EXPECT_EQ(springs.leastPenalty(), 1e9);
    EXPECT_LT(softer.stiffness, 1e9);
    EXPECT_LT(softer.stiffness, 0.2 * c.stiffness); // the block behind it gives as before
    EXPECT_EQ(softer.distance, c.distance);
    EXPECT_NEAR(softer.springEnergy(), c.springEnergy(), 1e-12 * c.springEnergy());
    for (const double approach : { -2.0, 0.0, 3.0 })
    {
      EXPECT_NEAR(bounceLeft(softer, approach), bounceLeft(c, approach), 1e-9) << approach;
    }
    // Once only.
    const Contact once = softer;
    springs.join(body);
    EXPECT_EQ(body.contacts[0].stiffness, once.stiffness);
    EXPECT_EQ(body.contacts[0].offset, once.offset);
  }
}

TEST(Joining, StopsAFastRockWithinATenthOfItsRadius)
{
  const Terrain ground = floorSlope();
  const Surface surface(ground, 1, 0);
  for (const double volume : { 0.1, 1.0, 100.0 })
  {
    const Block block(makeShape(Shape::Cube, volume), 2700.0, 5e10, 0.2);
    SimulationParameters p;
    p.rockRockContact = true;
    SlopeSprings springs(surface, p, block);
    RockBody body(block);
    body.state.position = Vec3(50.0, 50.0, 0.5 * std::cbrt(volume));
    body.state.velocity.z() = -50.0;
    body.placed.place(block, body.state);
    springs.beginContact(body);
    Contact c;
    c.point = Vec3(50.0, 50.0, 0.0);
    c.cfe = ground.cfeAt(50.0, 50.0);
    springs.give(c, body, 0.6);
    // Where it turns the spring holds all of its energy.
    c.state = ContactState::Locked;
    c.distance = -50.0 * std::sqrt(block.mass() / c.stiffness);
    body.contacts = { c };
    body.state.velocity.setZero();
    springs.join(body);
    EXPECT_LE(-body.contacts[0].gap(), (0.1 + 1e-9) * block.radius()) << volume;
  }
}

TEST(Joining, SpringsOfTheUserStay)
{
  const Terrain ground = floorSlope();
  const Surface surface(ground, 1, 0);
  const Block block(makeShape(Shape::Cube, 1.0), 2500.0, 1e10, 0.2);
  SimulationParameters p;
  p.rockRockContact = true;
  p.normalPenalty = 1e10;
  SlopeSprings springs(surface, p, block);
  RockBody body(block);
  springs.join(body);
  EXPECT_EQ(springs.leastPenalty(), 1e10);
  springs.part(body);
  EXPECT_EQ(springs.leastPenalty(), 1e10);
}
