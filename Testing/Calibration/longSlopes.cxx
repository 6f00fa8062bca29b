// What a ground makes of rocks on straight slopes with a flat foot of the same ground: speeds and
// jumps on 450 m of 35°, and run-outs by size under 100 m of drop. Field surveys: speeds below
// 30 m/s, jumps of some metres, and blocks of 10 m³ 1.1 to 1.6 times as far as those of 0.1 m³.
//
//   longSlopes [--ground NAME] [--set name=value]… [--iterations N] [--seed N]
//
// EOTA 111 rocks with attitudes drawn, let go 2 m over the ground at 1.5 m/s. The ground is the
// preset Meadow where nothing else is said.

#include "GroundSettings.h"
#include "Summaries.h"

#include "geometry/shapes.h"
#include "run/ensemble.h"
#include "statistics/sample.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace rockfall;
using namespace rockfall::calibration;

namespace
{

constexpr double kNode = 2.0;     // m
constexpr double kWidth = 120.0;  // m
constexpr double kTop = 8.0;      // of the slope above the release, m
constexpr double kBeyond = 500.0; // of flat ground, m

Terrain makeSlope(const GroundSettings& s, double angle, double drop)
{
  const double foot = kNode * std::round((kTop + drop / std::tan(angle)) / kNode);
  GridGeometry grid;
  grid.columns = int((foot + kBeyond) / kNode) + 1;
  grid.rows = int(kWidth / kNode) + 1;
  grid.cellSize = kNode;
  std::vector<double> heights;
  for (int row = 0; row < grid.rows; ++row)
  {
    for (int column = 0; column < grid.columns; ++column)
    {
      heights.push_back(std::max(0.0, foot - kNode * column) * std::tan(angle));
    }
  }
  return makeTerrain(s, grid, std::move(heights));
}

struct Figures
{
  double speed, jump, runOut, reach, reachFarthest, longest; // m/s, m, m, degrees, degrees, s
};

Figures measure(const GroundSettings& s, double angle, double drop, double volume)
{
  const Terrain terrain = makeSlope(s, radians(angle), drop);
  Rock rock;
  rock.shape = makeShape(Shape::Eota111, volume);
  rock.density = s.density;
  rock.position = Vec3(kTop, 0.5 * kWidth, terrain.elevation(kTop, 0.5 * kWidth) + 2.0);
  rock.velocity = Vec3(1.5, 0.0, 0.0);
  rock.uncertainty.attitude = AttitudeLaw::Random;
  rock.blockId = 1;
  Summaries rocks;
  runEnsemble(terrain, std::vector<Rock>{ rock }, s.simulation, rocks);
  std::vector<double> speeds, jumps, runOuts, reach, times;
  for (const TrajectorySummary& t : rocks.all)
  {
    speeds.push_back(t.maxSpeed);
    jumps.push_back(t.maxHeightOverGround);
    runOuts.push_back(t.runOut);
    reach.push_back(degrees(std::atan2(t.start.z() - t.stop.z(), t.runOut)));
    times.push_back(t.endTime);
  }
  for (std::vector<double>* values : { &speeds, &jumps, &runOuts, &reach, &times })
  {
    std::ranges::sort(*values);
  }
  return { quantile(speeds, 0.95), quantile(jumps, 0.95), quantile(runOuts, 0.5),
    quantile(reach, 0.5), quantile(reach, 0.01), times.back() };
}

int run(int count, char** words)
{
  GroundSettings defaults;
  defaults.setGround("meadow");
  defaults.simulation.normalPenalty = 0.0; // by mass, as in the panel
  defaults.simulation.iterations = 200;
  defaults.simulation.endTime = 300.0;
  defaults.simulation.outputInterval = 0.5;
  const GroundSettings s = parseArguments(count, words, defaults, {}, false).settings;
  std::printf("%6s %6s %7s | %10s %9s | %8s | %8s %8s | %7s\n", "slope", "drop m", "m3",
    "speed 95 %", "jump 95 %", "run-out", "reach", "1 %", "last s");
  const auto print = [&](double angle, double drop, double volume)
  {
    const Figures f = measure(s, angle, drop, volume);
    std::printf("%6.0f %6.0f %7.2f | %10.1f %9.1f | %8.1f | %8.1f %8.1f | %7.1f\n", angle, drop,
      volume, f.speed, f.jump, f.runOut, f.reach, f.reachFarthest, f.longest);
    return f.runOut;
  };
  print(35.0, 258.0, 1.0);
  const double small = print(35.0, 100.0, 0.1), large = print(35.0, 100.0, 10.0);
  std::printf("run-out of 10 m3 over that of 0.1 m3: %.3f\n", large / small);
  return 0;
}

} // namespace

int main(int count, char** words)
{
  return runProgram(run, count, words);
}
