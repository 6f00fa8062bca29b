// Rocks that lie on each other: they stand, slide and fall as they must.

#include "form.h"
#include "piles.h"

#include <gtest/gtest.h>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// What settles is the springs; from then on nothing moves, and the floor carries everything. The
/// forces of piles balance within some seconds of sweeps; bars are a tenth of those of a standing
/// pile: a drift of 1e-4 m, 1e-3 of what is carried.
void expectToStand(Pile& pile, double settling, double duration)
{
  pile.start();
  pile.run(settling);
  const std::vector<Vec3> settled = pile.places();
  // Over a time the floor gives back what weight gives, but for the motion that is left.
  const double end = pile.fall->time() + duration;
  double carried = 0.0, time = 0.0;
  while (pile.fall->time() < end - 1e-9)
  {
    const double before = pile.fall->time(), step = pile.run(1e-6) - before;
    carried += step * pile.carried();
    time += step;
  }
  EXPECT_LT(pile.drift(settled), 1e-5);
  EXPECT_NEAR(carried / time, 1.0, 1e-4);
  EXPECT_LT(pile.fastest(), 5e-4); // m/s, √(g r) is 3
}

} // namespace

TEST(Piles, ColumnOfTenStands)
{
  Pile pile;
  pile.ground = floorSlope();
  pile.rocks = column(10);
  expectToStand(pile, 2.0, 5.0);
  // Block i presses the joint under it with what lies above: the top sinks by all joints together,
  // each of four springs in parallel.
  double sunk = 0.0;
  for (int i = 0; i < 10; ++i)
  {
    double stiffness = 0.0;
    if (i == 0)
    {
      for (const Contact& c : pile.fall->rock(0).body().contacts)
      {
        stiffness += c.stiffness;
      }
    }
    for (const RockPair* pair : pile.fall->pairs())
    {
      for (const Contact& c : pair->contacts)
      {
        stiffness += pair->first == i - 1 && pair->second == i ? c.stiffness : 0.0;
      }
    }
    sunk += (10 - i) * pile.blocks[i].mass() * pile.parameters.gravity / stiffness;
  }
  // The cubes fall on springs without weight on them and damp out: 1 % is left of it by locking.
  EXPECT_NEAR(9.5 - pile.fall->state(9).position.z(), sunk, 0.01 * sunk);
}

TEST(Piles, WallStands)
{
  Pile pile;
  pile.ground = floorSlope();
  pile.rocks = wall(10, 5);
  expectToStand(pile, 3.0, 2.0);
}

TEST(Piles, ArchStands)
{
  Pile pile;
  pile.ground = floorSlope(45.0);
  pile.parameters.rockFrictionAngle = radians(40.0);
  pile.rocks = arch();
  expectToStand(pile, 2.0, 5.0);
}

TEST(Piles, ArchFallsWithoutFriction)
{
  Pile pile;
  pile.ground = floorSlope(45.0);
  pile.parameters.rockFrictionAngle = radians(5.0);
  pile.rocks = arch();
  pile.start();
  pile.run(1.5);
  EXPECT_LT(pile.fall->state(5).position.z(), 2.0); // the keystone, from 2.5 m
}

TEST(Piles, WhatTurnsSlowlyOnTwoPointsComesToRest)
{
  // An octahedron stands on one corner and holds a slab with the other one, which is crushed to a
  // patch: its friction holds a moment, 2/3 μ a N.
  for (const double spin : { 0.1, 2.0 }) // rad/s
  {
    Pile pile;
    pile.ground = floorSlope();
    pile.awake = false;
    pile.parameters.rockFrictionAngle = radians(35.0);
    pile.parameters.endTime = 12.0;
    const double half = 0.6, wide = 0.4; // m
    Rock top;
    top.blockId = 0;
    top.shape = Polyhedron::convexHull(std::vector<Vec3>{ { 0, 0, half }, { 0, 0, -half },
      { wide, 0, 0 }, { -wide, 0, 0 }, { 0, wide, 0 }, { 0, -wide, 0 } });
    top.position = Vec3(0, 0, half);
    top.angularVelocity = Vec3(0, 0, spin);
    pile.rocks.push_back(top);
    // Both sides rest on pillars a tenth of a millimetre lower than it.
    const double height = 2.0 * half - 1e-4;
    pile.rocks.push_back(brick(Vec3(3.0, 1.0, 0.4), Vec3(0, 0, 2.0 * half + 0.2), 1));
    pile.rocks.push_back(brick(Vec3(0.4, 0.8, height), Vec3(-1.3, 0, 0.5 * height), 2));
    pile.rocks.push_back(brick(Vec3(0.4, 0.8, height), Vec3(1.3, 0, 0.5 * height), 3));
    for (Rock& rock : pile.rocks)
    {
      rock.position += Vec3(20, 20, 0);
    }
    pile.start();
    double expected = spin, worst = 0.0;
    while (pile.fall->advance())
    {
      double load = 0.0;
      for (const RockPair* pair : pile.fall->pairs())
      {
        for (const Contact& c : pair->contacts)
        {
          load += pair->first == 0 || pair->second == 0 ? c.normalForce : 0.0;
        }
      }
      const double patch = std::sqrt(load / (M_PI * kCrushingStress));
      expected -= pile.parameters.timeStep * 2.0 / 3.0 * std::tan(radians(35.0)) * patch * load /
        pile.blocks[0].inertia()(2, 2);
      worst = std::max(
        worst, std::abs(pile.fall->state(0).angularVelocity().z() - std::max(0.0, expected)));
    }
    EXPECT_LT(worst, 0.02 * spin);
    EXPECT_LT(pile.fall->time(), 6.0);
    EXPECT_EQ(pile.fall->state(0).spin.norm(), 0.0);
    EXPECT_LT((pile.fall->state(0).position - Vec3(20, 20, half)).norm(), 2e-3); // as springs give
  }
}

// A slab on the tip of a stone stays while its weight is within the arm of the corner's moment,
// 2/3 μ a, of it, and falls beyond.
// Slabs of 1000 m³ beside each other on 30°, φ 29.8°: ½ a t² with a = g (sin β − cos β tan φ), 7.9 m
// in 20 s, of which 0.18 m in the first three.
TEST(Piles, WhatBeginsToSlideIsNotPutToSleep)
{
  const double beta = radians(30.0), phi = radians(29.8);
  Pile pile;
  pile.awake = false;
  pile.ground = makeSlope(
    61, 5.0, [&](double x, double) { return -x * std::tan(beta); }, material(0.0, 29.8));
  const Quat tilt(Eigen::AngleAxisd(beta, Vec3::UnitY()));
  for (int k = 0; k < 2; ++k)
  {
    Rock slab = brick(Vec3(20.0, 10.0, 5.0), Vec3::Zero(), k);
    slab.orientation = tilt;
    slab.position = Vec3(100.0, 100.0 + 10.0 * k, -100.0 * std::tan(beta)) +
      (2.5 + 1e-6) * (tilt * Vec3::UnitZ());
    pile.rocks.push_back(slab);
  }
  pile.parameters.rockFrictionAngle = 30.0;
  pile.parameters.endTime = 20.0;
  pile.make();
  const double a = kGravity * (std::sin(beta) - std::cos(beta) * std::tan(phi));
  for (const Trajectory& t : pile.fall->run())
  {
    EXPECT_EQ(t.summary.fate, Fate::Moving);
    const double way = (t.summary.stop - t.summary.start).norm();
    EXPECT_NEAR(way, 0.5 * a * 400.0, 0.05 * 0.5 * a * 400.0);
  }
}

TEST(Piles, ACornerBalancesWhatItsMomentHolds)
{
  for (const double share : { 0.5, 0.9, 1.2 })
  {
    Pile pile;
    pile.ground = floorSlope(40.0);
    pile.parameters.rockFrictionAngle = radians(40.0);
    const Polyhedron stone = Polyhedron::convexHull(
      std::vector<Vec3>{ { 0, 0, 0.9 }, { 0.8, 0, 0 }, { -0.4, 0.7, 0 }, { -0.4, -0.7, 0 } });
    Rock foot;
    foot.blockId = 0;
    foot.shape = stone.centred();
    foot.position = Vec3(20.0, 20.0, 0.0) + stone.integrals().centroid;
    Rock slab = brick(Vec3(1.0, 1.0, 0.2), Vec3(20.0, 20.0, 1.0), 1);
    const double load = slab.density * 0.2 * pile.parameters.gravity;
    const double patch = std::sqrt(load / (M_PI * kCrushingStress));
    slab.position.x() += share * 2.0 / 3.0 * std::tan(radians(40.0)) * patch;
    pile.rocks = { foot, slab };
    pile.start();
    pile.run(0.5);
    const Quat from = pile.fall->state(1).orientation;
    pile.run(1.5);
    const double turned = from.angularDistance(pile.fall->state(1).orientation);
    if (share < 1.0)
    {
      EXPECT_LT(turned, 2e-4) << share; // 7e-5 rad/s: moments begin anew in each step
    }
    else
    {
      EXPECT_GT(turned, 0.5) << share;
    }
  }
}

// A block that rocks on a slab from edge to edge keeps (1 − 3/2 sin² α)² of its energy at each
// impact, α the angle of its diagonal (Housner 1963), above and below the speed at which a touch
// is no impact.
TEST(Piles, ARockingBlockLosesWhatHousnerSays)
{
  const double wide = 0.2, high = 0.8, alpha = std::atan(wide / high), tilt = 0.2 * alpha;
  Pile pile;
  pile.ground = floorSlope();
  pile.parameters.rockFrictionAngle = radians(40.0);
  pile.parameters.rockRestitution = 0.0;
  pile.parameters.timeStep = 0.001;
  pile.rocks.push_back(brick(Vec3(2.0, 2.0, 0.5), Vec3(20.0, 20.0, 0.25), 0));
  Rock block = brick(Vec3(wide, 0.5, high), Vec3::Zero(), 1);
  block.orientation = Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY()));
  block.position = Vec3(20.0, 20.0, 0.5) - block.orientation * Vec3(0.5 * wide, 0.0, -0.5 * high);
  pile.rocks.push_back(block);
  pile.start();
  const double R = 0.5 * std::hypot(wide, high), g = pile.parameters.gravity;
  // Energy over that of rest, per mass and g.
  const auto energy = [&]
  {
    const BlockState& s = pile.fall->state(1);
    return s.position.z() +
      (0.5 * s.velocity.squaredNorm() +
        0.5 * s.spin.dot(pile.blocks[1].inertia() * s.spin) / pile.blocks[1].mass()) /
      g;
  };
  const double rest = 0.5 + 0.5 * high;
  double spin = 0.0, before = R * std::cos(alpha - tilt) - R * std::cos(alpha);
  EXPECT_NEAR(energy() - rest, before, 1e-9);
  const double kept = std::pow(1.0 - 1.5 * std::pow(std::sin(alpha), 2), 2);
  for (int impacts = 0; impacts < 10; ++impacts)
  {
    double last = 0.0;
    do // until it turns back at its highest place
    {
      last = spin;
      pile.fall->advance();
      spin = pile.fall->state(1).angularVelocity().y();
    } while (spin * last >= 0.0);
    const double left = energy() - rest;
    EXPECT_NEAR(left / before, kept, 0.0125 * kept) << impacts;
    before = left;
  }
}

// The upper cube on a slope of angle α begins to slide where Coulomb says of the pair that it is
// in, and speeds up as the closed form has it; the lower one carries its friction.
TEST(Piles, CubeOnCubeSlidesPairByPair)
{
  const double angle = radians(24.0);
  const struct
  {
    double below, between; // φ, degrees
  } cases[] = { { 35.0, 30.0 }, { 35.0, 15.0 }, { 15.0, 35.0 }, { 18.0, 12.0 } };
  for (const auto& c : cases)
  {
    Pile pile;
    pile.ground = makePlane(2, 120.0, angle, 0.0, material(0.3, c.below));
    pile.parameters.rockFrictionAngle = radians(c.between);
    pile.parameters.timeStep = 0.001;
    const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
    const Vec3 downhill(std::cos(angle), 0.0, -std::sin(angle));
    for (int k = 0; k < 2; ++k)
    {
      Rock rock = brick(Vec3(1, 1, 1), Vec3::Zero(), k);
      rock.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
      rock.position = Vec3(60.0, 60.0, 100.0) + (0.5 + k) * normal - 20.0 * downhill;
      pile.rocks.push_back(rock);
    }
    pile.start();
    pile.run(0.2);
    const double speed[2] = { downhill.dot(pile.fall->state(0).velocity),
      downhill.dot(pile.fall->state(1).velocity) };
    constexpr double duration = 0.2;
    pile.run(duration);
    const double g = pile.parameters.gravity;
    const double pull = g * std::sin(angle), press = g * std::cos(angle);
    const double held = std::tan(radians(c.below)), rubbed = std::tan(radians(c.between));
    // m a₁ = m g sin α − 2 μ m g cos α ± R, m a₂ = m g sin α ∓ R, R ≤ μ' m g cos α between them.
    double upper = 0.0, lower = 0.0;
    const bool together = std::tan(angle) <= rubbed || held <= rubbed;
    if (together)
    {
      upper = lower = std::max(0.0, pull - held * press);
    }
    else
    {
      upper = pull - rubbed * press;
      lower = std::max(0.0, pull - 2.0 * held * press + rubbed * press);
    }
    const double found[2] = { (downhill.dot(pile.fall->state(0).velocity) - speed[0]) / duration,
      (downhill.dot(pile.fall->state(1).velocity) - speed[1]) / duration };
    // 0.1 % of gravity: the springs still swing a little after 0.2 s.
    EXPECT_NEAR(found[0], lower, 1e-3 * g) << c.below << "° and " << c.between << "°";
    EXPECT_NEAR(found[1], upper, 1e-3 * g) << c.below << "° and " << c.between << "°";
    if (together)
    {
      const Vec3 apart = pile.fall->state(1).position - pile.fall->state(0).position;
      EXPECT_NEAR(apart.dot(downhill), 0.0, 1e-3); // the springs' shear
    }
  }
}

// Stacks of two cubes beside each other on a slope of 24°, in one run. The lower cubes stand; the
// upper ones slide or not by what the two materials say, in whatever order the row has them.
TEST(Piles, CubeOnCubeSlidesByItsMaterials)
{
  const double angle = radians(24.0);
  const struct
  {
    const char *below, *above;
    double friction, cohesion; // φ, degrees; c, N per contact point
  } stacks[] = {
    { "granite", "slate", 15.0, 0.0 }, { "granite", "granite", 30.0, 0.0 },
    { "slate", "granite", 15.0, 0.0 },
    { "slate", "slate", 10.0, 3000.0 }, // four points of 3 kN hold what 10° do not: 5.6 kN
    { "slate", "gabbro", 20.0, 0.0 },   // no row
  };
  Pile pile;
  pile.ground = makePlane(2, 120.0, angle, 0.0, material(0.3, 45.0));
  pile.parameters.timeStep = 0.001;
  pile.parameters.rockFrictionAngle = radians(20.0);
  pile.parameters.rockContactPairs = { { "slate", "granite", { 0.5, radians(15.0), 0.0 } },
    { "granite", "granite", { 0.5, radians(30.0), 0.0 } },
    { "slate", "slate", { 0.5, radians(10.0), 3000.0 } } };
  const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
  const Vec3 downhill(std::cos(angle), 0.0, -std::sin(angle));
  for (const auto& stack : stacks)
  {
    const double y = 40.0 + 4.0 * double(pile.rocks.size());
    for (int k = 0; k < 2; ++k)
    {
      Rock rock = brick(Vec3(1, 1, 1), Vec3::Zero(), std::int64_t(pile.rocks.size()));
      rock.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
      rock.position = Vec3(60.0, y, 100.0) + (0.5 + k) * normal - 20.0 * downhill;
      rock.material = k == 0 ? stack.below : stack.above;
      pile.rocks.push_back(rock);
    }
  }
  pile.start();
  pile.run(0.2);
  std::vector<double> speed;
  for (int i = 0; i < pile.fall->rocks(); ++i)
  {
    speed.push_back(downhill.dot(pile.fall->state(i).velocity));
  }
  constexpr double duration = 0.2;
  pile.run(duration);
  const double g = pile.parameters.gravity;
  const double pull = g * std::sin(angle), press = g * std::cos(angle);
  for (int k = 0; k < int(std::size(stacks)); ++k)
  {
    const double hold = std::tan(radians(stacks[k].friction)) * press +
      4.0 * stacks[k].cohesion / pile.blocks[0].mass();
    const double expected[2] = { 0.0, std::max(0.0, pull - hold) };
    for (int i = 0; i < 2; ++i)
    {
      const int rock = 2 * k + i;
      const double found = (downhill.dot(pile.fall->state(rock).velocity) - speed[rock]) / duration;
      // 0.1 % of gravity: the springs still swing a little after 0.2 s.
      EXPECT_NEAR(found, expected[i], 1e-3 * g) << stacks[k].above << " on " << stacks[k].below;
    }
  }
}

TEST(Piles, DominoesFallAtTheSpeedOfSmallSteps)
{
  // The small form's row is too short for one speed all along it.
  const int count = isSmallForm() ? 10 : 20, begin = count / 4, end = count - 2;
  const auto speed = [&](double step)
  {
    Pile pile;
    pile.ground = floorSlope();
    pile.parameters.timeStep = step;
    pile.parameters.rockRestitution = 0.0;
    for (int k = 0; k < count; ++k)
    {
      pile.rocks.push_back(brick(Vec3(0.2, 0.5, 1.0), Vec3(15.0 + 0.5 * k, 20.0, 0.5), k));
    }
    const double lean = radians(14.0); // beyond its edge
    pile.rocks[0].orientation = Quat(Eigen::AngleAxisd(lean, Vec3::UnitY()));
    pile.rocks[0].position = Vec3(15.0, 20.0, 0.5 * std::cos(lean) + 0.1 * std::sin(lean));
    pile.start();
    double first = 0.0, last = 0.0;
    while (pile.fall->time() < 8.0 && last == 0.0)
    {
      pile.fall->advance();
      const auto leans = [&](int k) { return pile.fall->state(k).position.z() < 0.49; };
      first = first == 0.0 && leans(begin) ? pile.fall->time() : first;
      last = last == 0.0 && leans(end) ? pile.fall->time() : last;
    }
    return (end - begin) * 0.5 / (last - first);
  };
  const double converged = speed(0.0025); // that of 0.00125 s is within 0.1 % of it
  EXPECT_NEAR(speed(0.005), converged, (isSmallForm() ? 0.2 : 0.05) * converged);
}
