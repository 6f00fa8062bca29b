#include "keptRun.h"

#include "arrays.h"
#include "base/errors.h"
#include "gis/rockContacts.h"
#include "terrainFieldData.h"

#include "vtkDoubleArray.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <optional>
#include <tuple>

namespace rockfall::filters
{

namespace
{

/// Everything that decides what a run gives; the number of threads does not.
auto runKey(const SimulationParameters& p)
{
  return std::make_tuple(p.timeStep, p.endTime, p.outputInterval, p.gravity, p.normalPenalty,
    p.shearRatio, p.rigid, p.iterations, p.firstIteration, p.seed, p.rockRockContact,
    p.rockRestitution, p.rockFrictionAngle, p.rockCohesion, p.pushRocksApart);
}

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

} // namespace

bool KeptRun::isLike(const KeptRun& other) const
{
  return terrain == other.terrain && rocks == other.rocks &&
    parts.retention == other.parts.retention && parts.impacts == other.parts.impacts &&
    contactFile == other.contactFile && runKey(parameters) == runKey(other.parameters);
}

bool KeptRun::wholeFits() const
{
  return double(frame.rocks.size()) * (parameters.endTime / parameters.outputInterval + 2.0) < 2e6;
}

void KeptRun::dropInputs()
{
  ensemble.reset();
  frame = {};
  slope = {};
}

void KeptRun::prepare(vtkPolyData* terrainInput, vtkPolyData* rocksInput, const Ranks& ranks,
  const std::string& noMemory)
{
  // Wherever they are; nowhere is the first rank's business.
  const int terrainRank = rankOf(ranks, terrainInput, "Terrain");
  const int rocksRank = rankOf(ranks, rocksInput, "Rocks");
  std::optional<Terrain> read;
  ranks.together(
    [&]
    {
      if (ranks.rank() == terrainRank)
      {
        read = readTerrain(terrainInput);
      }
    },
    noMemory);
  vtkNew<vtkPolyData> bare, released;
  if (ranks.rank() == terrainRank)
  {
    bare->SetFieldData(terrainInput->GetFieldData()); // without the triangles
  }
  if (ranks.rank() == rocksRank)
  {
    released->ShallowCopy(rocksInput);
  }
  ranks.broadcast(bare, terrainRank);
  ranks.broadcast(released, rocksRank);
  copyCoordinateSystem(bare->GetFieldData(), coordinates);
  ranks.together(
    [&]
    {
      slope = read ? std::move(*read) : readTerrain(bare, false);
      checkSameCrs(released->GetFieldData(), "The Rocks are", bare->GetFieldData());
      frame.origin = slope.geometry().origin();
      frame.gravity = parameters.gravity;
      for (ReleasedRock& rock : readRocks(released, frame.origin))
      {
        frame.rocks.push_back(std::move(rock.rock));
        frame.shapes.push_back(rock.shape);
        frame.sourceIds.push_back(rock.sourceId);
        frame.sourceNames.push_back(std::move(rock.sourceName));
      }
    },
    noMemory);
  if (parameters.rockRockContact && !contactFile.empty())
  {
    this->readContacts(ranks, noMemory);
  }
  ranks.together(
    [&] { ensemble = std::make_unique<Ensemble>(slope, frame.rocks, parameters); }, noMemory);
}

void KeptRun::readContacts(const Ranks& ranks, const std::string& noMemory)
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
      for (const RockContactPair& pair :
        readRockContacts(contactFile, parameters.rockCohesion, materials))
      {
        first->InsertNextValue(pair.first);
        second->InsertNextValue(pair.second);
        values->InsertNextTuple3(
          pair.contact.restitution, pair.contact.frictionAngle, pair.contact.cohesion);
      }
    },
    noMemory);
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
  MomentSink moment(time);
  // A realisation is a value: an iteration that is not kept is simulated again, whole if its
  // samples fit, else only as far as it is looked at. Of a release nothing need be kept.
  if (wholeIteration != iteration && time > 0.0 && this->wholeFits())
  {
    TrajectoryStore store;
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
