// Runs of a field test with single rocks against where the rocks stopped, for one set of
// parameters: per rock the mean run-out and its deviation, the CRPS, how many observed run-outs lie
// within the simulated quantiles of 5 and 95 %, and in which fifth of the simulated ones. The
// folder is that of Examples/validation/field_test.py.
//
//   calibrateTschamut FOLDER [--ground NAME] [--set name=value]… [--iterations N] [--seed N]
//     [--output runs.csv] [--stops stops.csv]
//
// The ground is the preset Meadow where nothing else is said.
//
// All of it twice: as simulated, and with run-outs beyond the tracked ground cut off at its edge.
// The tracked ground is the convex hull of releases and observed stops, widened by a cell of the
// folder's grid.

#include "GroundSettings.h"
#include "Summaries.h"
#include "fieldScores.h"
#include "fieldTables.h"
#include "runEnsemble.h"
#include "trackedGround.h"

#include "base/errors.h"
#include "gis/raster/raster.h"
#include "statistics/sample.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>

using namespace rockfall;
using namespace rockfall::calibration;

namespace
{

constexpr double kGap = 0.05;    // m, under the lowest vertex at the release
constexpr double kStarted = 1.0; // m; a rock that stops nearer to its release is no run

struct Run
{
  std::string id, block;
  Place start{}, stop{};    ///< Observed, m.
  double runOut = 0.0;      ///< Observed, m.
  std::vector<Place> stops; ///< Simulated, m.
};

struct Experiment
{
  Terrain terrain;
  double fileCell = 0.0;   ///< Of the folder's grid, m.
  std::vector<Rock> rocks; ///< One per run.
  std::vector<Run> runs;
};

double distance(const Place& a, const Place& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

/// The grid's nodes stand at its corner, which GDAL takes for the corner of a pixel.
Terrain readTerrain(const std::string& fileName, double fileCell, const GroundSettings& s)
{
  RasterSurface surface = readRaster(fileName, { s.cellSize });
  surface.geometry.xOrigin -= 0.5 * fileCell;
  surface.geometry.yOrigin -= 0.5 * fileCell;
  return makeTerrain(s, surface.geometry, std::move(surface.heights));
}

Experiment readExperiment(const std::string& folder, const GroundSettings& s)
{
  Experiment e;
  const std::string grid = folder + "/terrain.asc";
  e.fileCell = readRaster(grid).geometry.cellSize;
  e.terrain = readTerrain(grid, e.fileCell, s);
  const Vec3 origin = e.terrain.geometry().origin();
  const FieldTable blocks(folder + "/block_metadata.csv");
  std::map<std::string, Polyhedron> shapes;
  for (std::size_t k = 0; k < blocks.size(); ++k)
  {
    shapes[blocks.text(k, "block_id")] =
      makeCutBox(blocks.vector(k, "size_", "_m"), blocks.number(k, "mass_kg") / s.density);
  }
  const FieldTable stops(folder + "/observed_deposition.csv");
  std::map<std::string, std::size_t> stopOf;
  for (std::size_t k = 0; k < stops.size(); ++k)
  {
    stopOf[stops.text(k, "trajectory_id")] = k;
  }
  const FieldTable releases(folder + "/release_points.csv");
  for (std::size_t k = 0; k < releases.size(); ++k)
  {
    Run run;
    run.id = releases.text(k, "trajectory_id");
    run.block = releases.text(k, "block_id");
    const std::size_t at = stopOf.at(run.id);
    run.stop = { stops.number(at, "x_m") - origin.x(), stops.number(at, "y_m") - origin.y() };
    Rock rock;
    rock.blockId = std::int64_t(k) + 1;
    rock.shape = shapes.at(run.block);
    rock.density = s.density;
    rock.velocity = releases.vector(k, "v", "_mps");
    rock.uncertainty.attitude = AttitudeLaw::Random;
    rock.position = Vec3(releases.number(k, "x_m"), releases.number(k, "y_m"), 0.0) - origin;
    double lift = -1e9;
    for (const Vec3& v : rock.shape.vertices())
    {
      lift = std::max(
        lift, e.terrain.elevation(rock.position.x() + v.x(), rock.position.y() + v.y()) - v.z());
    }
    rock.position.z() = lift + kGap;
    run.start = { rock.position.x(), rock.position.y() };
    run.runOut = distance(run.start, run.stop);
    e.rocks.push_back(std::move(rock));
    e.runs.push_back(std::move(run));
  }
  return e;
}

/// Figures over some runs.
struct Figures
{
  int runs = 0, inside = 0;
  std::array<int, 5> fifths = {}; ///< In which fifth of the simulated ones the observed are.
  double observed = 0.0, simulated = 0.0, variance = 0.0, crps = 0.0, energyScore = 0.0,
         without = 0.0;

  void print(const char* name) const
  {
    const double n = runs;
    std::printf("%-14s %4d %9.1f %9.1f %+8.1f %%  %6.1f %6.2f %8.2f %6.2f %7.0f %%   ", name, runs,
      observed / n, simulated / n, 100.0 * (simulated / observed - 1.0), std::sqrt(variance / n),
      crps / n, without / n, energyScore / n, 100.0 * inside / n);
    for (const int count : fifths)
    {
      std::printf(" %3d", count);
    }
    std::printf("\n");
  }
};

/// Prints them per rock and in all, and a row per run into `table` if it is open.
void compare(const std::vector<Run>& runs, std::ofstream& table, const char* title)
{
  std::map<std::string, Figures> figures;
  for (const Run& run : runs)
  {
    std::vector<double> others, runOuts;
    for (const Run& other : runs)
    {
      if (&other != &run)
      {
        others.push_back(other.runOut);
      }
    }
    for (const Place& stop : run.stops)
    {
      runOuts.push_back(distance(run.start, stop));
    }
    const double rank = rankOf(runOuts, run.runOut), simulated = mean(runOuts);
    double variance = 0.0;
    for (const double r : runOuts)
    {
      variance += (r - simulated) * (r - simulated) / double(runOuts.size() - 1);
    }
    const double ownCrps = crps(runOuts, run.runOut), score = energyScore(run.stops, run.stop);
    for (const std::string& name : { run.block, std::string("~all") })
    {
      Figures& f = figures[name];
      ++f.runs;
      f.inside += rank >= 0.05 && rank <= 0.95;
      ++f.fifths[std::size_t(std::min(4.0, 5.0 * rank))];
      f.observed += run.runOut;
      f.simulated += simulated;
      f.variance += variance;
      f.crps += ownCrps;
      f.energyScore += score;
      f.without += crps(others, run.runOut);
    }
    if (table.is_open())
    {
      table << title << ',' << run.id << ',' << run.block << ',' << run.runOut << ',' << simulated
            << ',' << ownCrps << ',' << score << ',' << rank << '\n';
    }
  }
  std::printf("%s\n%-14s %4s %9s %9s %10s  %6s %6s %8s %6s %9s    %s\n", title, "rock", "runs",
    "observed", "simulated", "error", "dev.", "CRPS", "no model", "ES", "in 5-95", "runs by fifth");
  for (const auto& [name, f] : figures)
  {
    f.print(name == "~all" ? "all" : name.c_str());
  }
}

/// Gives the runs their simulated stops, and prints how rocks moved.
void sortStops(Experiment& e, const std::vector<TrajectorySummary>& all, double seconds)
{
  int left = 0, moving = 0, stood = 0;
  std::vector<double> speeds, times;
  // Rocks that did not start are left out, unless most did not: then the ground holds them.
  std::vector<std::array<int, 2>> starts(e.runs.size());
  for (const TrajectorySummary& t : all)
  {
    ++starts[std::size_t(t.rock)][t.runOut >= kStarted];
  }
  for (const TrajectorySummary& t : all)
  {
    const auto [stay, start] = starts[std::size_t(t.rock)];
    left += t.fate == Fate::LeftDomain;
    moving += t.fate == Fate::Moving;
    stood += t.runOut < kStarted;
    if (t.runOut >= kStarted || start < std::max(2, stay))
    {
      e.runs[std::size_t(t.rock)].stops.push_back({ t.stop.x(), t.stop.y() });
      speeds.push_back(t.maxSpeed);
      times.push_back(t.endTime);
    }
  }
  std::ranges::sort(speeds);
  std::ranges::sort(times);
  std::printf("greatest speed %.1f m/s mean, %.1f 95 %%; time to rest %.1f s median, %.1f 95 %%; "
              "left %d, moving %d, not started %d of %zu; %.1f s\n",
    mean(speeds), quantile(speeds, 0.95), quantile(times, 0.5), quantile(times, 0.95), left, moving,
    stood, all.size(), seconds);
}

/// Cuts run-outs off at the edge of the tracked ground; returns the share that goes beyond.
double keepToTracked(Experiment& e)
{
  std::vector<Place> places;
  for (const Run& run : e.runs)
  {
    places.push_back(run.start);
    places.push_back(run.stop);
  }
  const TrackedGround tracked(places, e.fileCell);
  int beyond = 0, all = 0;
  for (Run& run : e.runs)
  {
    for (Place& stop : run.stops)
    {
      ++all;
      beyond += !tracked.holds(stop);
      stop = tracked.cut(run.start, stop);
    }
  }
  return double(beyond) / double(all);
}

void writeStops(const std::string& fileName, const Experiment& e)
{
  if (fileName.empty())
  {
    return;
  }
  const Vec3 origin = e.terrain.geometry().origin();
  std::ofstream table(fileName);
  table << "Run,Block,ObservedRunOut,X,Y,RunOut\n";
  for (const Run& run : e.runs)
  {
    for (const Place& stop : run.stops)
    {
      table << run.id << ',' << run.block << ',' << run.runOut << ',' << stop[0] + origin.x() << ','
            << stop[1] + origin.y() << ',' << distance(run.start, stop) << '\n';
    }
  }
}

int run(int count, char** words)
{
  GroundSettings defaults;
  defaults.setGround("meadow");
  defaults.simulation.normalPenalty = 0.0; // by mass, as in the panel
  defaults.simulation.iterations = 80;
  defaults.simulation.endTime = 60.0;
  Arguments arguments = parseArguments(count, words, defaults, {});
  SimulationParameters& p = arguments.settings.simulation;
  p.outputInterval = p.endTime;
  Experiment e = readExperiment(arguments.folder, arguments.settings);
  const auto begin = std::chrono::steady_clock::now();
  Summaries stops;
  rockfall::testing::runEnsemble(e.terrain, e.rocks, p, stops);
  sortStops(
    e, stops.all, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  writeStops(arguments.stops, e);
  std::ofstream table;
  if (!arguments.output.empty())
  {
    table.open(arguments.output);
    table << "Scored,Run,Block,ObservedRunOut,MeanRunOut,CRPS,EnergyScore,Rank\n";
  }
  compare(e.runs, table, "as simulated");
  const double beyond = keepToTracked(e);
  compare(e.runs, table, "within the tracked ground");
  std::printf("%.1f %% of the rocks go beyond the tracked ground\n", 100.0 * beyond);
  return 0;
}

} // namespace

int main(int count, char** words)
{
  return runProgram(run, count, words);
}
