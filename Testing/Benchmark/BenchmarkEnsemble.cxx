// What an ensemble costs beside its trajectories: cubes and icosahedra of 1 m³ down the rough
// bi-planar slope of BenchmarkRockfall, 20 s or until they rest, in many iterations. Compared are
//
//   blocks     what is made of a rock before it can move, alone
//   single     the engine alone: one trajectory after the other, thrown away
//   ensemble   Ensemble::run into a sink that keeps stopping points, on 1 and 2 threads
//
// in trajectories per second of processor time (user and system) and of wall time. On a machine
// that others use, too, the former says what the code costs; the latter only what was left over.
//
// Run: BenchmarkEnsemble [trajectories]

#include "block/Block.h"
#include "geometry/shapes.h"
#include "rock/retention.h"
#include "run/ensemble.h"
#include "run/stateHash.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>

#include <sys/resource.h>

using namespace rockfall;

namespace
{

constexpr int kNodes = 201;
constexpr int kRocks = 64;

Terrain roughSlope()
{
  GridGeometry g;
  g.columns = g.rows = kNodes;
  g.cellSize = 1.0;
  std::vector<double> heights(std::size_t(g.nodeCount()));
  for (int row = 0; row < kNodes; ++row)
  {
    for (int column = 0; column < kNodes; ++column)
    {
      heights[std::size_t(row) * kNodes + column] =
        column < 100 ? (100.0 - column) * std::tan(radians(30.0)) : 0.0;
    }
  }
  SurfaceMaterial m;
  m.restitution = 0.7;
  m.frictionAngle = radians(30.0);
  return Terrain(g, std::move(heights), m, Roughness{ 0.0, 0.1 });
}

std::vector<Rock> rocksOn(const Terrain& slope)
{
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<Rock> rocks(kRocks);
  for (int k = 0; k < kRocks; ++k)
  {
    const double x = 5.0 + 2.0 * u(random), y = 50.0 + 100.0 * u(random);
    rocks[k].blockId = k;
    rocks[k].shape = makeShape(k % 2 ? Shape::Cube : Shape::Icosahedron, 1.0);
    rocks[k].position = Vec3(x, y, slope.elevation(x, y) + 3.5);
    rocks[k].velocity = Vec3(1.0, u(random) - 0.5, 0.0);
    rocks[k].orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
  }
  return rocks;
}

class Ends : public TrajectorySink
{
public:
  Kept kept(int) const override { return { Retention::StoppingPoints }; }
  void consume(Trajectory&& t) override { hash.add(t.summary.hash); }
  StateHash hash;
};

struct Cost
{
  double processor = 0.0, wall = 0.0; ///< s
};

Cost costOf(const std::function<void()>& work)
{
  const auto processor = []
  {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
      1e-6 * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  };
  const double before = processor();
  const auto started = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
  return { processor() - before, took.count() };
}

} // namespace

int main(int argc, char** argv)
{
  const int wanted = argc > 1 ? std::atoi(argv[1]) : 1600;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const Terrain slope = roughSlope();
  const std::vector<Rock> rocks = rocksOn(slope);
  SimulationParameters p;
  p.normalPenalty = 1e9; // the paper's
  p.iterations = std::max(1, wanted / kRocks);
  p.endTime = 20.0;
  std::printf(
    "%-12s %8s %14s %12s %12s\n", "", "threads", "processor, s", "wall, s", "per proc. s");
  const auto print = [&](const char* name, int threads, const Cost& cost)
  {
    std::printf("%-12s %8d %14.2f %12.2f %12.1f\n", name, threads, cost.processor, cost.wall,
      double(kRocks) * p.iterations / cost.processor);
  };
  // Turn by turn, so that a change of the machine's mood meets all of them.
  for (int repetition = 0; repetition < 3; ++repetition)
  {
    p.threads = 1;
    const Ensemble one(slope, rocks, p);
    print("blocks", 1,
      costOf(
        [&]
        {
          double mass = 0.0;
          for (std::int64_t n = 0; n < one.size(); ++n)
          {
            const Rock& rock = rocks[std::size_t(n) % rocks.size()];
            mass += Block(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio).mass();
          }
          if (!(mass > 0.0))
          {
            std::printf("no mass\n");
          }
        }));
    StateHash hash;
    print("single", 1,
      costOf(
        [&]
        {
          for (std::int64_t n = 0; n < one.size(); ++n)
          {
            hash.add(one.simulate(n).front().summary.hash);
          }
        }));
    for (int threads : { 1, 2 })
    {
      p.threads = threads;
      const Ensemble ensemble(slope, rocks, p);
      Ends sink;
      print("ensemble", threads, costOf([&] { ensemble.run(ensemble.whole(), sink); }));
      if (sink.hash.value() != hash.value())
      {
        std::printf("the hashes differ\n");
        return 1;
      }
    }
  }
  return 0;
}
