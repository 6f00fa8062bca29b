// A rock alone that is found deep in the slope.

#include "piles.h"
#include "rock/fall/SingleRock.h"
#include "terrain/structures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kDeep = 0.05; // m

/// A cube of 1 m that rests on a level floor about (20, 20).
struct Resting
{
  Terrain ground = floorSlope();
  SimulationParameters parameters;
  Rock rock;
  std::unique_ptr<Surface> surface;
  std::unique_ptr<Block> block;
  std::unique_ptr<SingleRock> single;

  RockBody& body() { return single->body(); }
  /// At rest for so long, s.
  void begin(double seconds)
  {
    parameters.timeStep = 0.005;
    parameters.endTime = 10.0;
    rock.shape = makeShape(Shape::Cube, 1.0);
    rock.position = Vec3(20.0, 20.0, 0.5);
    surface = std::make_unique<Surface>(ground, 1, 0);
    block = std::make_unique<Block>(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio);
    single = std::make_unique<SingleRock>(*surface, rock, *block, parameters);
    single->begin();
    single->advance(seconds);
    ASSERT_FALSE(this->body().done);
  }
  /// Found deep in the floor.
  void sink()
  {
    this->body().state.position.z() -= kDeep;
    for (Contact& c : this->body().contacts)
    {
      c.distance -= kDeep * c.normal.z();
      c.offset -= kDeep * c.normal.z();
    }
  }
  /// Out again where it was, no faster than what its weight, set down at once, strains it: g/ω.
  void expectOut(double height)
  {
    const double slow = 0.01 + (this->body().stiff ? 0.0 : kGravity / block->strainFrequency());
    for (const double later : { 0.05, 0.2 })
    {
      single->advance(this->body().state.time + later);
      EXPECT_NEAR(this->body().state.position.z(), height, 0.001);
      EXPECT_NEAR(this->body().state.position.x(), 20.0, 0.1 * kDeep);
      EXPECT_LT(this->body().state.velocity.norm(), slow);
    }
    EXPECT_LT(std::abs(this->body().energy.numerical), 1e-6 * block->mass() * kGravity * kDeep);
  }
};

/// Stems at the two sides of the cube along x, so far off (m).
Structures stemsBeside(double gap, double capacity)
{
  Structures structures;
  Tree tree;
  tree.diameter = 0.3;
  tree.height = 20.0;
  tree.capacity = capacity;
  // From the axis to the flats of a prism of eight sides of the stem's section.
  const double flat = 0.15 * std::sqrt(std::numbers::pi / (8.0 * std::tan(std::numbers::pi / 8.0)));
  for (const double side : { -1.0, 1.0 })
  {
    tree.position = { 20.0 + side * (0.5 + flat + gap), 20.0 };
    structures.trees.push_back(tree);
  }
  return structures;
}

} // namespace

// As in an island it goes as place, within some steps, and leaves no speed behind.
TEST(DeepOverlap, GoesAsPlaceUnderARockAlone)
{
  Resting cube;
  cube.begin(0.1);
  ASSERT_EQ(closedCount(cube.body().contacts), 4);
  cube.sink();
  cube.expectOut(0.5);
}

TEST(DeepOverlap, GoesAsPlaceUnderASoftRockAlone)
{
  for (const double modulus : { 1e7, 1e8 })
  {
    SCOPED_TRACE(modulus);
    Resting cube;
    cube.rock.youngModulus = modulus;
    cube.begin(0.3);
    ASSERT_FALSE(cube.body().stiff);
    ASSERT_GT(closedCount(cube.body().contacts), 0);
    const double height = cube.body().state.position.z();
    cube.sink();
    cube.expectOut(height);
  }
}

TEST(DeepOverlap, GoesAsPlaceBetweenStems)
{
  for (const double gap : { 0.0005, 0.02 })
  {
    for (const double modulus : { 1e8, 1e10 })
    {
      SCOPED_TRACE(std::to_string(gap) + ' ' + std::to_string(modulus));
      Resting cube;
      cube.rock.youngModulus = modulus;
      cube.ground.setStructures(stemsBeside(gap, 10.0));
      cube.begin(0.3);
      const double height = cube.body().state.position.z();
      cube.sink();
      cube.expectOut(height);
      EXPECT_EQ(cube.body().energy.structures, 0.0); // both stand
    }
  }
}
