// What rocks lose to each other: every joule is in an impact or in what lasting contact took.

#include "law/settings.h"
#include "piles.h"

#include <gtest/gtest.h>

#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// Rocks of three shapes and sizes of 1:16 over a place on a slope, turned at random.
std::vector<Rock> cluster(int count, double height, std::uint64_t seed)
{
  constexpr std::array shapes = { Shape::Cube, Shape::Icosahedron, Shape::Octahedron };
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  std::vector<Rock> rocks;
  for (int k = 0; k < count; ++k)
  {
    Rock rock;
    rock.blockId = k;
    rock.shape = makeShape(shapes[std::size_t(k) % 3], 0.5 * std::pow(4.0, u(random)));
    // Drawn one by one: the order of a call's arguments is each compiler's own.
    const double y = u(random), x = u(random);
    rock.position = Vec3(20.0 + 2.3 * (k % 3) + 0.1 * x, 100.0 + 2.3 * (k / 3 % 3) + 0.1 * y,
      height + 2.0 + 2.3 * (k / 9));
    const double qz = u(random), qy = u(random), qx = u(random), qw = u(random);
    rock.orientation = Quat(qw, qx, qy, qz).normalized();
    rocks.push_back(rock);
  }
  return rocks;
}

struct Books
{
  double given = 0.0, impacts = 0.0, lasting = 0.0; ///< J
};

Books booksOf(const std::vector<Trajectory>& runs)
{
  Books books;
  for (const Trajectory& t : runs)
  {
    books.given += t.summary.energy.exchanged;
    books.lasting += t.summary.lastingLoss;
    for (const ImpactEvent& event : t.impacts)
    {
      books.impacts += event.otherRock >= 0 ? 0.5 * event.energyLoss : 0.0; // in the row of each
    }
  }
  return books;
}

/// Three cubes in a row without gravity, the last two `gap` (m) apart; the first comes at 5 m/s.
std::vector<Trajectory> strikeThrough(double gap, double restitution)
{
  Pile pile;
  pile.ground = abyss();
  pile.parameters.gravity = 0.0;
  pile.parameters.endTime = 0.2;
  pile.parameters.rockRestitution = restitution;
  for (int k = 0; k < 3; ++k)
  {
    pile.rocks.push_back(brick(Vec3(1, 1, 1),
      Vec3(20.0 + k +
          (k == 0      ? -0.2
              : k == 2 ? gap
                       : 0.0),
        20.0, 0.0),
      k));
  }
  pile.rocks[0].velocity.x() = 5.0;
  pile.make();
  return pile.fall->run();
}

} // namespace

TEST(PairBooks, EveryJouleIsOfAnImpactOrOfLastingContact)
{
  const double fall = std::tan(radians(30.0));
  // Falls 44 and 260 have a strike whose friction turns back and gives more than its normal takes.
  for (const auto& [e, seed] : { std::pair(0.0, 3), std::pair(0.3, 3), std::pair(0.8, 3),
         std::pair(0.8, 44), std::pair(0.8, 260) })
  {
    Pile pile;
    pile.awake = false;
    pile.ground = makeSlope(
      41, 5.0, [=](double x, double) { return 100.0 - fall * std::min(x, 100.0); },
      material(0.35, 28.0));
    pile.parameters.endTime = 6.0;
    pile.parameters.rockRestitution = e;
    pile.rocks = cluster(20, 100.0 - 20.0 * fall, std::uint64_t(seed));
    pile.make();
    const Books books = booksOf(pile.fall->run());
    ASSERT_GT(books.given, 1e5);
    EXPECT_NEAR(books.impacts + books.lasting, books.given, 1e-9 * books.given) << e;
    // Cascading rocks hit each other far more than they rub: 0.3 to 3 % here, and up to 12 % when
    // strikes that came through rocks in touch were no impacts. Without a rebound many are slower
    // than from a drop of r/20, which is no impact: up to 5.4 % of ten falls.
    EXPECT_LT(books.lasting, (e == 0.0 ? 0.06 : 0.03) * books.given) << e;
    EXPECT_GT(books.lasting, 0.0);
  }
}

TEST(PairBooks, WhatStrikesThroughATouchIsAnImpact)
{
  // Touching, or so near that the second meets the third within the step in which it is struck.
  for (const double gap : { 0.0, 1e-3 })
  {
    {
      const std::vector<Trajectory> runs = strikeThrough(gap, 0.0);
      // All three go on as one, at a third of the speed.
      const double mass = runs[2].summary.mass;
      double impulse = 0.0;
      for (const ImpactEvent& event : runs[2].impacts)
      {
        EXPECT_EQ(event.otherRock, 1);
        EXPECT_GT(event.approachSpeed, 0.01 * std::sqrt(kLeastGravity * 0.866));
        impulse += event.impulse;
      }
      ASSERT_GE(runs[2].impacts.size(), 1u) << gap;
      EXPECT_LT(runs[2].impacts.front().velocityBefore.norm(), 1e-6);
      EXPECT_NEAR(runs[2].impacts.back().velocityAfter.x(), 5.0 / 3.0, 0.03 * 5.0 / 3.0);
      EXPECT_NEAR(impulse, mass * 5.0 / 3.0, 0.03 * mass * 5.0 / 3.0) << gap;
      const Books books = booksOf(runs);
      const double lost = 0.5 * mass * 25.0 * (1.0 - 1.0 / 3.0);
      EXPECT_NEAR(books.impacts, lost, 0.01 * lost);
    }
  }
}

TEST(PairBooks, RestMakesNoImpacts)
{
  Pile pile;
  pile.ground = floorSlope();
  pile.rocks = wall(4, 3);
  pile.start();
  pile.run(1.0);
  for (int i = 0; i < pile.fall->rocks(); ++i)
  {
    EXPECT_EQ(pile.fall->rock(i).trajectory().impacts.size(), 0u) << i;
  }
}

TEST(PairBooks, SlidingIsLastingContact)
{
  // A slab slides off a longer one that lies on the floor: friction, and no impact, takes all.
  Pile pile;
  pile.ground = floorSlope(60.0);
  pile.awake = false;
  pile.parameters.endTime = 2.0;
  pile.parameters.rockFrictionAngle = radians(20.0);
  pile.rocks = { brick(Vec3(6.0, 2.0, 1.0), Vec3(20.0, 20.0, 0.5), 0),
    brick(Vec3(1.0, 1.0, 0.3), Vec3(18.0, 20.0, 1.15), 1) };
  pile.rocks[1].velocity.x() = 2.0;
  pile.make();
  const std::vector<Trajectory> runs = pile.fall->run();
  const Books books = booksOf(runs);
  const double brought = 0.5 * runs[1].summary.mass * 4.0;
  EXPECT_EQ(runs[1].impacts.size(), 0u);
  EXPECT_NEAR(books.lasting, brought, 0.02 * brought);
  EXPECT_NEAR(runs[0].summary.lastingLoss, runs[1].summary.lastingLoss, 1e-9 * brought);
}

TEST(PairBooks, APinchedStoneGainsNothing)
{
  // A block of 40 t comes down on a stone of 270 kg that lies on a slope of e 1.
  const double fall = std::tan(radians(30.0));
  Pile pile;
  pile.awake = false;
  pile.ground = makeSlope(
    41, 5.0, [=](double x, double) { return 100.0 - fall * std::min(x, 100.0); },
    material(1.0, 45.0));
  pile.parameters.timeStep = 0.002;
  pile.parameters.endTime = 0.6;
  pile.parameters.rockRestitution = 0.1;
  pile.parameters.rockFrictionAngle = radians(45.0);
  std::mt19937_64 random(1);
  const auto even = [&] { return 2.0 * double(random() >> 11) * 0x1p-53 - 1.0; };
  for (int scene = 0; scene < 12; ++scene)
  {
    pile.rocks.assign(2, {});
    for (int k = 0; k < 2; ++k)
    {
      Rock& rock = pile.rocks[std::size_t(k)];
      rock.blockId = k;
      rock.shape = makeShape(Shape::Cube, k == 0 ? 15.0 : 0.1);
      const double w = even(), x = even(), y = even(), z = even();
      rock.orientation = Quat(w, x, y, z).normalized();
      rock.position = Vec3(30.0, 100.0, 100.0 - 30.0 * fall + (k == 0 ? 3.5 : 0.5));
    }
    pile.rocks[0].velocity = Vec3(3.0, 0.0, -8.0);
    pile.make();
    const std::vector<Trajectory> runs = pile.fall->run();
    const double brought = runs[0].summary.energy.released;
    double given = 0.0;
    for (const Trajectory& t : runs)
    {
      const EnergyAudit& e = t.summary.energy;
      EXPECT_LE(e.kinetic + e.strain + e.exchanged - e.released, 0.01 * brought) << scene;
      EXPECT_NEAR(e.numerical, 0.0, 1e-9 * brought) << scene;
      given += e.exchanged;
    }
    const Books books = booksOf(runs);
    EXPECT_NEAR(books.impacts + books.lasting, given, 1e-9 * brought) << scene;
  }
}
