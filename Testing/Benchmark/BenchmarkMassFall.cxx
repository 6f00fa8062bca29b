// A mass fall, the work on which rigid-body engines are compared: the slope of BenchmarkRockfall;
// 10 to 10,000 cubes of 0.6 m³ in columns above it with gaps of 0.15 m, released together, all
// collisions on; restitution 0.2, φ 15°, Δt 0.005 s; 5 s of motion (3 s for 10,000). Counters:
// rock-steps per second (rocks × steps / wall time), how far the rocks got and the deepest overlap
// of two of them, of their edge. BenchmarkOde does the same with another engine.
//
// Run: BenchmarkMassFall [--benchmark_filter=rocks:1000/dt:0.005/threads:1]

#include "manyCubes.h"
#include "world/World.h"

#include <tbb/global_control.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <vector>

using namespace rockfall;

namespace
{

constexpr int kLookEvery = 10; // steps

void massFall(benchmark::State& state, int count, double timeStep, int threads)
{
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const Terrain slope = benchSlope(0.2, RestitutionModel::NormalTangential);
  const std::vector<Rock> rocks = columns(count);
  std::vector<Block> blocks;
  for (const Rock& r : rocks)
  {
    blocks.emplace_back(r.shape, r.density, r.youngModulus, r.poissonRatio);
  }
  SimulationParameters p;
  p.timeStep = timeStep;
  p.endTime = fallTime(count);
  p.outputInterval = p.endTime;
  p.rockRockContact = true;
  p.rockRestitution = kRockRestitution;
  p.rockFrictionAngle = radians(kRockFriction);
  const Surface surface(slope, 1, 0);
  double meanX = 0.0, unsettled = 0.0, overlap = 0.0;
  for (auto _ : state)
  {
    World fall(surface, rocks, blocks, p);
    int step = 0;
    const auto look = [&](double)
    {
      if (++step % kLookEvery == 0)
      {
        state.PauseTiming();
        overlap =
          std::max(overlap, deepestOverlap(blocks[0], count, [&](int i) { return fall.state(i); }));
        state.ResumeTiming();
      }
      return true;
    };
    const std::vector<Trajectory> runs = fall.run(look);
    meanX = unsettled = 0.0;
    for (const Trajectory& t : runs)
    {
      meanX += t.summary.stop.x() / count;
      unsettled += double(t.summary.unsettledSteps) / count;
    }
  }
  state.counters["rocksteps/s"] = benchmark::Counter(
    double(state.iterations()) * count * p.endTime / p.timeStep, benchmark::Counter::kIsRate);
  state.counters["mean_x"] = meanX;
  state.counters["overlap"] = overlap;
  state.counters["unsettled"] = unsettled;
}

} // namespace

int main(int argc, char** argv)
{
  benchmark::Initialize(&argc, argv);
  for (int count : { 10, 41, 100, 1000, 10000 })
  {
    for (const char* timeStep : { "0.005", "0.01" })
    {
      for (int threads : { 1, 2 })
      {
        const std::string name = "rocks:" + std::to_string(count) + "/dt:" + timeStep +
          "/threads:" + std::to_string(threads);
        benchmark::RegisterBenchmark(name.c_str(), massFall, count, std::stod(timeStep), threads)
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime()
          ->Iterations(1);
      }
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
