// The slope as fixed DDA blocks against the slope as CFEs: the paper's comparison (2.3.1; figs 12
// and 14). The motion is the same; the cost is not.

#include "BlockSlope/blockSlope.h"
#include "Core/slopes.h"
#include "base/errors.h"
#include "form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

constexpr double kYoung[] = { 1e10, 1e11 }; // Pa, METHOD 9.1
constexpr SlopeModel kModels[] = { SlopeModel::OneBlock, SlopeModel::ArtificialBlocks };

Rock cubeAt(const Vec3& place, double young)
{
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.position = place;
  rock.youngModulus = young;
  return rock;
}

/// METHOD 9.1: density 2500, ν 0.1, penalty 1e9, Δt 0.01 s; samples every 0.01 s.
SimulationParameters dropParameters(double endTime)
{
  SimulationParameters p;
  p.normalPenalty = 1e9; // the paper's
  p.timeStep = p.outputInterval = 0.01;
  p.endTime = endTime;
  return p;
}

Terrain floorSlope()
{
  return makeSlope(
    5, 5.0, [](double, double) { return 100.0; }, material(1.0, 15.0));
}

/// Largest difference of velocity at all samples but those within 10 ms of a touch on CFEs: an
/// impact takes 2.5 ms, and the next sample may be 10 ms away. m/s.
double largestDifference(const Trajectory& onCfes, const Trajectory& onBlocks)
{
  const std::vector<Sample> cfes = evenSamples(onCfes), blocks = evenSamples(onBlocks);
  EXPECT_EQ(cfes.size(), blocks.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < std::min(cfes.size(), blocks.size()); ++k)
  {
    const Sample &a = cfes[k], &b = blocks[k];
    EXPECT_NEAR(a.time, b.time, 1e-9);
    const bool touching = std::any_of(onCfes.impacts.begin(), onCfes.impacts.end(),
      [&](const ImpactEvent& impact) { return std::abs(impact.time - a.time) < 0.0101; });
    largest = touching ? largest : std::max(largest, (a.velocity - b.velocity).norm());
  }
  return largest;
}

} // namespace

TEST(BlockSlope, PrismsAddUpToTheBlockOfTheWholeSlope)
{
  const double size = 20.0, depth = 1.5;
  const Terrain plane = makePlane(5, size, radians(30.0), 0.4, material(0.8, 15.0));
  const Surface surface = Surface::asSurveyed(plane);
  SlopeBlockMaterial m;
  m.depth = depth;
  const SlopeBlocks one = makeSlopeBlocks(surface, SlopeModel::OneBlock, m);
  const SlopeBlocks many = makeSlopeBlocks(surface, SlopeModel::ArtificialBlocks, m);
  ASSERT_EQ(one.blocks.size(), 1u);
  ASSERT_EQ(many.blocks.size(), 32u); // 2 · 4 · 4 CFEs
  const SlopeBlock& all = one.blocks[0];
  // The sheared box under a plane, to rounding of coordinates of 100 m.
  EXPECT_NEAR(all.integrals.volume, size * size * depth, 1e-10 * size * size * depth);
  EXPECT_NEAR((all.integrals.centroid - Vec3(10.0, 10.0, 100.0 - 0.5 * depth)).norm(), 0.0, 1e-10);
  EXPECT_NEAR(all.mass(0, 0), m.density * size * size * depth, 1e-3);
  // Kinetic energy of any first-order motion of the whole is the sum of the parts'.
  Vec12 motion;
  motion << 1, -2, 3, 0.1, 0.2, -0.3, 0.05, -0.02, 0.03, 0.01, 0.04, -0.05;
  double sum = 0.0;
  for (const SlopeBlock& part : many.blocks)
  {
    // The same motion about the part's own centroid: T is linear.
    Vec12 local = motion;
    for (int axis = 0; axis < 3; ++axis)
    {
      local[axis] = all.row(Vec3::Unit(axis), part.integrals.centroid).dot(motion);
    }
    sum += 0.5 * local.dot(part.mass * local);
  }
  EXPECT_NEAR(0.5 * motion.dot(all.mass * motion), sum, 1e-10 * sum); // rounding
}

TEST(BlockSlope, ADroppedCubeReboundsAsOnCfes)
{
  // Over one CFE, across several, and over a node; until it comes down again after 1.92 s. Later
  // landings are no measure: four corners at once amplify any spin, here from artificial blocks
  // that yield differently under the four.
  const Terrain slope = floorSlope();
  const double incident = std::sqrt(2.0 * kGravity * 2.0); // m/s, from 2 m
  for (const Vec3& place :
    { Vec3(11.5, 11.5, 102.5), Vec3(10.3, 9.3, 102.5), Vec3(10.0, 10.0, 102.5) })
  {
    for (double young : kYoung)
    {
      const Rock rock = cubeAt(place, young);
      const Trajectory onCfes = simulate(slope, rock, dropParameters(1.85));
      for (SlopeModel model : kModels)
      {
        const BlockSlopeRun run = simulateOnBlockSlope(slope, rock, dropParameters(1.85), model);
        EXPECT_EQ(run.unknowns, 12 * (model == SlopeModel::OneBlock ? 1 + 1 : 32 + 1));
        EXPECT_EQ(run.trajectory.summary.unsettledSteps, 0);
        // The bar is 2 % of the incident speed. A block of 1 m depth and 1e10 Pa yields by a few
        // per cent of the contact springs and keeps some of that as vibration; most over a node,
        // where each corner is on another block.
        const double difference = largestDifference(onCfes, run.trajectory);
        EXPECT_LT(difference, 0.02 * incident) << place.transpose() << ", E " << young;
        // Speed on the floor, from where the block is when it flies again.
        const Sample top = evenSamples(run.trajectory)[128];
        const double rebound =
          std::sqrt(top.velocity.squaredNorm() + 2.0 * kGravity * (top.position.z() - 100.5));
        EXPECT_NEAR(rebound / incident, 1.0, 0.01) << place.transpose() << ", E " << young;
        // Every joule is booked: rounding.
        const EnergyAudit& e = run.trajectory.summary.energy;
        EXPECT_LT(std::abs(e.numerical), 1e-9 * 2500.0 * kGravity * 2.0);
        std::printf("E %.0e, %d unknowns: velocity differs by %.4f %%, rebound %.4f\n", young,
          run.unknowns, 100.0 * difference / incident, rebound / incident);
      }
    }
  }
}

TEST(BlockSlope, ThreeReboundsOnOneBlockAreThoseOnCfes)
{
  // In the middle of the slope, where nothing makes the cube spin.
  const Terrain slope = floorSlope();
  for (double young : kYoung)
  {
    const Rock rock = cubeAt(Vec3(10.0, 10.0, 102.5), young);
    const Trajectory onCfes = simulate(slope, rock, dropParameters(4.0));
    const BlockSlopeRun run =
      simulateOnBlockSlope(slope, rock, dropParameters(4.0), SlopeModel::OneBlock);
    EXPECT_EQ(onCfes.impacts.size(), 3u);
    // The bar is 1 %; the block is far stiffer than the contact springs.
    EXPECT_LT(largestDifference(onCfes, run.trajectory), 0.01 * std::sqrt(2.0 * kGravity * 2.0));
  }
}

TEST(BlockSlope, ASlidingCubeGoesAsFarAsOnCfes)
{
  const double size = 60.0, azimuth = 0.3, angle = radians(30.0), endTime = 3.0;
  for (double friction : { 10.0, 20.0 })
  {
    const Terrain plane = makePlane(5, size, angle, azimuth, material(0.8, friction));
    SimulationParameters p; // METHOD 9.2
    p.normalPenalty = 1e9;
    p.timeStep = 0.01;
    p.endTime = endTime;
    p.outputInterval = 0.5;
    const Rock rock = cubeOnPlane(size, angle, azimuth, 20.0);
    const Trajectory onCfes = simulate(plane, rock, p);
    const double slope =
      std::sin(angle) - std::cos(angle) * std::tan(radians(friction)); // a / g, METHOD 9.2
    for (SlopeModel model : kModels)
    {
      const BlockSlopeRun run = simulateOnBlockSlope(plane, rock, p, model);
      const std::vector<Sample> cfes = evenSamples(onCfes), blocks = evenSamples(run.trajectory);
      ASSERT_EQ(blocks.size(), cfes.size());
      EXPECT_EQ(run.unknowns, 12 * (model == SlopeModel::OneBlock ? 1 + 1 : 32 + 1));
      for (std::size_t k = 1; k < cfes.size(); ++k)
      {
        const double way = (blocks[k].position - rock.position).norm();
        const double expected = (cfes[k].position - rock.position).norm();
        const double time = cfes[k].time;
        EXPECT_NEAR(way, expected, 0.01 * expected) << friction << "°, " << time << " s";
        const double closed = 0.5 * kGravity * slope * time * time;
        // The bar is 1 %; the cube starts at rest on unstressed springs.
        EXPECT_NEAR(way, closed, 0.01 * closed) << friction << "°, " << time << " s";
      }
    }
  }
}

TEST(BlockSlope, RidgesAndPeaksReboundAsOnCfes)
{
  // An edge on a ridge and faces on peaks, without friction and restitution.
  const Terrain ridge = makeSlope(
    9, 2.0, [](double x, double) { return 100.0 - 0.5 * std::abs(x - 8.0); }, material(1.0, 0.0));
  const Terrain peak = makeSlope(
    9, 2.0, [](double x, double y) { return 100.0 - 0.4 * std::hypot(x - 8.0, y - 8.0); },
    material(1.0, 0.0));
  double largest = 0.0;
  const int attitudes = isSmallForm() ? 1 : 6;
  for (const Terrain* slope : { &ridge, &peak })
  {
    for (int k = 0; k < attitudes; ++k)
    {
      Rock rock = cubeAt(Vec3(8.0 + 0.05 * k, 8.0 - 0.03 * k, 102.5), 1e11);
      rock.orientation = Quat(Eigen::AngleAxisd(0.5 * k, Vec3(1.0, 2.0, -1.0).normalized()));
      const SimulationParameters p = dropParameters(0.8); // touches after 0.55 s or so
      const Trajectory onCfes = simulate(*slope, rock, p);
      for (SlopeModel model : kModels)
      {
        const BlockSlopeRun run = simulateOnBlockSlope(*slope, rock, p, model);
        const Sample &a = onCfes.samples.back(), &b = run.trajectory.samples.back();
        const double incident = std::sqrt(2.0 * kGravity * 1.5); // m/s, at least
        const double difference = (a.velocity - b.velocity).norm() / incident;
        // The bar is 2 %: some attitudes touch three times in a row, and each adds what the blocks
        // yield.
        EXPECT_LT(difference, 0.02) << k;
        // Every joule is booked: rounding.
        EXPECT_LT(std::abs(run.trajectory.summary.energy.numerical), 1e-9 * 2500.0 * kGravity);
        largest = std::max(largest, difference);
      }
    }
  }
  std::printf("velocity differs by at most %.2f %%\n", 100.0 * largest);
}

TEST(BlockSlope, CostsMoreTheLargerTheSlope)
{
  Rock rock = cubeOnPlane(60.0, radians(30.0), 0.0, 10.0);
  SimulationParameters p;
  p.normalPenalty = 1e9;
  p.timeStep = 0.01;
  p.endTime = 0.5;
  double seconds[2];
  for (int k = 0; k < 2; ++k)
  {
    const Terrain plane = makePlane(k == 0 ? 2 : 11, 60.0, radians(30.0), 0.0, material(0.8, 10.0));
    const BlockSlopeRun run = simulateOnBlockSlope(plane, rock, p, SlopeModel::ArtificialBlocks);
    seconds[k] = run.secondsPerStep();
    std::printf("%d blocks, %d unknowns: %.2e s per step\n", run.blocks, run.unknowns, seconds[k]);
  }
  // 100 times the blocks cost some 40 times as much; a tenth of that leaves room for a busy
  // machine.
  EXPECT_GT(seconds[1], 4.0 * seconds[0]);
}

TEST(BlockSlope, BadInputIsRefused)
{
  const Terrain slope = floorSlope();
  const Rock rock = cubeAt(Vec3(10.0, 10.0, 102.5), 1e10);
  const SimulationParameters p = dropParameters(0.1);
  EXPECT_THROW(simulateOnBlockSlope(slope, rock, p, SlopeModel::OneBlock, -1.0), ParameterError);
  EXPECT_THROW(
    simulateOnBlockSlope(slope, cubeAt(Vec3(-5.0, 10.0, 102.5), 1e10), p, SlopeModel::OneBlock),
    PlacementError);
}
