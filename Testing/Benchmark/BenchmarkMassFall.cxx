// A mass fall, the work on which rigid-body engines are compared: the slope of BenchmarkRockfall;
// 1000 or 10,000 cubes of 0.6 m³ in columns above it with gaps of 0.15 m, released together, all
// collisions on; restitution 0.2, φ 15°, Δt 0.005 s; 5 s of motion (3 s for 10,000). Counters:
// rock-steps per second (rocks × steps / wall time) and how far the rocks got.
//
// Run: BenchmarkMassFall [--benchmark_filter=rocks:1000/threads:1]

#include "benchSlope.h"
#include "geometry/shapes.h"
#include "simulation/MassFall.h"

#include <tbb/global_control.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

using namespace rockfall;

namespace
{

std::vector<Rock> columns(int count)
{
  const Polyhedron cube = makeShape(Shape::Cube, 0.6);
  const int nx = count <= 1000 ? 10 : 20, ny = count <= 1000 ? 10 : 25;
  const double spacing = std::cbrt(0.6) + 0.15;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<Rock> rocks(count);
  for (int k = 0; k < count; ++k)
  {
    const int a = k % nx, b = k / nx % ny, level = k / (nx * ny);
    Rock& rock = rocks[k];
    rock.blockId = k;
    rock.shape = cube;
    const double x = 8.0 + a * spacing + 0.02 * (u(random) - 0.5);
    const double y = 100.0 + (b - ny * 0.5) * spacing + 0.02 * (u(random) - 0.5);
    rock.position = Vec3(x, y, (100.0 - x) * std::tan(radians(30.0)) + 0.5 + 1.0 + level * spacing);
  }
  return rocks;
}

void massFall(benchmark::State& state, int count, int threads)
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
  p.timeStep = 0.005;
  p.endTime = count <= 1000 ? 5.0 : 3.0;
  p.outputInterval = p.endTime;
  p.rockRockContact = true;
  p.rockRestitution = 0.2;
  p.rockFrictionAngle = radians(15.0);
  const Surface surface(slope, 1, 0);
  double meanX = 0.0, unsettled = 0.0;
  for (auto _ : state)
  {
    MassFall fall(surface, rocks, blocks, p);
    const std::vector<Trajectory> runs = fall.run();
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
  state.counters["unsettled"] = unsettled;
}

} // namespace

int main(int argc, char** argv)
{
  benchmark::Initialize(&argc, argv);
  for (int count : { 100, 1000, 10000 })
  {
    for (int threads : { 1, 2 })
    {
      const std::string name =
        "rocks:" + std::to_string(count) + "/threads:" + std::to_string(threads);
      benchmark::RegisterBenchmark(name.c_str(), massFall, count, threads)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->Iterations(1);
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
