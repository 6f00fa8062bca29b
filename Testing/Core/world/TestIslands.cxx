// Many rocks at once: what must not be lost, not overlap, come to rest and be the same again.

#include "angularMomentum.h"
#include "form.h"
#include "piles.h"
#include "solve/island/SoftSolver.h"

#include <tbb/global_control.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// Fifty cubes and icosahedra over a small place, turned at random.
std::vector<Rock> handful(int count, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  std::vector<Rock> rocks;
  for (int k = 0; k < count; ++k)
  {
    Rock rock;
    rock.blockId = k;
    rock.shape = makeShape(k % 2 ? Shape::Icosahedron : Shape::Cube, 0.3);
    const int level = k / 9, place = k % 9;
    rock.position = Vec3(20.0 + 1.2 * (place % 3 - 1) + 0.1 * u(random),
      20.0 + 1.2 * (place / 3 - 1), 1.0 + 1.2 * level);
    rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
    rocks.push_back(rock);
  }
  return rocks;
}

} // namespace

TEST(Islands, ManyRocksKeepMomentumAndGainNothing)
{
  Pile pile;
  pile.ground = abyss();
  pile.parameters.gravity = 0.0;
  pile.parameters.rockRestitution = 0.3;
  pile.rocks = handful(108, 5);
  for (Rock& rock : pile.rocks)
  {
    rock.velocity = 2.0 * (Vec3(20.0, 20.0, 4.5) - rock.position); // all to one place
    rock.angularVelocity = Vec3(1.0, -2.0, 0.5);
  }
  pile.start();
  const auto totals = [&](Vec3& momentum, Vec3& angular)
  {
    double energy = 0.0;
    momentum.setZero();
    angular.setZero();
    for (int i = 0; i < pile.fall->rocks(); ++i)
    {
      const BlockState& s = pile.fall->state(i);
      const double mass = pile.blocks[i].mass();
      momentum += mass * s.velocity;
      angular += mass * (s.position - Vec3(20, 20, 4.5)).cross(s.velocity) +
        angularMomentum(pile.blocks[i], s);
      energy += rigidKineticEnergy(pile.blocks[i], s);
    }
    return energy;
  };
  Vec3 p0, l0, p1, l1;
  const double before = totals(p0, l0);
  double size = 0.0;
  for (int i = 0; i < pile.fall->rocks(); ++i)
  {
    size += pile.blocks[i].mass() * pile.fall->state(i).velocity.norm();
  }
  pile.run(1.0);
  const double after = totals(p1, l1);
  EXPECT_LT((p1 - p0).norm(), 1e-10 * size);
  EXPECT_LT((l1 - l0).norm(), 1e-10 * size * 5.0);
  EXPECT_LT(after, before);
  EXPECT_GT(pile.fall->rock(31).trajectory().impacts.size(), 0u);
}

TEST(Islands, ImpactsLoseWhatTheCoefficientOfRestitutionSays)
{
  // Two cubes face to face.
  for (const double e : { 0.0, 0.5, 0.9 })
  {
    Pile pile;
    pile.ground = abyss();
    pile.parameters.gravity = 0.0;
    pile.parameters.endTime = 0.3;
    pile.parameters.rockRestitution = e;
    pile.rocks = { brick(Vec3(1, 1, 1), Vec3(20.0, 20.0, 0.0), 0),
      brick(Vec3(1, 1, 1), Vec3(21.3, 20.0, 0.0), 1) };
    pile.rocks[0].velocity = Vec3(6.0, 0.0, 0.0);
    pile.make();
    const std::vector<Trajectory> runs = pile.fall->run();
    const double brought = 0.5 * pile.blocks[0].mass() * 36.0;
    const double lost = 0.5 * (1.0 - e * e) * brought; // ½ μ (1 − e²) v²
    for (const Trajectory& t : runs)
    {
      ASSERT_EQ(t.impacts.size(), 1u);
      EXPECT_NEAR(t.impacts[0].energyLoss, lost, 0.01 * brought) << e;
    }
    const EnergyAudit &a = runs[0].summary.energy, &b = runs[1].summary.energy;
    EXPECT_NEAR(a.exchanged + b.exchanged, lost, 0.01 * brought) << e;
    EXPECT_NEAR(a.damping, 0.0, 1e-6 * brought);
    EXPECT_NEAR(b.damping, 0.0, 1e-6 * brought);
  }
}

TEST(Islands, EveryJouleIsBooked)
{
  Pile pile;
  pile.ground = floorSlope();
  pile.awake = false;
  pile.parameters.endTime = 8.0;
  pile.parameters.rockRestitution = 0.8;
  pile.rocks = handful(someOf(108, 54), 8);
  pile.make();
  EnergyAudit sum;
  for (const Trajectory& t : pile.fall->run())
  {
    add(sum, t.summary.energy);
  }
  // What meets is neither damped nor given by others, which would add up as well.
  EXPECT_GT(sum.damping, -1e-3 * sum.released);
  EXPECT_LT(sum.damping, 0.05 * sum.released);
  EXPECT_LT(std::abs(sum.numerical), 1e-3 * sum.released);
  EXPECT_GT(sum.exchanged, 0.05 * sum.released);
  EXPECT_GT(sum.restitution, 0.05 * sum.released);
}

// What is left of a run for its last step may be no more than rounding of time: a step of one
// substep, not of none, whose books would be no numbers.
TEST(Islands, LastStepMayBeOfNanoseconds)
{
  for (const double rest : { 1.1e-9, 1.5e-9, 2e-9 })
  {
    Pile pile;
    pile.ground = floorSlope();
    pile.parameters.timeStep = 0.02;
    pile.parameters.endTime = 0.1 + rest;
    pile.rocks = { brick(Vec3(1, 1, 1), Vec3(20.0, 20.0, 0.5), 0),
      brick(Vec3(1, 1, 1), Vec3(20.1, 20.0, 1.5), 1) };
    pile.make();
    for (const Trajectory& t : pile.fall->run())
    {
      EXPECT_TRUE(std::isfinite(t.summary.energy.strain)) << rest;
      EXPECT_TRUE(std::isfinite(t.summary.energy.damping)) << rest;
    }
  }
}

TEST(Islands, SameBitsForAnyNumberOfThreads)
{
  // All to one place, until they are one group of which several threads have parts.
  std::vector<std::vector<Vec3>> ends;
  int largest = 0;
  for (int threads : isSmallForm() ? std::vector{ 1, 4 } : std::vector{ 1, 2, 4 })
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Pile pile;
    pile.ground = floorSlope();
    pile.awake = false;
    pile.rocks = handful(207, 3);
    for (Rock& rock : pile.rocks)
    {
      rock.velocity = 2.0 * (Vec3(20.0, 20.0, 14.0) - rock.position);
    }
    pile.start();
    for (int step = 0; step < someOf(80, 50); ++step)
    {
      pile.fall->advance();
      largest = std::max(largest, pile.largestIsland());
    }
    ends.push_back(pile.places());
  }
  EXPECT_GT(largest, 128);
  for (const std::vector<Vec3>& end : ends)
  {
    for (std::size_t i = 0; i < end.size(); ++i)
    {
      ASSERT_EQ(end[i], ends[0][i]) << i;
    }
  }
}

TEST(Islands, HandfulComesToRestWithoutOverlap)
{
  for (const std::uint64_t seed : { 2, 3 })
  {
    Pile pile;
    pile.ground = floorSlope();
    pile.awake = false;
    pile.parameters.endTime = 20.0;
    pile.rocks = handful(isSmallForm() ? 18 : 54, seed);
    pile.start();
    double deepest = 0.0;
    bool moves = true;
    for (int step = 0; moves; ++step)
    {
      moves = pile.fall->advance();
      deepest = std::max(deepest, step % 20 == 0 ? pile.overlap() : 0.0);
    }
    EXPECT_LT(pile.fall->time(), 15.0) << seed;
    EXPECT_LT(pile.fastest(), 1e-6) << seed;
    EXPECT_LT(deepest, 0.01 * std::cbrt(0.3)) << seed; // 1 % of the size
  }
}

TEST(Islands, RocksThatMeetFastDoNotOverlap)
{
  // Cubes that fall onto each other at 9 m/s go 5 % of their edge in a step. How deep the deepest
  // overlap ever is hangs on chance.
  const std::uint64_t seeds = isSmallForm() ? 1 : 6;
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed)
  {
    Pile pile;
    pile.ground = floorSlope();
    pile.awake = false;
    pile.rocks = handful(108, seed);
    for (Rock& rock : pile.rocks)
    {
      rock.shape = makeShape(Shape::Cube, 0.6);
      rock.position = Vec3(20, 20, 0) + 1.5 * (rock.position - Vec3(20, 20, 0));
      rock.velocity = Vec3(0, 0, -9.0);
    }
    pile.start();
    double deepest = 0.0;
    int largest = 0;
    for (int step = 0; step < 300; ++step)
    {
      pile.fall->advance();
      deepest = std::max(deepest, step % 4 == 0 ? pile.overlap() : 0.0);
      largest = std::max(largest, step % 4 == 0 ? pile.largestIsland() : 0);
    }
    EXPECT_GT(largest, 64); // in one step
    EXPECT_LT(deepest, 0.03 * std::cbrt(0.6)) << seed;
    sum += deepest;
  }
  if (seeds > 1) // of one it may be any
  {
    EXPECT_LT(sum / double(seeds), 0.012 * std::cbrt(0.6));
  }
}

TEST(Islands, SleepersAreNotPushedIntoEachOther)
{
  // A column sleeps until a rock falls on it at 11 m/s: all of it wakes at once.
  Pile pile;
  pile.ground = floorSlope();
  pile.awake = false;
  pile.parameters.normalPenalty = 1e10;
  pile.rocks = column(5);
  Rock last = pile.rocks.back();
  last.blockId = 5;
  last.position.z() += 2.0;
  last.velocity = Vec3(0, 0, 10.0); // gone for two seconds
  pile.rocks.push_back(last);
  pile.start();
  double deepest = 0.0;
  bool slept = false;
  for (int step = 0; step < 1000; ++step)
  {
    pile.fall->advance();
    const bool still = pile.fall->state(4).velocity.isZero(0.0);
    slept = slept || (still && pile.fall->time() > 1.0);
    deepest = std::max(deepest, pile.overlap());
  }
  EXPECT_TRUE(slept);
  EXPECT_GT(pile.fall->rock(5).trajectory().impacts.size(), 0u);
  // Cubes of 1 m whose springs give way by 11 m/s √(m/p) = 4 mm, the lowest ones by twice as much;
  // in a step the rock goes 55 mm.
  EXPECT_LT(deepest, 0.015);
}

TEST(Islands, SlabThatSpinsKeepsEnergyAndMomentum)
{
  // 200 steps of 0.1 rad about no principal axis, without any contact.
  const Rock slab = brick(Vec3(1.0, 2.0, 3.0), Vec3::Zero(), 0);
  const Block block(slab.shape, slab.density, slab.youngModulus, slab.poissonRatio);
  BlockState state;
  state.spin = 20.0 * Vec3(1, 1, 1).normalized();
  const double energy = rigidKineticEnergy(block, state);
  const Vec3 momentum = angularMomentum(block, state);
  SoftSolver solver;
  const StepRequest request = lastingStep(0.005, 0.0);
  std::vector<IslandContact> contacts;
  for (int step = 0; step < 200; ++step)
  {
    std::vector<IslandBody> bodies(1);
    bodies[0].block = &block;
    bodies[0].state = &state;
    EXPECT_TRUE(solver.step(request, bodies, contacts, Accept::Any).settled);
  }
  EXPECT_NEAR(rigidKineticEnergy(block, state), energy, 1e-10 * energy);
  EXPECT_LT((angularMomentum(block, state) - momentum).norm(), 1e-10 * momentum.norm());
}

TEST(Islands, HighFrictionMakesNoEnergy)
{
  // Friction of 85 degrees under long levers: along the normal and across, each may drive the other
  // up.
  constexpr std::array shapes = { Shape::Cube, Shape::Dodecahedron, Shape::Icosahedron,
    Shape::Octahedron, Shape::Tetrahedron };
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const Vec3 middle(20.0, 20.0, 0.0);
  Pile pile;
  pile.ground = abyss();
  pile.parameters.gravity = 0.0;
  pile.parameters.rockRestitution = 0.0;
  pile.parameters.rockFrictionAngle = radians(85.0);
  pile.parameters.timeStep = 0.005;
  const int count = isSmallForm() ? 50 : 100; // two layers, or four
  for (int k = 0; k < count; ++k)
  {
    Rock rock;
    rock.blockId = k;
    const double size = 0.8 + 0.4 * u(random);
    rock.shape = makeShape(shapes[std::size_t(k) % shapes.size()], size * size * size);
    rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
    rock.position = middle + 2.2 * Vec3(k % 5 - 2.0, k / 5 % 5 - 2.0, k / 25 - 1.5) +
      0.05 * Vec3(u(random), u(random), u(random));
    rock.velocity = (5.0 + 3.0 * u(random)) * (middle - rock.position).normalized();
    rock.angularVelocity = 2.0 * Vec3(u(random), u(random), u(random));
    pile.rocks.push_back(rock);
  }
  pile.start();
  const auto energy = [&]
  {
    double sum = 0.0;
    for (int i = 0; i < pile.fall->rocks(); ++i)
    {
      sum += rigidKineticEnergy(pile.blocks[std::size_t(i)], pile.fall->state(i));
    }
    return sum;
  };
  const double start = energy();
  double least = start, most = 0.0;
  while (pile.fall->time() < 1.5)
  {
    pile.fall->advance();
    most = std::max(most, energy() - least);
    least = std::min(least, energy());
  }
  EXPECT_LT(most, 0.02 * start); // what springs held may come back
}

TEST(Islands, CohesionTakesNoMoreStepsThanNone)
{
  double steps[2];
  for (const bool coheres : { false, true })
  {
    Pile pile;
    pile.ground = floorSlope();
    pile.awake = false;
    pile.parameters.endTime = 1.6;
    pile.parameters.rockRestitution = 0.2;
    pile.parameters.rockCohesion = coheres ? 3000.0 : 0.0;
    pile.rocks = handful(27, 4);
    pile.make();
    double cut = 0.0;
    steps[coheres] = 0.0;
    for (const Trajectory& t : pile.fall->run())
    {
      steps[coheres] += double(t.summary.contactSteps);
      cut += double(t.summary.unsettledSteps);
    }
    EXPECT_LT(cut, 0.001 * steps[coheres]);
  }
  EXPECT_LT(steps[1], 3.0 * steps[0]);
}

// Where edges slide over each other their normal turns within the step, and the gap that a row
// reckons with is too wide. Of a thousand pairs of cubes that are thrown at each other these three
// would overlap by 1.2 % of an edge if a contact that overlaps already were not asked for more.
TEST(Islands, EdgesThatTurnOverEachOtherStayOutOfEachOther)
{
  double deepest = 0.0;
  for (const std::uint64_t seed : { 149, 465, 924 })
  {
    std::mt19937_64 random(seed);
    const auto draw = [&](double low, double high)
    { return low + (high - low) * double(random() >> 11) * 0x1p-53; };
    Pile pile;
    pile.ground = floorSlope();
    pile.parameters.rockFrictionAngle = radians(10.0);
    pile.parameters.rockRestitution = 0.2;
    pile.parameters.timeStep = 0.005;
    pile.parameters.endTime = 0.4;
    for (int k = 0; k < 2; ++k)
    {
      Rock rock;
      rock.blockId = k;
      rock.shape = makeShape(Shape::Cube, 0.6);
      const double x = k == 0 ? draw(-0.4, 0.4) : 0.0, y = draw(-0.4, 0.4);
      rock.position = Vec3(20.0 + x, 20.0 + y, 5.0 + 1.5 * k);
      const double q[] = { draw(-1.0, 1.0), draw(-1.0, 1.0), draw(-1.0, 1.0), draw(-1.0, 1.0) };
      rock.orientation = Quat(q[0], q[1], q[2], q[3]).normalized();
      const double u = draw(-3.0, 3.0), v = draw(-3.0, 3.0);
      rock.velocity = Vec3(u, v, k == 0 ? 6.0 : -6.0);
      const double spin[] = { draw(-15.0, 15.0), draw(-15.0, 15.0), draw(-15.0, 15.0) };
      rock.angularVelocity = Vec3(spin[0], spin[1], spin[2]);
      pile.rocks.push_back(rock);
    }
    pile.start();
    while (pile.fall->advance())
    {
      deepest = std::max(deepest, pile.overlap());
    }
  }
  EXPECT_LE(deepest, 0.01 * std::cbrt(0.6));
}

TEST(Islands, OneSmallRockDoesNotSetTheStepsOfAll)
{
  // Springs that stop a stone of 1.5 l would ask for 400 steps in one of Δt.
  const auto steps = [](int cubes)
  {
    Pile pile;
    pile.ground = floorSlope();
    Rock rock;
    rock.shape = makeShape(Shape::Cube, 1.0);
    for (rock.blockId = 0; rock.blockId < cubes; ++rock.blockId)
    {
      rock.position = Vec3(20.0, 20.0, 0.5 + double(rock.blockId));
      pile.rocks.push_back(rock);
    }
    rock.shape = makeShape(Shape::Cube, 0.0015);
    rock.position = Vec3(20.2, 20.1, cubes + 0.06);
    rock.velocity = Vec3(0.0, 0.0, -0.2);
    pile.rocks.push_back(rock);
    pile.parameters.rockRestitution = 0.0;
    pile.start();
    // In those of Δt in which all are one group.
    std::vector<int> taken;
    while (pile.fall->time() < 0.05)
    {
      const int before = int(pile.fall->rock(0).trajectory().summary.contactSteps);
      pile.fall->advance();
      if (pile.largestIsland() == cubes + 1)
      {
        taken.push_back(int(pile.fall->rock(0).trajectory().summary.contactSteps) - before);
      }
    }
    EXPECT_FALSE(taken.empty());
    return *std::max_element(taken.begin(), taken.end());
  };
  EXPECT_LE(steps(1), 2);
  EXPECT_LE(steps(20), 2);
}
