// One flight segment in free rotation: FreeRotation made anew (as fly does), and one that is asked
// again and again.
//
// Run: BenchmarkFlight

#include "block/FreeRotation.h"
#include "block/flight.h"
#include "geometry/shapes.h"

#include <benchmark/benchmark.h>

using namespace rockfall;

namespace
{

/// 0: cube, 1: plate with an axis of symmetry, 2: three different moments, tilted axes.
Block blockOf(int kind)
{
  const Quat tilt(Eigen::AngleAxisd(0.8, Vec3(1.0, -2.0, 0.5).normalized()));
  const Polyhedron shape = kind == 0 ? makeShape(Shape::Cube, 1.0)
    : kind == 1                      ? makeBox({ 0.93, 0.93, 0.47 })
                                     : makeBox({ 1, 2, 3 }).transformed(1.0, tilt, Vec3::Zero());
  return Block(shape, 2500.0, 1e10, 0.1);
}

void flyOnce(benchmark::State& run)
{
  const Block block = blockOf(int(run.range(0)));
  BlockState state;
  state.spin = Vec3(1.0, 2.0, 3.0);
  for (auto _ : run)
  {
    state = fly(block, state, 0.0, 0.01);
    benchmark::DoNotOptimize(state);
  }
}

void askAgain(benchmark::State& run)
{
  const FreeRotation rotation(blockOf(int(run.range(0))), Vec3(1.0, 2.0, 3.0));
  double time = 0.0;
  for (auto _ : run)
  {
    time += 0.01;
    benchmark::DoNotOptimize(rotation.after(time));
  }
}

} // namespace

BENCHMARK(flyOnce)->DenseRange(0, 2);
BENCHMARK(askAgain)->DenseRange(0, 2);
BENCHMARK_MAIN();
