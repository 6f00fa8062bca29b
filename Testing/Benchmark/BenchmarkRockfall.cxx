// Many single rocks down a rough slope, the work on which rigid-body engines are compared:
// terrain of 201 × 201 nodes and 1 m cells, 30° down along x for 100 m, then flat; Gaussian
// roughness of 0.1 m on each node; 256 rocks of 1 m³, cube or icosahedron, density 2500, random
// attitudes, lowest point about 2 m over the slope's top, 1 m/s along x; φ 15°; 10 s of motion; one
// thread. The same on ground that yields: presets, without their roughness. Counters: rock-steps
// per second (rocks × duration / Δt / wall time) and trajectories per second.
//
// Run: BenchmarkRockfall [--benchmark_repetitions=5 --benchmark_report_aggregates_only=true]

#include "benchSlope.h"
#include "geometry/shapes.h"
#include "run/ensemble.h"
#include "terrain/presets.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

using namespace rockfall;

namespace
{

constexpr int kRocks = 256;
constexpr double kDuration = 10.0; // s

std::vector<Rock> benchRocks(Shape shape, const Terrain& slope)
{
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const Polyhedron polyhedron = makeShape(shape, 1.0);
  std::vector<Rock> rocks(kRocks);
  for (int k = 0; k < kRocks; ++k)
  {
    Rock& rock = rocks[k];
    rock.blockId = k;
    rock.shape = polyhedron;
    const double x = 5.0 + 2.0 * u(random), y = 50.0 + 100.0 * u(random);
    rock.position = Vec3(x, y, slope.elevation(x, y) + 2.0 + 0.87);
    rock.velocity = Vec3(1.0, u(random) - 0.5, 0.0);
    std::normal_distribution<double> n(0.0, 1.0);
    const double qx = n(random), qy = n(random), qz = n(random), qw = n(random);
    rock.orientation = Quat(qw, qx, qy, qz).normalized();
  }
  return rocks;
}

void singleRocks(benchmark::State& state, Shape shape, double timeStep, const Terrain& slope)
{
  const std::vector<Rock> rocks = benchRocks(shape, slope);
  SimulationParameters p;
  p.normalPenalty = 1e9; // the paper's
  p.timeStep = timeStep;
  p.endTime = kDuration;
  p.outputInterval = kDuration;
  p.threads = 1;
  double meanX = 0.0, steps = 0.0;
  for (auto _ : state)
  {
    TrajectoryStore store(kRocks, 1);
    const Ensemble ensemble(slope, rocks, p);
    ensemble.run(ensemble.whole(), store);
    meanX = 0.0, steps = 0.0;
    for (const Trajectory& t : store.trajectories())
    {
      meanX += t.summary.stop.x() / kRocks;
      steps += double(t.summary.contactSteps) / kRocks;
    }
  }
  const double runs = double(state.iterations()) * kRocks;
  state.counters["trajectories/s"] = benchmark::Counter(runs, benchmark::Counter::kIsRate);
  state.counters["rocksteps/s"] =
    benchmark::Counter(runs * kDuration / timeStep, benchmark::Counter::kIsRate);
  state.counters["mean_x"] = meanX;
  state.counters["contact_steps"] = steps;
}

} // namespace

int main(int argc, char** argv)
{
  benchmark::Initialize(&argc, argv);
  for (Shape shape : { Shape::Cube, Shape::Icosahedron })
  {
    for (double timeStep : { 0.005, 0.001 })
    {
      const auto add = [&](const Terrain& slope, const std::string& label)
      {
        const std::string name =
          shapeName(shape) + "/dt:" + (timeStep > 0.002 ? "0.005" : "0.001") + "/" + label;
        benchmark::RegisterBenchmark(name.c_str(), singleRocks, shape, timeStep, slope)
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
      };
      add(benchSlope(0.8, RestitutionModel::NormalTangential), "normal_0.8");
      add(benchSlope(0.8, RestitutionModel::Velocity), "velocity_0.8");
      add(benchSlope(0.0, RestitutionModel::NormalTangential), "normal_0");
      for (const char* preset : { "meadow", "soil", "talus" })
      {
        Terrain slope = benchSlope(groundPreset(preset).material());
        slope.setDeviationPer(groundPreset(preset).deviationPer());
        add(slope, preset);
      }
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
