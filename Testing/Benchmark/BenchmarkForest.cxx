// What a forest costs: icosahedra and cubes of 0.5 m³ down 500 m of 35° and out onto the level, on
// 1 km² of 2 m cells, with no trees, 10³ and 10⁵. The stems stand
//
//   spread    evenly over the whole site
//   beside    10³ of them spread over the slope, all others on the level beyond the rocks' reach:
//             what the mere number costs, for the rocks meet the same stems as with 10³
//   crowded   in one hectare of the level, but for those 10³: an index of equal cells is at its
//   worst
//
// and are read from a CSV layer. Times are of the processor (user and system), memory is what the
// heap holds more than before.
//
// Run: BenchmarkForest [iterations]

#include "geometry/shapes.h"
#include "gis/layers/structureLayers.h"
#include "rock/retention.h"
#include "run/ensemble.h"
#include "run/stateHash.h"
#include "terrain/Obstacles.h"
#include "terrain/Terrain.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>

#include <malloc.h>
#include <sys/resource.h>

using namespace rockfall;

namespace
{

constexpr int kNodes = 501, kRocks = 64, kFew = 1000, kMany = 100000;
constexpr double kCell = 2.0, kSize = kCell * (kNodes - 1), kFoot = 500.0; // m

Terrain hillside()
{
  GridGeometry g;
  g.columns = g.rows = kNodes;
  g.cellSize = kCell;
  std::vector<double> heights;
  for (int k = 0; k < kNodes * kNodes; ++k)
  {
    heights.push_back(std::max(0.0, kFoot - kCell * (k % kNodes)) * std::tan(radians(35.0)));
  }
  SurfaceMaterial m;
  m.restitution = 0.7;
  m.frictionAngle = radians(30.0);
  return Terrain(g, std::move(heights), m, Roughness{ 0.0, 0.2 });
}

std::vector<Rock> rocksOn(const Terrain& slope)
{
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<Rock> rocks(kRocks);
  for (int k = 0; k < kRocks; ++k)
  {
    const double x = 20.0 + 10.0 * u(random), y = 200.0 + 600.0 * u(random);
    rocks[k].blockId = k;
    rocks[k].shape = makeShape(k % 2 ? Shape::Cube : Shape::Icosahedron, 0.5);
    rocks[k].position = Vec3(x, y, slope.elevation(x, y) + 3.5);
    rocks[k].velocity = Vec3(1.0, u(random) - 0.5, 0.0);
    rocks[k].orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
  }
  return rocks;
}

std::string writeTrees(const std::string& how, int count)
{
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const std::string path = "forest.csv";
  std::ofstream file(path);
  file.imbue(std::locale::classic());
  file.precision(8);
  file << "x,y,diameter,height\n";
  for (int k = 0; k < count; ++k)
  {
    double x = 40.0 + ((how == "spread" ? kSize : kFoot) - 40.0) * u(random);
    double y = kSize * u(random);
    if (how != "spread" && k >= kFew)
    {
      const double room = how == "crowded" ? 100.0 : kSize;
      x = kSize - std::min(room, 150.0) * u(random);
      y = room * u(random);
    }
    file << x << ',' << y << ',' << 20.0 + 30.0 * u(random) << ",22\n";
  }
  return path;
}

double processorTime()
{
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
    1e-6 * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

double heapMegabytes()
{
  const auto info = mallinfo2();
  return 1e-6 * double(info.uordblks + info.hblkhd);
}

class Ends : public TrajectorySink
{
public:
  Kept kept(int) const override { return { Retention::StoppingPoints }; }
  void consume(Trajectory&& t) override
  {
    hash.add(t.summary.hash);
    runOut += t.summary.runOut;
    steps += t.summary.contactSteps;
    moving += t.summary.fate == Fate::Moving;
  }
  StateHash hash;
  double runOut = 0.0;
  std::int64_t steps = 0, moving = 0;
};

} // namespace

int main(int argc, char** argv)
{
  SimulationParameters p;
  p.normalPenalty = 1e9; // the paper's
  p.iterations = argc > 1 ? std::max(1, std::atoi(argv[1])) : 4;
  p.endTime = 40.0;
  p.threads = 1;
  const double runs = double(kRocks) * p.iterations;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::printf("%-10s %8s %9s %10s %10s %12s %11s %12s %10s %8s\n", "", "trees", "read, s",
    "set up, s", "memory, MB", "trajectories", "ms for one", "steps of it", "run-out, m", "moving");
  std::uint64_t few = 0;
  const std::pair<const char*, int> cases[] = { { "none", 0 }, { "few", kFew }, { "beside", kMany },
    { "crowded", kMany }, { "spread", kMany } };
  for (const auto& [how, count] : cases)
  {
    Terrain slope = hillside();
    const std::vector<Rock> rocks = rocksOn(slope);
    double read = 0.0, built = 0.0, memory = 0.0;
    if (count > 0)
    {
      StructureFiles files;
      files.trees = writeTrees(how, count);
      files.treesBreak = true;
      std::vector<std::string> notes;
      const double before = heapMegabytes();
      double at = processorTime();
      Structures trees = readStructures(files, slope, notes);
      read = processorTime() - at;
      at = processorTime();
      slope.setStructures(std::move(trees));
      built = processorTime() - at;
      memory = heapMegabytes() - before;
    }
    const Ensemble ensemble(slope, rocks, p);
    Ends sink;
    const double at = processorTime();
    ensemble.run(ensemble.whole(), sink);
    const double took = processorTime() - at;
    std::printf("%-10s %8d %9.3f %10.3f %10.1f %12.0f %11.2f %12.0f %10.1f %8d\n", how, count, read,
      built, memory, runs, 1e3 * took / runs, double(sink.steps) / runs, sink.runOut / runs,
      int(sink.moving));
    few = count == kFew ? sink.hash.value() : few;
    if (count == kMany && std::string(how) != "spread" && sink.hash.value() != few)
    {
      std::printf("trees out of reach change the result\n");
      return 1;
    }
  }
  return 0;
}
