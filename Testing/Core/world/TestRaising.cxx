// Rocks of a mass fall that rough ground or an embankment lifts at their release: into no other
// one.

#include "piles.h"
#include "rock/placement.h"
#include "run/overlaps.h"
#include "terrain/Obstacles.h"
#include "world/raising.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

Terrain roughFloor(double deviation)
{
  return makeSlope(
    41, 1.0, [](double, double) { return 0.0; }, material(0.5, 35.0), Roughness{ 0.0, deviation });
}

/// Twenty-seven cubes of 1 m, face to face.
std::vector<Rock> cutMass(const Vec3& corner)
{
  std::vector<Rock> rocks;
  for (int i = 0; i < 27; ++i)
  {
    rocks.push_back(brick(Vec3(1, 1, 1), corner + Vec3(0.5 + i / 9, 0.5 + i / 3 % 3, 0.5 + i % 3),
      std::int64_t(rocks.size())));
  }
  return rocks;
}

/// Rocks of several shapes, edges of 1 : 10, thrown into a disc on the ground as surveyed.
std::vector<Rock> thrown(const Terrain& ground, int count, unsigned seed)
{
  const Shape shapes[] = { Shape::Cube, Shape::Eota221, Shape::Tetrahedron, Shape::Octahedron,
    Shape::Dodecahedron };
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto number = [&] { return unit(random); };
  std::vector<Rock> rocks;
  for (int i = 0; i < count; ++i)
  {
    const double edge = std::pow(10.0, -number());
    Rock rock;
    rock.blockId = i;
    rock.shape = makeShape(shapes[i % 5], 2.0 * edge * edge * edge);
    const double u = number(), v = number();
    rock.orientation = randomRotation(u, v, number());
    const double x = 18.5 + 3.0 * number(), y = 18.5 + 3.0 * number();
    rock.position =
      Vec3(x, y, touchingHeight(Surface::asSurveyed(ground), rock.shape, rock.orientation, x, y));
    rocks.push_back(rock);
  }
  return rocks;
}

/// The rocks of a pile as they stand.
std::vector<Rock> now(const Pile& pile)
{
  std::vector<Rock> rocks = pile.rocks;
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    rocks[i].position = pile.fall->state(int(i)).position;
    rocks[i].orientation = pile.fall->state(int(i)).orientation;
  }
  return rocks;
}

/// Of the deepest in the ground of an iteration, m.
double deepestInGround(const Surface& ground, const std::vector<Rock>& rocks)
{
  double deepest = 0.0;
  for (const Rock& rock : rocks)
  {
    const double height = touchingHeight(
      ground, rock.shape, rock.orientation.normalized(), rock.position.x(), rock.position.y());
    deepest = std::max(deepest, (height - rock.position.z()) / rock.shape.radius());
  }
  return deepest;
}

std::vector<RaisedRock> raisedOf(
  const std::vector<Rock>& rocks, const std::vector<Block>& blocks, const std::vector<double>& by)
{
  std::vector<RaisedRock> raised(rocks.size());
  for (std::size_t i = 0; i < rocks.size(); ++i)
  {
    raised[i].block = &blocks[i];
    raised[i].state.position = rocks[i].position;
    raised[i].state.orientation = rocks[i].orientation;
    raised[i].lift = by[i];
  }
  return raised;
}

} // namespace

TEST(Raising, JointsOfACutMassStayClosedOnRoughGround)
{
  const Terrain ground = roughFloor(0.05);
  const std::vector<Rock> rocks = cutMass(Vec3(19.0, 19.0, 0.0));
  SimulationParameters p;
  p.rockRockContact = true;
  p.iterations = 8;
  p.endTime = 0.02;
  TrajectoryStore one, three;
  p.threads = 1;
  ASSERT_TRUE(runEnsemble(ground, rocks, p, one));
  p.threads = 3;
  ASSERT_TRUE(runEnsemble(ground, rocks, p, three));
  double highest = 0.0;
  for (int iteration = 0; iteration < p.iterations; ++iteration)
  {
    std::vector<Rock> released = rocks;
    for (std::size_t i = 0; i < rocks.size(); ++i)
    {
      const std::size_t k = rocks.size() * std::size_t(iteration) + i;
      EXPECT_EQ(one.trajectories()[k].summary.hash, three.trajectories()[k].summary.hash);
      released[i].position = one.trajectories()[k].samples.front().position;
      EXPECT_NEAR(
        (released[i].position - released[0].position - rocks[i].position + rocks[0].position)
          .norm(),
        0.0, 1e-12);
    }
    EXPECT_TRUE(findOverlaps(released).empty()) << iteration;
    EXPECT_LT(deepestInGround(Surface(ground, p.seed, iteration), released), 1e-5) << iteration;
    highest = std::max(highest, released[0].position.z() - rocks[0].position.z());
  }
  EXPECT_GT(highest, 0.05);
  EXPECT_LT(highest, 0.3);
}

TEST(Raising, RocksPushedApartStayApartOnRoughGround)
{
  Pile pile;
  pile.ground = roughFloor(0.1);
  pile.rocks = thrown(pile.ground, 120, 3);
  pushApart(pile.ground, pile.rocks);
  pile.start();
  const std::vector<Rock> released = now(pile);
  EXPECT_TRUE(findOverlaps(released).empty());
  EXPECT_LT(deepestInGround(*pile.surface, released), 1e-5);
  int lifted = 0;
  for (std::size_t i = 0; i < released.size(); ++i)
  {
    const Vec3 way = released[i].position - pile.rocks[i].position;
    EXPECT_EQ(way.head<2>().norm(), 0.0);
    EXPECT_GE(way.z(), 0.0);
    EXPECT_LT(way.z(), 0.6);
    lifted += way.z() > 0.0;
  }
  EXPECT_GT(lifted, 60);
}

TEST(Raising, BesideAnEmbankment)
{
  // A column that reaches into it, a cube free over where that comes to, and one that is clear.
  Pile pile;
  pile.ground = roughFloor(0.0);
  Embankment e;
  e.feature = 1;
  e.points = { { 25.0, 5.0 }, { 25.0, 35.0 } };
  e.height = 3.0;
  e.crestWidth = 2.0;
  e.mountainSlope = e.valleySlope = 0.0;
  Structures s;
  s.embankments = { e };
  pile.ground.setStructures(s);
  pile.rocks = { brick(Vec3(1, 1, 1), Vec3(23.9, 20.0, 0.5), 0),
    brick(Vec3(1, 1, 1), Vec3(23.3, 20.2, 1.5), 1), brick(Vec3(1, 1, 1), Vec3(23.1, 20.0, 2.7), 2),
    brick(Vec3(1, 1, 1), Vec3(21.0, 20.0, 0.5), 3) };
  pile.start();
  const std::vector<Rock> released = now(pile);
  EXPECT_TRUE(findOverlaps(released).empty());
  EXPECT_NEAR(released[0].position.z(), 3.5, 0.02);
  EXPECT_NEAR(released[1].position.z() - released[0].position.z(), 1.0, 1e-12);
  EXPECT_NEAR(released[2].position.z() - released[1].position.z(), 1.0, 1e-5);
  EXPECT_EQ(released[3].position, pile.rocks[3].position);
}

TEST(Raising, WhereNothingIsLiftedNothingMoves)
{
  Pile pile;
  pile.ground = roughFloor(0.0);
  pile.rocks = thrown(pile.ground, 60, 4);
  pushApart(pile.ground, pile.rocks);
  for (const Rock& rock : cutMass(Vec3(30.0, 30.0, 0.0)))
  {
    pile.rocks.push_back(rock);
  }
  pile.start();
  for (std::size_t i = 0; i < pile.rocks.size(); ++i)
  {
    EXPECT_EQ(pile.fall->state(int(i)).position, pile.rocks[i].position) << i;
  }
}

TEST(Raising, AsFarAsItTakesAndNoFarther)
{
  const Terrain ground = roughFloor(0.0);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int carried = 0;
  for (unsigned seed = 0; seed < 6; ++seed)
  {
    std::vector<Rock> rocks = thrown(ground, 60, seed);
    pushApart(ground, rocks);
    ASSERT_TRUE(findOverlaps(rocks).empty());
    std::vector<double> given;
    for (std::size_t i = 0; i < rocks.size(); ++i)
    {
      given.push_back(i % 3 == 0 ? (seed % 2 ? 4.0 : 0.2) * unit(random) : 0.0);
    }
    const std::vector<Block> blocks = blocksOf(rocks);
    std::vector<RaisedRock> raised = raisedOf(rocks, blocks, given);
    raiseOthers(raised);
    for (std::size_t i = 0; i < rocks.size(); ++i)
    {
      rocks[i].position.z() += raised[i].lift;
    }
    EXPECT_TRUE(findOverlaps(rocks).empty()) << seed;
    const double most = *std::max_element(given.begin(), given.end());
    for (std::size_t i = 0; i < rocks.size(); ++i)
    {
      EXPECT_GE(raised[i].lift, given[i]);
      EXPECT_LE(raised[i].lift, most);
      if (raised[i].lift > given[i] + 1e-4)
      {
        // A little lower it would be in another one.
        std::vector<Rock> lower = rocks;
        lower[i].position.z() -= 1e-4;
        EXPECT_FALSE(findOverlaps(lower).empty()) << seed << " " << i;
        ++carried;
      }
    }
  }
  EXPECT_GT(carried, 50);
}

TEST(Raising, OnlyWhatIsInTheWay)
{
  const std::vector<Rock> rocks = { brick(Vec3(1, 1, 1), Vec3(0.0, 0.0, 0.0), 0),
    brick(Vec3(4, 4, 1), Vec3(1.0, 0.0, 8.0), 1),   // far over it, on its way
    brick(Vec3(1, 1, 1), Vec3(1.001, 0.0, 0.0), 2), // beside it, 1 mm off
    brick(Vec3(1, 1, 1), Vec3(0.0, -1.0, 0.0), 3),  // beside it, touching
    brick(Vec3(1, 1, 1), Vec3(0.0, 0.0, -1.2), 4),  // under it
    brick(Vec3(1, 1, 1), Vec3(2.5, 0.0, 9.5), 5) }; // over the second one
  const std::vector<Block> blocks = blocksOf(rocks);
  std::vector<RaisedRock> raised = raisedOf(rocks, blocks, { 10.0, 0.0, 0.0, 0.0, 0.5, 0.0 });
  raiseOthers(raised);
  EXPECT_EQ(raised[0].lift, 10.0);
  EXPECT_NEAR(raised[1].lift, 3.0, 1e-6);
  EXPECT_EQ(raised[2].lift, 0.0);
  EXPECT_EQ(raised[3].lift, 10.0); // joined
  EXPECT_EQ(raised[4].lift, 0.5);
  EXPECT_NEAR(raised[5].lift, 2.5, 2e-6);
}
