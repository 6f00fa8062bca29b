#include "simulation/runNotes.h"

#include "base/text/numberText.h"
#include "rock/plausibleRocks.h"
#include "run/releaseHeights.h"
#include "shared/errorReport.h"
#include "simulation/jointFaces.h"
#include "simulation/progressText.h"
#include "statistics/lost.h"
#include "terrain/Obstacles.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace rockfall::filters
{

std::string statusOf(const LiveRun& live)
{
  const Ensemble& ensemble = *live.run().ensemble;
  const std::string units = ensemble.parameters().rockRockContact ? "iterations" : "trajectories";
  if (!live.over())
  {
    return (live.stopped() ? "stopping: " : "running: ") +
      progressText(live.share(), ensemble.size(), units, live.elapsed());
  }
  const std::int64_t made = live.trajectories() / ensemble.trajectoriesPerUnit();
  const std::string total = countText(ensemble.size()) + " " + units;
  return made < ensemble.size() ? "stopped by its user after " + countText(made) + " of " + total +
      "; Run Again makes all of them"
                                : "finished: " + total;
}

std::vector<std::string> inputNotes(vtkFieldData* terrain, vtkFieldData* rocks)
{
  std::vector<std::string> notes = notesOf(terrain);
  for (std::string& note : notesOf(rocks))
  {
    if (std::ranges::find(notes, note) == notes.end())
    {
      notes.push_back(std::move(note));
    }
  }
  return notes;
}

namespace
{

void noteApart(std::span<const Rock> rocks, std::vector<std::string>& notes)
{
  const std::int64_t joined = countFaceOnFace(rocks);
  if (joined > 0)
  {
    notes.push_back("RockRockContact is off: each of the " + std::to_string(rocks.size()) +
      " blocks falls as if it were alone, through the others, though " + std::to_string(joined) +
      " of them lie face on face, as the blocks of a rock mass. " +
      "Switch it on for them to hit and push each other");
  }
}

void noteNewNets(const Terrain& terrain, std::vector<std::string>& notes)
{
  if (const Obstacles* obstacles = terrain.obstacles())
  {
    const std::vector<Barrier>& barriers = obstacles->structures().barriers;
    if (std::any_of(barriers.begin(), barriers.end(), isLoaded))
    {
      notes.emplace_back(
        "RockRockContact is off: barriers with residual or fill are new for each block. "
        "Switch it on for what they hold to load them");
    }
  }
}

void noteAlike(const Terrain& terrain, std::span<const Rock> rocks, int iterations,
  std::vector<std::string>& notes)
{
  const bool drawn = terrain.draws() ||
    std::any_of(
      rocks.begin(), rocks.end(), [](const Rock& rock) { return rock.uncertainty.any(); });
  if (iterations > 1 && !drawn)
  {
    notes.push_back("All " + std::to_string(iterations) +
      " iterations are alike: nothing of the slope or of the blocks is drawn. Give DEM to CFE Mesh "
      "a roughness or a deviation, or Rock Blocks an attitude law, for them to differ");
  }
}

} // namespace

std::vector<std::string> notesBefore(const Terrain& terrain, std::span<const Rock> rocks,
  std::span<const double> frequencies, const SimulationParameters& parameters)
{
  std::vector<std::string> notes;
  if (!parameters.rockRockContact)
  {
    noteApart(rocks, notes);
    noteNewNets(terrain, notes);
  }
  if (terrain.givesWay())
  {
    IdleProperties idle;
    const bool impulse = parameters.impactResolution == ImpactResolution::Impulse;
    idle.add("ImpactResolution", std::string(impulse ? "Impulse" : "Springs"),
      std::string("Springs"),
      "some of the ground gives way, by scars or by friction that hangs on slip, and springs "
      "resolve all impacts on such a slope");
    std::ranges::move(idle.notes(), std::back_inserter(notes));
  }
  askAfterRocks(rocks, frequencies, notes);
  askAfterHeights(terrain, rocks, notes);
  noteAlike(terrain, rocks, parameters.iterations, notes);
  return notes;
}

std::vector<std::string> brokenNotes(
  const BrokenRocks& broken, const SimulationParameters& parameters)
{
  const Fragmentation& law = parameters.fragmentation;
  if (!law.on || (broken.broken == 0 && parameters.endTime < kLeastRun))
  {
    return {};
  }
  const std::string of = std::to_string(broken.broken) + " of " + std::to_string(broken.released) +
    " rocks broke in impacts of " + numberText(law.energy) + " J/m³ or more";
  if (broken.broken == 0)
  {
    return { of + ": nothing differs from a run without Fragmentation" };
  }
  return { of + ", into " + std::to_string(broken.pieces) + " pieces in all; " +
    numberText(100.0 * broken.fines / broken.mass, 3) +
    " % of their mass is in pieces of less than LeastFragment (" + numberText(law.leastVolume) +
    " m³) and is not followed" };
}

namespace
{

void tellCounted(const CountedRocks& counted, std::int64_t of, const std::string& what,
  std::vector<std::string>& notes)
{
  if (counted.rocks > 0)
  {
    notes.push_back(std::to_string(counted.rocks) + " of " + std::to_string(of) + " rocks " + what);
  }
}

} // namespace

std::vector<std::string> unclosedNotes(const UnclosedBooks& books)
{
  std::vector<std::string> notes;
  const auto tell = [&](const CountedRocks& counted, const char* how, const char* what)
  {
    tellCounted(counted, books.rocks,
      std::string(how) + " nowhere than " + numberText(100.0 * UnclosedBooks::kTold) +
        " % of what they had (" + what + "; give a smaller TimeStep",
      notes);
  };
  tell(books.gained, "got more energy from",
    "EnergyNumerical, or losses on the slope, below 0): they are too fast");
  tell(books.lost, "lost more energy to", "EnergyNumerical above 0): they stop too soon");
  return notes;
}

std::vector<std::string> passedNotes(const PassedBarriers& barriers)
{
  std::vector<std::string> notes;
  tellCounted(barriers.passed, barriers.rocks,
    "went over a barrier (Outcome 6 of the structures): it is too low for them", notes);
  tellCounted(barriers.struck, barriers.rocks,
    "struck a barrier with a part only, above it or beyond its end, and went on with all their "
    "energy (Outcome 5 of the structures): it is too low or too short for them",
    notes);
  return notes;
}

std::vector<std::string> pushedNotes(const Ensemble& ensemble, const PushedApart& pushed)
{
  if (pushed.rocks == 0)
  {
    return {};
  }
  const int iterations = ensemble.parameters().iterations;
  return { "PushRocksApart moved " + std::string(ensemble.pushesAnew() ? "up to " : "") +
    std::to_string(pushed.rocks) + " of " + std::to_string(ensemble.trajectoriesPerUnit()) +
    " blocks, by up to " + numberText(pushed.farthest, 4) + " m, in " +
    std::to_string(pushed.iterations) + " of " + std::to_string(iterations) + " iterations" };
}

} // namespace rockfall::filters
