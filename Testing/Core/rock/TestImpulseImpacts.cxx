// Impacts of lone rocks as events in impulse space, with springs and dashpots as the judge.

#include "form.h"
#include "slopes.h"

#include <gtest/gtest.h>

#include <random>
#include <span>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// Mean and its standard error.
struct Mean
{
  double sum = 0.0, squares = 0.0;
  int count = 0;

  void add(double x)
  {
    this->sum += x;
    this->squares += x * x;
    ++this->count;
  }
  double mean() const { return this->sum / this->count; }
  double error2() const
  {
    return (this->squares / this->count - this->mean() * this->mean()) / this->count;
  }
};

// Of 18 means one is off by 2.5 standard errors every fifth time, by 3.5 once in a hundred.
void expectSame(const Mean& a, const Mean& b, double share, const char* what, Shape shape, double e)
{
  EXPECT_NEAR(a.mean(), b.mean(),
    std::max(share * std::abs(b.mean()), 3.5 * std::sqrt(a.error2() + b.error2())))
    << what << ", " << shapeName(shape) << ", e " << e;
}

/// 30° down, then flat, with nodes that scatter by 0.1 m.
Terrain roughSlope(double restitution, double rollingResistance)
{
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 0.1);
  SurfaceMaterial m = material(restitution, 15.0);
  m.restitutionModel = RestitutionModel::NormalTangential;
  m.yielding.rollingResistance = rollingResistance;
  return makeSlope(
    161, 1.0,
    [&](double x, double)
    { return std::max(0.0, 80.0 - x) * std::tan(radians(30.0)) + normal(random); },
    m);
}

} // namespace

TEST(ImpulseImpacts, ACubeThatFallsFlatComesBackWhateverTheStep)
{
  const Terrain slope = makeSlope(
    5, 5.0, [](double, double) { return 100.0; }, material(1.0, 15.0));
  for (const double timeStep : { 0.01, 0.001 })
  {
    SimulationParameters p;
    p.timeStep = timeStep;
    p.endTime = 3.0;
    p.impactResolution = ImpactResolution::Impulse;
    Rock rock;
    rock.shape = makeShape(Shape::Cube, 1.0);
    rock.position = Vec3(10.0, 10.0, 102.0);
    const Trajectory t = simulate(slope, rock, p);
    ASSERT_GE(t.impacts.size(), 2u);
    for (const ImpactEvent& impact : t.impacts)
    {
      EXPECT_NEAR(-impact.velocityAfter.z() / impact.velocityBefore.z(), 1.0, 1e-6);
    }
    EXPECT_NEAR(t.summary.energy.numerical / t.summary.energy.released, 0.0, 1e-6);
    EXPECT_EQ(t.summary.contactSteps, 0);
  }
}

TEST(ImpulseImpacts, TouchesThatSpringsTakeForOneAreOne)
{
  // A cube tilted by 1°: its second edge comes down 2 ms after the first one. Rv scales once.
  SurfaceMaterial m = material(0.5, 15.0);
  m.restitutionModel = RestitutionModel::Velocity;
  const Terrain slope = makeSlope(
    5, 5.0, [](double, double) { return 100.0; }, m);
  for (const ImpactResolution by : { ImpactResolution::Impulse, ImpactResolution::Springs })
  {
    SimulationParameters p;
    p.endTime = 0.9;       // 0.7 s down, and up again
    p.normalPenalty = 1e9; // an impact of 5 ms
    p.impactResolution = by;
    Rock rock;
    rock.shape = makeShape(Shape::Cube, 1.0);
    rock.position = Vec3(10.0, 10.0, 102.9);
    rock.orientation = Quat(Eigen::AngleAxisd(radians(1.0), Vec3::UnitY()));
    const Trajectory t = simulate(slope, rock, p);
    EXPECT_EQ(t.summary.impacts, 1);
    ASSERT_EQ(t.impacts.size(), 1u);
    const ImpactEvent& impact = t.impacts[0];
    // Some of it goes into spin; scaled twice, it were less than 0.25.
    EXPECT_GT(-impact.velocityAfter.z() / impact.velocityBefore.z(), 0.35) << int(by);
    EXPECT_NEAR(t.summary.energy.numerical / t.summary.energy.released, 0.0, 1e-4);
  }
}

namespace
{

/// `penalty`: of the springs, N/m.
void expectThoseOfSprings(Shape shape, double e, double rollingResistance, double penalty)
{
  const Terrain slope = roughSlope(e, rollingResistance);
  std::vector<Rock> rocks(160);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (std::size_t k = 0; k < rocks.size(); ++k)
  {
    Rock& rock = rocks[k];
    rock.blockId = std::int64_t(k);
    rock.shape = makeShape(shape, 1.0);
    const double x = 5.0 + 2.0 * u(random), y = 40.0 + 80.0 * u(random);
    rock.position = Vec3(x, y, slope.elevation(x, y) + 2.87);
    rock.velocity = Vec3(1.0, u(random) - 0.5, 0.0);
    rock.orientation =
      Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
  }
  Mean x[2], impacts[2], speed[2], rolling[2];
  double steps[2] = { 0.0, 0.0 };
  for (const ImpactResolution by : { ImpactResolution::Impulse, ImpactResolution::Springs })
  {
    SimulationParameters p;
    p.endTime = 8.0;
    p.impactResolution = by;
    p.normalPenalty = penalty;
    TrajectoryStore store(rocks.size(), 1);
    runEnsemble(slope, rocks, p, store);
    for (const Trajectory& t : store.trajectories())
    {
      const auto k = std::size_t(by);
      x[k].add(t.summary.stop.x());
      impacts[k].add(t.summary.impacts);
      speed[k].add(t.summary.maxSpeed);
      rolling[k].add(t.summary.energy.rolling / t.summary.energy.released);
      steps[k] += double(t.summary.contactSteps);
      EXPECT_LT(std::abs(t.summary.energy.numerical), 2e-3 * t.summary.energy.released);
    }
  }
  expectSame(x[0], x[1], 0.01, "x", shape, e);
  expectSame(impacts[0], impacts[1], 0.03, "impacts", shape, e);
  expectSame(speed[0], speed[1], 0.01, "speed", shape, e);
  expectSame(rolling[0], rolling[1], 0.03, "rolling", shape, e);
  EXPECT_EQ(rolling[0].mean() > 0.0, rollingResistance > 0.0);
  EXPECT_LT(steps[0], 0.5 * steps[1]) << shapeName(shape) << ", e " << e;
}

} // namespace

TEST(ImpulseImpacts, AreThoseOfSpringsInTheMean)
{
  const Shape shapes[] = { Shape::Cube, Shape::Icosahedron, Shape::Eota111 };
  for (const Shape shape : std::span(shapes).first(std::size_t(someOf(3, 1))))
  {
    for (const double e : { 0.8, 0.4 })
    {
      expectThoseOfSprings(shape, e, 0.0, 1e9);
    }
  }
}

/// Springs that are stiff, as an impact is an event.
TEST(ImpulseImpacts, AreThoseOfSpringsWithRollingResistance)
{
  const Shape shapes[] = { Shape::Eota111, Shape::Icosahedron };
  for (const Shape shape : std::span(shapes).first(std::size_t(someOf(2, 1))))
  {
    expectThoseOfSprings(shape, 0.4, 0.1, 1e12);
  }
}
