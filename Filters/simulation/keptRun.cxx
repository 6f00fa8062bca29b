#include "simulation/keptRun.h"

#include "base/Mixer.h"
#include "base/errors.h"
#include "base/text/numberText.h"
#include "counts/lostRocks.h"
#include "gis/base/externalReferences.h"
#include "gis/layers/rockContacts.h"
#include "rock/statement.h"
#include "run/releaseChecks.h"
#include "shared/arrays.h"
#include "shared/errorReport.h"
#include "shared/inputContent.h"
#include "shared/rockFieldData.h"
#include "shared/slopeReference.h"
#include "shared/terrainFieldData.h"
#include "simulation/motion.h"
#include "simulation/runNotes.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

namespace rockfall::filters
{

namespace
{

/// Everything that decides what a run gives; the number of threads does not.
auto runKey(const SimulationParameters& p)
{
  return std::make_tuple(p.timeStep, p.endTime, p.outputInterval, p.gravity, p.normalPenalty,
    p.shearRatio, p.rigid, p.impactResolution, p.iterations, p.firstIteration, p.seed,
    p.rockRockContact, p.rockRestitution, p.rockFrictionAngle, p.rockCohesion, p.pushRocksApart,
    p.fragmentation.on, p.fragmentation.energy, p.fragmentation.fractalDimension,
    p.fragmentation.leastVolume, p.fragmentation.survival, p.fragmentation.loss,
    p.fragmentation.spread);
}

/// Keeps all samples.
class WholePaths : public TrajectoryStore
{
public:
  Kept kept(int) const override { return { Retention::Full, false }; }
};

/// The one rank that has cells of an input, or 0 if none has.
int rankOf(const Ranks& ranks, vtkPolyData* input, const char* name)
{
  const std::vector<int> has = ranks.gather(input->GetNumberOfCells() > 0 ? 1 : 0);
  if (std::count(has.begin(), has.end(), 1) > 1)
  {
    throw DataError("The " + std::string(name) + " input is spread over " +
      std::to_string(std::count(has.begin(), has.end(), 1)) +
      " ranks, it must be on one: use it as its source makes it");
  }
  return int(std::max_element(has.begin(), has.end()) - has.begin());
}

/// Blocks that a simulation before had let go cannot go on.
void tellGone(std::int64_t gone, std::int64_t others, std::vector<std::string>& notes)
{
  if (gone > 0 && others == 0)
  {
    throw DataError("All " + std::to_string(gone) +
      " blocks of the Rocks input had left the slope (State 3) when a simulation left them");
  }
  if (gone > 0)
  {
    notes.push_back(std::to_string(gone) + " of " + std::to_string(gone + others) +
      " blocks of the Rocks input had left the slope (State 3) and are left out");
  }
}

/// What readRocks takes in the place of cell arrays that are not there, as a note; empty if all
/// are.
std::string takenInstead(vtkPolyData* input)
{
  vtkFieldData* cells = input->GetCellData();
  const Rock rock;
  const std::set<std::int64_t> named = namedBlocks(input);
  // Of blocks that have fallen nothing more is drawn.
  const bool drawn = !cells->GetAbstractArray("State");
  const std::pair<const char*, std::string> instead[] = {
    { "BlockId", "all cells for one block" },
    { "Density", numberText(rock.density) + " kg/m³" },
    { "YoungModulus", numberText(rock.youngModulus) + " Pa" },
    { "PoissonRatio", "ν " + numberText(rock.poissonRatio) },
    { "Velocity", "no velocity" },
    { "AngularVelocity", "no spin" },
    { named.empty() ? "Material" : nullptr, "no material" },
    { "SourceId", "source 0" },
    { drawn ? "PositionDeviation" : nullptr, "no deviation of the place" },
    { drawn ? "AttitudeLaw" : nullptr, "the attitude as it is" },
    { drawn ? "VolumeLaw" : nullptr, "the volume as it is" },
  };
  std::string missing, taken;
  for (const auto& [name, what] : instead)
  {
    if (name && !cells->GetAbstractArray(name))
    {
      missing += (missing.empty() ? "" : ", ") + std::string(name);
      taken += (taken.empty() ? "" : ", ") + what;
    }
  }
  return missing.empty() ? ""
                         : "The Rocks input has no cell arrays " + missing + ": taken are " + taken;
}

/// Of rocks that bring names in field arrays: which of them have none there, as a note; empty if
/// all have.
/// Number of what is released: parts of one study have the same.
std::uint64_t contentOf(const RunFrame& frame)
{
  Mixer mixer;
  mixer.add(frame.origin);
  for (std::size_t k = 0; k < frame.rocks.size(); ++k)
  {
    const Rock& rock = frame.rocks[k];
    mixer.add(rock.blockId);
    mixer.add(frame.sourceIds[k]);
    mixer.add(rock.position);
    mixer.add(rock.density * rock.shape.integrals().volume);
  }
  return mixer.value();
}

std::string namesLost(vtkPolyData* input, std::span<const Rock> rocks)
{
  const std::set<std::int64_t> named = namedBlocks(input);
  if (named.empty() || input->GetCellData()->GetAbstractArray("Material"))
  {
    return "";
  }
  const auto lost = std::count_if(
    rocks.begin(), rocks.end(), [&](const Rock& rock) { return !named.contains(rock.blockId); });
  return lost == 0 ? ""
                   : "The field arrays NamedBlock, Material and SourceName of the Rocks input name "
                     "nothing of " +
      std::to_string(lost) + " of " + std::to_string(rocks.size()) +
      " blocks, as filters that append keep those of their first input only: they have no material "
      "and are of \"source\" and its number";
}

} // namespace

std::uint64_t KeptRun::contentOfRocks(vtkPolyData* rocksInput, const Ranks& ranks) const
{
  if (ranks.count() > 1)
  {
    return filters::rocksContent(rocksInput, {});
  }
  return parameters.rockRockContact && !contactFile.empty()
    ? filters::rocksContent(rocksInput, { "SourceName" })
    : filters::rocksContent(rocksInput, { "SourceName", "Material" });
}

bool KeptRun::hasPropertiesOf(const KeptRun& other) const
{
  return parts.retention == other.parts.retention && parts.impacts == other.parts.impacts &&
    contactFile == other.contactFile && contactSheet == other.contactSheet &&
    runKey(parameters) == runKey(other.parameters);
}

bool KeptRun::takesOver(
  const KeptRun& other, vtkPolyData* terrainInput, vtkPolyData* rocksInput, const Ranks& ranks)
{
  if (!this->hasPropertiesOf(other))
  {
    return false;
  }
  const bool sameTerrain = terrain == other.terrain, sameRocks = rocks == other.rocks;
  if ((!sameTerrain && terrainContent != filters::terrainContent(terrainInput->GetFieldData())) ||
    (!sameRocks && rocksContent != this->contentOfRocks(rocksInput, ranks)))
  {
    return false;
  }
  if (!sameTerrain && terrainInput != rocksInput && terrainInput->GetNumberOfCells() > 0)
  {
    readTerrain(terrainInput); // what is shown must be the slope
  }
  if (!sameRocks && ranks.count() == 1)
  {
    std::vector<ReleasedRock> released = readRocks(rocksInput, frame.origin);
    std::erase_if(released,
      [](const ReleasedRock& rock) { return rock.state == int(MotionState::LeftDomain); });
    for (std::size_t k = 0; k < released.size(); ++k)
    {
      frame.rocks[k].material = released[k].rock.material;
      frame.sourceNames[k] = released[k].sourceName;
    }
    renameSources(frame, summary);
  }
  terrain = other.terrain;
  rocks = other.rocks;
  const auto told = std::pair(idle, ofInputs);
  if (ranks.count() == 1)
  {
    ofInputs = inputNotes(terrainInput->GetFieldData(), rocksInput->GetFieldData());
  }
  for (const std::string& note : other.idle)
  {
    if (other.printNotes && ranks.rank() == 0 && std::ranges::find(idle, note) == idle.end())
    {
      showNote(note);
    }
  }
  idle = other.idle;
  if (told != std::pair(idle, ofInputs))
  {
    this->writeNotes();
  }
  return true;
}

bool KeptRun::wholeFits() const
{
  return double(frame.rocks.size()) * (parameters.endTime / parameters.outputInterval + 2.0) < 2e6;
}

void KeptRun::dropInputs()
{
  ensemble.reset();
  ground->Initialize();
  frame = {};
  slope = {};
}

std::string KeptRun::noMemory() const
{
  return "The results do not fit in memory: Iterations is " +
    std::to_string(parameters.iterations) +
    "; fewer of them, a longer OutputInterval or a TrajectoryOutput that keeps less take less";
}

void KeptRun::prepare(vtkPolyData* terrainInput, vtkPolyData* rocksInput, const Ranks& ranks)
{
  terrainContent = filters::terrainContent(terrainInput->GetFieldData());
  rocksContent = this->contentOfRocks(rocksInput, ranks);
  const bool brought = terrainInput == rocksInput; // the rocks brought it
  ranks.together(
    [&]
    {
      if (brought && rocksInput->GetNumberOfCells() > 0 && !hasTerrain(rocksInput->GetFieldData()))
      {
        throw DataError(slopeKey(rocksInput->GetFieldData())
            ? "The Rocks refer to a slope that is not here, as rocks of a file do: connect the "
              "slope "
              "to the simulation as Terrain"
            : "The Terrain input is missing, and the Rocks did not bring one: connect the "
              "slope to the simulation or to the source of the rocks");
      }
    },
    this->noMemory());
  // Wherever they are; nowhere is the first rank's business.
  const int terrainRank = rankOf(ranks, terrainInput, "Terrain");
  const int rocksRank = rankOf(ranks, rocksInput, "Rocks");
  std::optional<Terrain> read;
  ranks.together(
    [&]
    {
      if (ranks.rank() == terrainRank)
      {
        read = readTerrain(terrainInput, !brought);
      }
    },
    this->noMemory());
  vtkNew<vtkPolyData> bare, released;
  if (ranks.rank() == terrainRank)
  {
    // Without the triangles.
    const vtkSmartPointer<vtkFieldData> fields = slopeOf(terrainInput->GetFieldData());
    bare->GetFieldData()->ShallowCopy(fields ? fields.Get() : terrainInput->GetFieldData());
    keepNotes(notesOf(terrainInput->GetFieldData()), bare->GetFieldData());
  }
  if (ranks.rank() == rocksRank)
  {
    released->ShallowCopy(rocksInput);
    dropTerrain(released->GetFieldData()); // it has a way of its own
  }
  ranks.broadcast(bare, terrainRank);
  ranks.broadcast(released, rocksRank);
  ofInputs = inputNotes(bare->GetFieldData(), released->GetFieldData());
  copyCoordinateSystem(bare->GetFieldData(), coordinates);
  referToSlope(bare->GetFieldData(), ground);
  ranks.together(
    [&]
    {
      slope = read ? std::move(*read) : readTerrain(bare, false);
      checkSameCrs(released->GetFieldData(), "The Rocks are", bare->GetFieldData());
      frame.origin = slope.geometry().origin();
      frame.gravity = parameters.gravity;
      frame.breaking = parameters.fragmentation.on;
      frame.slope = &slope;
      frame.parameters = &parameters;
      std::int64_t gone = 0;
      for (ReleasedRock& rock : readRocks(released, frame.origin))
      {
        if (rock.state == int(MotionState::LeftDomain))
        {
          ++gone;
          continue;
        }
        rock.rock.validate(); // with its own names, before anything is computed of it
        // Mid-impact a rock may be deep in the springs.
        setOntoSlope(slope, rock.rock, rock.state >= 0 ? 0.5 * rock.rock.shape.radius() : 0.0);
        frame.rocks.push_back(std::move(rock.rock));
        frame.shapes.push_back(rock.shape);
        frame.sourceIds.push_back(rock.sourceId);
        frame.sourceNames.push_back(std::move(rock.sourceName));
        if (!std::isnan(rock.frequency)) // of all rocks or none
        {
          frame.frequencies.push_back(rock.frequency);
        }
      }
      tellGone(gone, std::int64_t(frame.rocks.size()), notes);
      for (const std::string& note : { takenInstead(released), namesLost(released, frame.rocks) })
      {
        if (!note.empty())
        {
          notes.push_back(note);
        }
      }
    },
    this->noMemory());
  if (parameters.rockRockContact && !contactFile.empty())
  {
    this->readContacts(ranks);
  }
  ranks.together([&] { ensemble = std::make_unique<Ensemble>(slope, frame.rocks, parameters); },
    this->noMemory());
  if (!this->wholeFits())
  {
    parts.wholeIteration = -1;
  }
}

void KeptRun::takeResults(RunSink& sink)
{
  sink.finish(*this);
  whole = std::move(sink.whole());
  const auto rocksOfIt = std::count_if(
    whole.begin(), whole.end(), [](const Trajectory& t) { return t.summary.piece == 0; });
  wholeIteration = rocksOfIt == std::ptrdiff_t(frame.rocks.size()) ? parts.wholeIteration : -1;
  stateHash = sink.stateHash();
  addArray<vtkStringArray>(summary->GetFieldData(), "StateHash")->InsertNextValue(stateHash);
  const LostRocks lost = lostOf(summary);
  std::vector<std::string> further = brokenNotes(sink.broken(), parameters);
  std::ranges::move(passedNotes(sink.passedBarriers()), std::back_inserter(further));
  std::ranges::move(doubtsOfRun(trajectories->GetFieldData()), std::back_inserter(further));
  const bool look = parameters.endTime < kLeastRun; // at the inputs: what it loses is not told
  tellLost(lost, summary->GetFieldData(), further, printNotes && !look);
  writeLost(lost, trajectories->GetFieldData());
  const std::vector<std::string> before = std::exchange(notes, notesOf(summary->GetFieldData()));
  notes.insert(notes.end(), before.begin(), before.end());
  this->writeNotes();
  this->describe();
}

void KeptRun::writeNotes()
{
  summary->GetFieldData()->RemoveArray("Notes");
  for (const auto* some : { &notes, &idle, &ofInputs })
  {
    keepNotes(*some, summary->GetFieldData());
  }
}

void KeptRun::tell(const std::vector<std::string>& further)
{
  notes.insert(notes.end(), further.begin(), further.end());
  if (printNotes)
  {
    std::ranges::for_each(further, showNote);
  }
}

void KeptRun::describe()
{
  for (vtkDataObject* output :
    { static_cast<vtkDataObject*>(trajectories), static_cast<vtkDataObject*>(impacts),
      static_cast<vtkDataObject*>(summary), static_cast<vtkDataObject*>(structures) })
  {
    copyCoordinateSystem(coordinates, output->GetFieldData());
  }
  // Maps and collectors need no other input, and files of trajectories no slope beside them.
  referToSlope(ground, trajectories->GetFieldData());
  std::string properties = statementOf(parameters);
  if (!frame.rocks.empty())
  {
    properties += "\n" + releaseLine(contentOf(frame), frame.rocks.front().blockId);
  }
  addArray<vtkStringArray>(trajectories->GetFieldData(), kRunProperties)
    ->InsertNextValue(properties);
  writeTiles(trajectories);
}

void KeptRun::readContacts(const Ranks& ranks)
{
  // The file need be there for the first rank only. It is taken apart, sent, and put together.
  vtkNew<vtkPolyData> table;
  const auto first = addArray<vtkStringArray>(table->GetFieldData(), "First");
  const auto second = addArray<vtkStringArray>(table->GetFieldData(), "Second");
  const auto values = addArray<vtkDoubleArray>(table->GetFieldData(), "Values", 3);
  ranks.together(
    [&]
    {
      if (ranks.rank() != 0)
      {
        return;
      }
      std::vector<std::string> materials;
      for (const Rock& rock : frame.rocks)
      {
        materials.push_back(rock.material);
      }
      const AllowReferences references(allowReferences);
      const std::vector<RockContactPair> pairs =
        readRockContacts(contactFile, parameters.rockCohesion, materials, contactSheet, &notes);
      for (const RockContactPair& pair : pairs)
      {
        first->InsertNextValue(pair.first);
        second->InsertNextValue(pair.second);
        values->InsertNextTuple3(
          pair.contact.restitution, pair.contact.frictionAngle, pair.contact.cohesion);
      }
    },
    this->noMemory());
  ranks.broadcast(table, 0);
  vtkFieldData* sent = table->GetFieldData();
  auto* one = vtkStringArray::SafeDownCast(sent->GetAbstractArray("First"));
  auto* other = vtkStringArray::SafeDownCast(sent->GetAbstractArray("Second"));
  vtkDataArray* numbers = sent->GetArray("Values");
  for (vtkIdType k = 0; k < numbers->GetNumberOfTuples(); ++k)
  {
    const double* v = numbers->GetTuple(k);
    parameters.rockContactPairs.push_back(
      { one->GetValue(k), other->GetValue(k), { v[0], v[1], v[2] } });
  }
}

bool KeptRun::show(int shown, double time, const Progress& progress, vtkPolyData* output)
{
  const int iteration = parameters.firstIteration + shown;
  const std::int64_t units = ensemble->unitsPerIteration();
  const EnsembleShare share{ shown * units, (shown + 1) * units, 1 };
  MomentSink moment(time, slope, parameters, frame.rocks);
  // A realisation is a value: an iteration that is not kept is simulated again, whole if its
  // samples fit, else only as far as it is looked at. Of a release nothing need be kept.
  if (wholeIteration != iteration && time > 0.0 && this->wholeFits())
  {
    WholePaths store;
    if (!ensemble->run(share, store, progress))
    {
      return false;
    }
    whole = store.take();
    wholeIteration = iteration;
  }
  if (wholeIteration == iteration)
  {
    for (const Trajectory& trajectory : whole)
    {
      moment.show(trajectory);
    }
  }
  else if (!ensemble->run(share, moment, progress, time))
  {
    return false;
  }
  writeRocks(frame, moment.rocks(), output);
  copyCoordinateSystem(coordinates, output->GetFieldData());
  return true;
}

} // namespace rockfall::filters
