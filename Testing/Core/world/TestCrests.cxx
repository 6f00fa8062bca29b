// Thin rocks of a mass fall that others drive past the edges of walls: within a step they go farther
// than they are thick.

#include "piles.h"
#include "terrain/structures.h"

#include <gtest/gtest.h>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kWallHeight = 1.2, kWallLength = 20.0; // m, of the wall
const Eigen::Vector2d kWallEnd(100.0, 100.0);           // of its axis, which comes from −y

Polyhedron thinRock(int k, double length)
{
  switch (k % 3)
  {
    case 0:
      return makeBox(Vec3(length, 0.05 * length, 0.05 * length));
    case 1:
      return makeBox(Vec3(length, 0.6 * length, 0.05 * length));
    default:
      return makeBox(Vec3(length, 0.4 * length, 0.15 * length));
  }
}

/// A thin rock before the end of a wall, and boulders that come after it.
Pile chase(int seed, double width)
{
  std::mt19937_64 random{ std::uint64_t(seed) };
  std::uniform_real_distribution<double> u(0.0, 1.0);
  Pile pile;
  pile.ground = makeSlope(
    41, 5.0, [](double, double) { return 0.0; }, material(0.4 * u(random), 5.0));
  Embankment wall;
  wall.points = { kWallEnd - Eigen::Vector2d(0.0, kWallLength), kWallEnd };
  wall.height = kWallHeight;
  wall.crestWidth = width;
  wall.mountainSlope = wall.valleySlope = 0.0;
  Structures structures;
  structures.embankments = { wall };
  pile.ground.setStructures(structures);
  pile.parameters.timeStep = u(random) < 0.5 ? 0.005 : 0.01;
  pile.parameters.endTime = 1.5;
  pile.parameters.outputInterval = 0.01;
  pile.parameters.rockRestitution = 0.5 * u(random);
  const double azimuth = 6.283 * u(random), speed = 6.0 + 10.0 * u(random);
  const Vec3 out(std::cos(azimuth), std::sin(azimuth), 0.0);
  const Vec3 aim(kWallEnd.x() + u(random) - 0.5, kWallEnd.y() - u(random), 0.0);
  double away = 1.2;
  for (int k = 0; k < 4; ++k)
  {
    Rock rock;
    rock.blockId = k;
    rock.shape = k == 0 ? thinRock(seed, 0.5) : makeShape(Shape::Cube, 0.4);
    rock.orientation =
      Quat(u(random) - 0.5, u(random) - 0.5, u(random) - 0.5, u(random) - 0.5).normalized();
    const double r = rock.shape.radius();
    away += r + 0.02;
    rock.position = aim + away * out + (1.02 * r + kWallHeight * u(random)) * Vec3::UnitZ();
    away += r;
    rock.velocity = -(speed * (1.0 + 0.25 * k)) * out;
    pile.rocks.push_back(rock);
  }
  return pile;
}

} // namespace

TEST(Crests, ThinRocksThatOthersDriveDoNotSinkIn)
{
  constexpr double width = 0.2; // m
  const Block wall(makeBox({ width, kWallLength, kWallHeight + 2.0 }), 2500.0, 1e10, 0.25);
  BlockState standing;
  standing.position = Vec3(kWallEnd.x(), kWallEnd.y() - 0.5 * kWallLength, 0.5 * kWallHeight - 1.0);
  int met = 0;
  for (int seed = 0; seed < 60; ++seed)
  {
    Pile pile = chase(seed, width);
    pile.make();
    const Rock& thin = pile.rocks.front();
    const Block block(thin.shape, thin.density, thin.youngModulus, thin.poissonRatio);
    double deepest = 0.0;
    const std::vector<Trajectory> runs = pile.fall->run();
    for (const Sample& s : runs.front().samples)
    {
      BlockState state;
      state.position = s.position;
      state.orientation = s.orientation;
      deepest = std::max(deepest,
        deepestOverlap(
          2, [&](int i) -> const Block& { return i == 0 ? block : wall; },
          [&](int i) { return i == 0 ? state : standing; }));
    }
    met += deepest > 0.0;
    EXPECT_LT(deepest, 0.05 * block.radius()) << seed;
  }
  EXPECT_GT(met, 10);
}
