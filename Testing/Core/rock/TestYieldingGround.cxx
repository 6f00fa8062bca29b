// Ground that gives way: what a scar takes against closed forms, rolling that stops, slip-dependent
// friction, books in single and mass falls, and hard ground as its limit.

#include "slopes.h"

#include "base/errors.h"
#include "block/Block.h"
#include "contact/ground/submerged.h"
#include "form.h"
#include "rock/parts/Scar.h"
#include "run/stateHash.h"
#include "world/World.h"

#include <gtest/gtest.h>

#include <numbers>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kDensity = 1700.0; // of the ground, kg/m³

SurfaceMaterial meadow()
{
  SurfaceMaterial m = softGround();
  m.yielding.spinDrag = 1.0;
  m.yielding.frictionLeast = 0.55;
  m.yielding.frictionMost = 2.0;
  m.yielding.frictionGrowth = 3.0;
  m.yielding.frictionDecay = 185.0;
  return m;
}

double largestError(const EnergyAudit& e)
{
  const double sum = e.kinetic + e.strain + e.friction + e.restitution + e.vibration + e.damping +
    e.structures + e.scars + e.rolling + e.exchanged + e.numerical;
  return std::abs(sum - e.released) / std::max(1.0, std::abs(e.released));
}

/// Volume of what of a polyhedron at `position` is under z = 0, m³: a sum of slices, each a convex
/// polygon, by Simpson's rule between the heights of the corners, where the section is quadratic.
double volumeUnder(const Polyhedron& shape, const Quat& orientation, const Vec3& position)
{
  std::vector<Vec3> corners;
  std::vector<double> heights = { 0.0 };
  for (const Vec3& v : shape.vertices())
  {
    corners.push_back(orientation * v + position);
    if (corners.back().z() < 0.0)
    {
      heights.push_back(corners.back().z());
    }
  }
  std::sort(heights.begin(), heights.end());
  const auto section = [&](double z)
  {
    std::vector<Vec3> points;
    for (const Polyhedron::Edge& e : shape.edges())
    {
      const Vec3 &a = corners[std::size_t(e.vertices[0])], &b = corners[std::size_t(e.vertices[1])];
      if ((a.z() < z) != (b.z() < z))
      {
        points.push_back(a + (z - a.z()) / (b.z() - a.z()) * (b - a));
      }
    }
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : points)
    {
      middle += p / double(points.size());
    }
    std::sort(points.begin(), points.end(),
      [&](const Vec3& p, const Vec3& q)
      {
        return std::atan2(p.y() - middle.y(), p.x() - middle.x()) <
          std::atan2(q.y() - middle.y(), q.x() - middle.x());
      });
    double area = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      const Vec3 &p = points[k], &q = points[(k + 1) % points.size()];
      area += 0.5 *
        ((p.x() - middle.x()) * (q.y() - middle.y()) - (q.x() - middle.x()) * (p.y() - middle.y()));
    }
    return area;
  };
  double volume = 0.0;
  for (std::size_t k = 1; k < heights.size(); ++k)
  {
    const double low = heights[k - 1], high = heights[k], hair = 1e-9 * (high - low);
    if (high - low > 1e-12)
    {
      volume += (high - low) / 6.0 *
        (section(low + hair) + 4.0 * section(0.5 * (low + high)) + section(high - hair));
    }
  }
  return volume;
}

} // namespace

TEST(YieldingGround, SubmergedAreaOfACube)
{
  const Block block(makeShape(Shape::Cube, 1.0), 2500.0, 1e10, 0.2);
  BlockState state;
  state.position = Vec3(3.0, -2.0, 0.2); // its lower face at −0.3
  PlacedBlock placed;
  placed.place(block, state);
  const Plane ground;
  EXPECT_NEAR(submerged(placed, ground, -Vec3::UnitZ()).area, 1.0, 1e-12);
  EXPECT_NEAR(submerged(placed, ground, Vec3::UnitX()).area, 0.3, 1e-12);
  const Vec3 slanted = Vec3(1.0, 0.0, -1.0).normalized();
  EXPECT_NEAR(submerged(placed, ground, slanted).area, (1.0 + 0.3) / std::sqrt(2.0), 1e-12);
  state.position.z() = 0.51;
  placed.place(block, state);
  EXPECT_EQ(submerged(placed, ground, -Vec3::UnitZ()).area, 0.0);
}

// A turn in pieces of a flight sweeps what many small ones do: the areas at their ends tell within
// 3 %, a tenth of what the drag itself is known to.
TEST(YieldingGround, PiecesOfATurnSweepTheSame)
{
  const Block block(makeShape(Shape::Eota111, 1.0), 2500.0, 1e10, 0.2);
  const double down = 0.25, turn = 0.8;
  const auto volume = [&](int pieces)
  {
    Contact touch;
    touch.normal = Vec3::UnitZ();
    Scar scar;
    scar.sink(1.0, 0, touch);
    const auto poseAt = [&](double share)
    {
      BlockState state;
      state.orientation = Quat(Eigen::AngleAxisd(turn * share, Vec3::UnitY()));
      // The lowest corner is level with the surface at first.
      state.position = Vec3(2.0 * share, 0.0, block.radius() - down * share);
      return state;
    };
    PlacedBlock placed;
    double sum = 0.0;
    for (int k = 0; k < pieces; ++k)
    {
      const auto at = [&](double fraction) -> const PlacedBlock&
      {
        placed.place(block, poseAt((k + fraction) / pieces));
        return placed;
      };
      const Vec3 way = poseAt((k + 1.0) / pieces).position - poseAt(double(k) / pieces).position;
      sum += scar.sweep(way, at, true);
    }
    return sum;
  };
  const double fine = volume(4000);
  EXPECT_GT(fine, 0.01);
  EXPECT_NEAR(volume(int(std::ceil(turn / 0.2)) * 2), fine, 0.03 * fine);
}

// A rock that goes straight down without gravity sweeps the volume that is under the surface, as
// long as its widest section is above it: E/E₀ = exp(−C_d ρ V / m).
TEST(YieldingGround, ScarTakesWhatTheSweptVolumeSays)
{
  for (const Shape shape : { Shape::Cube, Shape::Tetrahedron, Shape::Octahedron,
         Shape::Dodecahedron, Shape::Icosahedron, Shape::Eota111 })
  {
    for (const double step : { 0.01, 0.005, 0.0003 })
    {
      SurfaceMaterial m = meadow();
      m.yielding.modulus = 1e3; // Λ is far down
      m.yielding.compaction = 2.0;
      Rock rock;
      rock.shape = makeShape(shape, 1.0);
      if (shape == Shape::Tetrahedron)
      {
        // A corner down, so that its section grows.
        rock.orientation = turnBetween(rock.shape.vertices()[0], -Vec3::UnitZ());
      }
      double lowest = 0.0;
      for (const Vec3& v : rock.shape.vertices())
      {
        lowest = std::min(lowest, (rock.orientation * v).z());
      }
      const double down = 5.0;
      rock.position = Vec3(20.0, 20.0, 100.05 - lowest);
      rock.velocity = Vec3(0.0, 0.0, -down);
      SimulationParameters p;
      p.gravity = 0.0;
      p.timeStep = step;
      p.endTime = 0.06; // less than its widest section takes
      const Trajectory t = simulate(makePlane(2, 40.0, 0.0, 0.0, m), rock, p);
      const Sample& end = t.samples.back();
      const double depth = 100.0 - (end.position.z() + lowest);
      ASSERT_GT(depth, 0.1) << shapeName(shape);
      const double volume =
        volumeUnder(rock.shape, rock.orientation, Vec3(0.0, 0.0, end.position.z() - 100.0));
      const double mass = t.summary.mass;
      const double left = end.kineticEnergy / (0.5 * mass * down * down);
      EXPECT_NEAR(left, std::exp(-3.0 * kDensity * volume / mass), 1e-6)
        << shapeName(shape) << ", step " << step;
      EXPECT_NEAR(t.summary.energy.scars, (1.0 - left) * 0.5 * mass * down * down, 1e-3);
    }
  }
}

TEST(YieldingGround, HardIsItsLimitBitForBit)
{
  const Terrain hard = makePlane(21, 40.0, radians(25.0), 0.3, material(0.7, 25.0));
  SurfaceMaterial limit = material(0.7, 25.0);
  limit.yielding.compaction = 0.0;
  limit.yielding.density = 1700.0;
  limit.yielding.depthFactor = 0.1;
  const Terrain soft = makePlane(21, 40.0, radians(25.0), 0.3, limit);
  EXPECT_FALSE(soft.yields());
  limit.yielding.modulus = 1e15; // yields, but nowhere deeper than a hundredth of the radius
  const Terrain almost = makePlane(21, 40.0, radians(25.0), 0.3, limit);
  EXPECT_TRUE(almost.yields());
  for (const Shape shape : { Shape::Cube, Shape::Eota111 })
  {
    Rock rock;
    rock.shape = makeShape(shape, 0.7);
    rock.position = Vec3(10.0, 12.0, 108.0);
    rock.angularVelocity = Vec3(0.5, 2.0, 0.1);
    SimulationParameters p;
    p.endTime = 6.0;
    const std::uint64_t hash = motionHash(simulate(hard, rock, p));
    EXPECT_EQ(hash, motionHash(simulate(soft, rock, p)));
    EXPECT_EQ(hash, motionHash(simulate(almost, rock, p)));
  }
}

TEST(YieldingGround, EveryImpactTellsItsScar)
{
  Rock rock;
  rock.shape = makeShape(Shape::Eota111, 0.3);
  rock.position = Vec3(20.0, 20.0, 105.0);
  rock.velocity = Vec3(6.0, 0.0, 0.0);
  SimulationParameters p;
  p.endTime = 10.0;
  const Trajectory t = simulate(makePlane(21, 200.0, 0.0, 0.0, meadow()), rock, p);
  ASSERT_FALSE(t.impacts.empty());
  const ImpactEvent& first = t.impacts.front();
  const YieldingGround ground = meadow().yielding;
  const double down = std::sqrt(2.0 * kGravity * 4.6);
  EXPECT_GT(first.scarDepth, 0.7 * ground.scarDepth(t.summary.mass, t.summary.volume, down));
  EXPECT_LT(first.scarDepth, 1.3 * ground.scarDepth(t.summary.mass, t.summary.volume, down));
  EXPECT_GT(first.scarLength, 0.0);
  EXPECT_GT(t.summary.energy.scars, 0.05 * t.summary.energy.released);
  EXPECT_LT(largestError(t.summary.energy), 1e-9);
  EXPECT_LT(std::abs(t.summary.energy.numerical), 1e-3 * t.summary.energy.released);
  EXPECT_EQ(t.summary.fate, Fate::Rested);
}

// No creep: what has bounced its last is at rest within seconds on slopes gentler than μ_r.
// Azzoni's distance, with a finer ball: Testing/Verification/VerifyRolling.cxx.
TEST(YieldingGround, ComesToRestOnGentleSlopes)
{
  Rock rock;
  rock.shape = makeShape(Shape::Eota111, 1.0);
  for (const double slope : { 10.0, 15.0 })
  {
    SurfaceMaterial m = meadow();
    const Terrain terrain = makePlane(2, 400.0, radians(slope), 0.0, m);
    rock.position = Vec3(100.0, 200.0, 0.0);
    rock.position.z() = terrain.elevation(100.0, 200.0) + 3.0;
    rock.velocity = Vec3(12.0, 0.5, 0.0);
    SimulationParameters p;
    p.endTime = 120.0;
    const Trajectory t = simulate(terrain, rock, p);
    ASSERT_EQ(t.summary.fate, Fate::Rested) << slope << " degrees";
    EXPECT_LT(t.summary.endTime, t.impacts.back().time + 10.0) << slope << " degrees";
    EXPECT_LT(largestError(t.summary.energy), 1e-9);
  }
}

TEST(YieldingGround, NoRockHopsInItsScarForEver)
{
  // An impact that draws a restitution of 1, on slow touches all of it, has an end all the same.
  SurfaceMaterial m = meadow();
  m.restitutionModel = RestitutionModel::SpeedDependent;
  m.restitutionSpeed = 8.0;
  m.restitution = 0.7;
  m.restitutionDeviation = 0.35;
  Terrain terrain = makePlane(2, 600.0, radians(10.0), 0.0, m);
  terrain.setDeviationPer(DeviationPer::Impact);
  SimulationParameters p;
  p.endTime = 60.0;
  p.outputInterval = 60.0;
  for (int k = 0; k < 60; ++k)
  {
    Rock rock;
    rock.shape = makeShape(Shape::Eota111, 0.5);
    rock.position = Vec3(100.0, 300.0, terrain.elevation(100.0, 300.0) + 3.0);
    rock.orientation = Quat(Eigen::AngleAxisd(0.7 * k, Vec3(1.0, 0.1 * k, 0.2).normalized()));
    rock.velocity = Vec3(10.0, 0.1 * k, 0.0);
    const Trajectory t = simulate(terrain, rock, p);
    EXPECT_EQ(t.summary.fate, Fate::Rested) << k;
    EXPECT_LT(t.summary.endTime - t.impacts.back().time, 10.0) << k;
  }
}

TEST(YieldingGround, BooksCloseInAMassFall)
{
  const Terrain terrain = makePlane(41, 80.0, radians(30.0), 0.0, meadow());
  std::vector<Rock> rocks;
  for (int k = 0; k < 12; ++k)
  {
    Rock rock;
    rock.shape = makeShape(k % 2 ? Shape::Cube : Shape::Eota111, 0.2 + 0.1 * (k % 3));
    rock.position = Vec3(20.0 + 1.5 * (k % 4), 38.0 + 1.5 * (k / 4), 0.0);
    rock.position.z() = terrain.elevation(rock.position.x(), rock.position.y()) + 2.0;
    rock.blockId = k;
    rocks.push_back(rock);
  }
  SimulationParameters p;
  p.rockRockContact = true;
  p.endTime = 8.0;
  TrajectoryStore store(int(rocks.size()), 1);
  runEnsemble(terrain, rocks, p, store);
  double released = 0.0, scars = 0.0, numerical = 0.0;
  for (const Trajectory& t : store.trajectories())
  {
    EXPECT_LT(largestError(t.summary.energy), 1e-9);
    released += t.summary.energy.released;
    scars += t.summary.energy.scars;
    numerical += t.summary.energy.numerical;
    EXPECT_GT(t.summary.energy.scars, 0.0);
    EXPECT_GT(t.samples.back().heightOverGround, -0.5);
  }
  EXPECT_GT(scars, 0.02 * released);
  EXPECT_LT(std::abs(numerical), 1e-3 * released);
}

TEST(YieldingGround, BadNumbersNameTheirField)
{
  SurfaceMaterial m;
  m.yielding.rollingResistance = -0.1;
  try
  {
    m.validate();
    FAIL();
  }
  catch (const ParameterError& error)
  {
    EXPECT_NE(std::string(error.what()).find("RollingResistance is -0.1"), std::string::npos);
  }
  m.yielding = meadow().yielding;
  m.yielding.frictionLeast = 3.0;
  EXPECT_THROW(m.validate(), ParameterError);
}

TEST(YieldingGround, SoftnessIsAFieldOverTheMap)
{
  SurfaceMaterial m = meadow();
  m.yielding.deviation = 0.5;
  m.yielding.deviationLength = 20.0;
  const Terrain terrain = makePlane(2, 2000.0, 0.0, 0.0, m);
  EXPECT_TRUE(terrain.draws());
  EXPECT_EQ(Surface::asSurveyed(terrain).softnessAt(0, Vec3(50.0, 50.0, 0.0)), 1.0);
  double sum = 0.0, squares = 0.0, near = 0.0, far = 0.0;
  int count = 0;
  for (int iteration = 0; iteration < 4; ++iteration)
  {
    const Surface surface(terrain, 7, iteration);
    for (double x = 100.0; x < 1900.0; x += 60.0)
    {
      for (double y = 100.0; y < 1900.0; y += 60.0)
      {
        const auto at = [&](double ahead)
        { return std::log(surface.softnessAt(0, Vec3(x + ahead, y, 0.0))) / 0.5; };
        const double f = at(0.0);
        sum += f;
        squares += f * f;
        near += f * at(20.0);
        far += f * at(60.0);
        ++count;
      }
    }
  }
  // 3600 places that are nearly independent: four standard errors.
  const double error = 4.0 / std::sqrt(double(count));
  EXPECT_NEAR(sum / count, 0.0, error);
  EXPECT_NEAR(squares / count, 1.0, std::sqrt(2.0) * error);
  EXPECT_NEAR(near / count, std::exp(-1.0), 1.2 * error);
  EXPECT_NEAR(far / count, std::exp(-9.0), error);
}

TEST(YieldingGround, SoftGroundGivesDeeperScars)
{
  const YieldingGround ground = meadow().yielding;
  EXPECT_NEAR(ground.scarDepth(500.0, 0.2, 10.0, 3.0) / ground.scarDepth(500.0, 0.2, 10.0),
    std::pow(3.0, 0.4), 1e-12);
  EXPECT_EQ(ground.scarDepth(500.0, 0.2, 10.0, 1.0), ground.scarDepth(500.0, 0.2, 10.0));
}

TEST(YieldingGround, WithoutDeviationNothingIsDrawn)
{
  Rock rock;
  rock.shape = makeShape(Shape::Icosahedron, 0.5);
  rock.velocity = Vec3(6.0, 0.5, 0.0);
  const auto hashOf = [&](const SurfaceMaterial& m)
  {
    const Terrain terrain = makePlane(41, 80.0, radians(25.0), 0.0, m);
    rock.position = Vec3(10.0, 40.0, terrain.elevation(10.0, 40.0) + 2.0);
    SimulationParameters p;
    p.endTime = 6.0;
    TrajectoryStore store(1, 1);
    runEnsemble(terrain, std::vector<Rock>{ rock }, p, store);
    return motionHash(store.trajectories().front());
  };
  SurfaceMaterial plain = meadow(), longer = meadow(), deviating = meadow();
  longer.yielding.deviationLength = 5.0;
  deviating.yielding.deviation = 0.5;
  EXPECT_EQ(hashOf(plain), hashOf(longer));
  EXPECT_NE(hashOf(plain), hashOf(deviating));
  // Hard ground has nothing that could be soft.
  SurfaceMaterial hard, deviatingHard;
  deviatingHard.yielding.deviation = 0.5;
  EXPECT_EQ(hashOf(hard), hashOf(deviatingHard));
  EXPECT_FALSE(makePlane(2, 10.0, 0.0, 0.0, deviatingHard).draws());
}

TEST(YieldingGround, ADeviationNeedsALength)
{
  SurfaceMaterial m = meadow();
  m.yielding.deviationLength = 0.0;
  EXPECT_NO_THROW(m.validate());
  m.yielding.deviation = 0.3;
  try
  {
    m.validate();
    FAIL();
  }
  catch (const ParameterError& error)
  {
    EXPECT_EQ(std::string(error.what()),
      "GroundDeviationLength is 0 m, it must be at least 0.01 where GroundDeviation is 0.3");
  }
}

TEST(YieldingGround, LargeRocksDigLessForTheirSize)
{
  const YieldingGround alike = meadow().yielding;
  YieldingGround sized = alike;
  sized.scarRadius = 0.5;
  const double density = 2500.0, ball = std::numbers::pi / 6.0; // m³, r 0.5 m
  const auto depth = [&](const YieldingGround& ground, double volume)
  { return ground.scarDepth(density * volume, volume, 10.0); };
  EXPECT_DOUBLE_EQ(depth(sized, ball), depth(alike, ball));
  // d ~ r where all are alike, r^(2/3) where they are not.
  EXPECT_NEAR(depth(alike, 8.0 * ball) / depth(alike, ball), 2.0, 1e-12);
  EXPECT_NEAR(depth(sized, 8.0 * ball) / depth(sized, ball), std::cbrt(4.0), 1e-12);
  EXPECT_NEAR(depth(sized, ball / 27.0) / depth(alike, ball / 27.0), std::cbrt(3.0), 1e-12);
}

TEST(YieldingGround, EveryNumberHasTwoEnds)
{
  for (const YieldingField& field : yieldingFields())
  {
    SCOPED_TRACE(field.property);
    YieldingGround ground;
    field.set(ground, 1e300);
    EXPECT_THROW(ground.validate(), ParameterError);
    // Hard ground is typed as 0, not as infinite.
    EXPECT_THROW(field.set(ground, std::numeric_limits<double>::infinity()), ParameterError);
  }
  YieldingGround air;
  air.density = 0.5;
  EXPECT_THROW(air.validate(), ParameterError);
  air.density = 1.0;
  EXPECT_NO_THROW(air.validate());
}
