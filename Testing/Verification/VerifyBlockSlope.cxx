// The slope as CFEs and as fixed blocks, the two ways that the paper compares (2.3.1; fig. 12): the
// same velocity history. The cost of each is reported.

#include "verification.h"

#include "BlockSlope/blockSlope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

using namespace rockfall;
using namespace rockfall::verification;
using rockfall::testing::kGravity;

TEST(BlockSlope, GivesTheVelocityHistoryOfCfes)
{
  const Terrain floor = flatGround(20.0, surface(1.0, 15.0), 5);
  Rock rock;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.position = Vec3(10.0, 10.0, 2.5);
  const double incident = std::sqrt(2.0 * kGravity * 2.0); // m/s
  for (double modulus : { 1e10, 1e11 })
  {
    rock.youngModulus = modulus;
    for (double timeStep : { 0.01, 0.005 })
    {
      SimulationParameters p;
      p.normalPenalty = 1e9; // the paper's
      p.timeStep = timeStep;
      p.outputInterval = 0.01;
      p.endTime = 3.0;
      const Trajectory onCfes = rockfall::testing::simulate(floor, rock, p);
      const BlockSlopeRun onBlock = simulateOnBlockSlope(floor, rock, p, SlopeModel::OneBlock);
      const std::vector<Sample>&a = onCfes.samples, &b = onBlock.trajectory.samples;
      ASSERT_EQ(a.size(), b.size());
      double difference = 0.0;
      std::vector<double> times, speeds;
      for (std::size_t k = 0; k < a.size(); ++k)
      {
        times.push_back(b[k].time);
        speeds.push_back(b[k].velocity.z());
        bool touching = false;
        for (const ImpactEvent& impact : onCfes.impacts)
        {
          touching = touching || std::abs(impact.time - a[k].time) < 0.0101;
        }
        difference =
          touching ? difference : std::max(difference, (a[k].velocity - b[k].velocity).norm());
      }
      const std::string head =
        "fig. 12, E " + text(modulus) + " Pa, Δt " + text(timeStep) + " s, drop of 2 m: ";
      recordAtMost(
        { "Elastic rebound",
          head +
            "largest difference of velocity between slope as block and CFEs in 3 s, "
            "share of the incident speed",
          "",
          "nearly the same in the paper; 1 %, without the 10 ms of an impact between two "
          "samples" },
        difference / incident, 0.01);
      if (modulus == 1e11)
      {
        addCurve("velocity-history", "slope as block, Δt " + text(timeStep) + " s", times, speeds);
      }
    }
  }
}

TEST(BlockSlope, CostsMoreTheLargerTheSlope)
{
  // Time of a whole run over the number of its steps, the quickest of five: reported, never decides.
  std::vector<double> cfes, onBlocks, onCfes;
  for (int nodes : { 2, 3, 5, 9 })
  {
    Rock rock = rockfall::testing::cubeOnPlane(60.0, radians(30.0), 0.0, 10.0);
    SimulationParameters p;
    p.normalPenalty = 1e9;
    p.timeStep = 0.01;
    p.endTime = 0.5;
    const Terrain plane =
      rockfall::testing::makePlane(nodes, 60.0, radians(30.0), 0.0, surface(0.8, 10.0));
    int unknowns = 0;
    double stepOnBlocks = 1e300, stepOnCfes = 1e300; // s
    for (int round = 0; round < 5; ++round)
    {
      const BlockSlopeRun run = simulateOnBlockSlope(plane, rock, p, SlopeModel::ArtificialBlocks);
      const auto begin = std::chrono::steady_clock::now();
      const Trajectory t = rockfall::testing::simulate(plane, rock, p);
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
      unknowns = run.unknowns;
      stepOnBlocks = std::min(stepOnBlocks, run.secondsPerStep());
      stepOnCfes = std::min(
        stepOnCfes, took.count() / double(std::max<std::int64_t>(1, t.summary.contactSteps)));
    }
    cfes.push_back(double(plane.cfeCapacity()));
    onBlocks.push_back(1e6 * stepOnBlocks);
    onCfes.push_back(1e6 * stepOnCfes);
    report({ "Slope as blocks", text(cfes.back()) + " CFEs: unknowns of a step, slope as blocks",
             "", "12 on CFEs" },
      unknowns);
    report({ "Slope as blocks", text(cfes.back()) + " CFEs: time per step, slope as blocks", "µs",
             "quickest of five; never decides" },
      onBlocks.back());
    report({ "Slope as blocks", text(cfes.back()) + " CFEs: time per step, slope as CFEs", "µs",
             "quickest of five; never decides" },
      onCfes.back());
    // Two CFEs a cell, a block under each; as CFEs the slope adds nothing to the rock's 12.
    EXPECT_EQ(unknowns, 12 * (2 * (nodes - 1) * (nodes - 1) + 1));
  }
  addCurve("block-cost", "slope as blocks", cfes, onBlocks);
  addCurve("block-cost", "slope as CFEs", cfes, onCfes);
}
