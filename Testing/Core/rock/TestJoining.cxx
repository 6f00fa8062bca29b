// A rock that comes near others goes on with softer springs: the same energy, the same rebound.

#include "piles.h"
#include "rock/parts/SlopeSprings.h"
#include "solve/island/island.h"

#include <gtest/gtest.h>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// A cube that comes down on a level floor, in a mass fall.
struct Landing
{
  Terrain ground = floorSlope();
  Surface surface{ ground, 1, 0 };
  Block block;
  SimulationParameters parameters;
  SlopeSprings springs{ surface, parameters, block };
  RockBody body{ block };

  /// Volume, m³; Young's modulus, Pa; speed, m/s; pₙ, N/m.
  Landing(double volume, double young, double speed, double penalty = 0.0)
    : block(makeShape(Shape::Cube, volume), 2500.0, young, 0.2)
  {
    parameters.rockRockContact = true;
    parameters.normalPenalty = penalty;
    springs.part(body);
    body.state.position = Vec3(50.0, 50.0, 0.5 * std::cbrt(volume));
    body.state.velocity.z() = -speed;
    body.placed.place(block, body.state);
    springs.beginContact(body);
  }
  Contact contactAt(const Vec3& point)
  {
    Contact c;
    c.point = point;
    c.cfe = ground.cfeAt(point.x(), point.y());
    springs.give(c, body, 0.6);
    c.state = ContactState::Locked;
    return c;
  }
};

} // namespace

TEST(Joining, KeepsTheEnergyAndTheReboundOfAnImpact)
{
  Landing landing(1.0, 1e10, 1.0);
  SlopeSprings& springs = landing.springs;
  RockBody& body = landing.body;
  body.stiff = true;
  for (const double turn : { 0.0, 0.4 }) // about x, rad
  {
    body.state.orientation = Quat(Eigen::AngleAxisd(turn, Vec3::UnitX()));
    body.placed.place(landing.block, body.state);
    springs.part(body);
    Contact c = landing.contactAt(Vec3(50.4, 50.3, 0.0));
    c.distance = -2e-5;
    c.offset = 1e-5;
    c.slip = Vec3(1e-5, 0.0, 0.0);
    body.contacts = { c };
    ASSERT_NEAR(springs.leastPenalty(), 1e8 * landing.block.mass(), 1.0);

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
  for (const double volume : { 0.1, 1.0, 100.0 })
  {
    Landing landing(volume, 5e10, 50.0);
    RockBody& body = landing.body;
    // Where it turns the spring holds all of its energy.
    Contact c = landing.contactAt(Vec3(50.0, 50.0, 0.0));
    c.distance = body.state.velocity.z() * std::sqrt(landing.block.mass() / c.stiffness);
    body.contacts = { c };
    body.state.velocity.setZero();
    landing.springs.join(body);
    EXPECT_LE(-body.contacts[0].gap(), (0.1 + 1e-9) * landing.block.radius()) << volume;
  }
}

TEST(Joining, SpringsOfTheUserStay)
{
  Landing landing(1.0, 1e10, 0.0, 1e10);
  landing.springs.join(landing.body);
  EXPECT_EQ(landing.springs.leastPenalty(), 1e10);
  landing.springs.part(landing.body);
  EXPECT_EQ(landing.springs.leastPenalty(), 1e10);
}
