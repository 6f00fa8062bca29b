// A rock alone that is found deep in the slope.

#include "piles.h"
#include "rock/fall/SingleRock.h"

#include <gtest/gtest.h>

using namespace rockfall;
using namespace rockfall::testing;

// As in an island it goes as place, within some steps, and leaves no speed behind.
TEST(DeepOverlap, GoesAsPlaceUnderARockAlone)
{
  const Terrain ground = floorSlope();
  const Surface surface(ground, 1, 0);
  SimulationParameters parameters;
  parameters.timeStep = 0.005;
  parameters.endTime = 10.0;
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.position = Vec3(20.0, 20.0, 0.5);
  const Block block(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio);
  SingleRock single(surface, rock, block, parameters);
  single.begin();
  single.advance(0.1);
  RockBody& body = single.body();
  ASSERT_EQ(closedCount(body.contacts), 4);
  constexpr double kDeep = 0.05;
  body.state.position.z() -= kDeep;
  for (Contact& c : body.contacts)
  {
    c.distance -= kDeep;
    c.offset -= kDeep;
  }
  single.advance(0.15);
  EXPECT_NEAR(body.state.position.z(), 0.5, 0.001);
  EXPECT_LT(body.state.velocity.norm(), 0.01);
  single.advance(0.3);
  EXPECT_NEAR(body.state.position.z(), 0.5, 0.001);
  EXPECT_LT(std::abs(body.energy.numerical), 1e-6 * block.mass() * 9.81 * kDeep);
}
