#include "vtkRockfallSimulation.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "base/version.h"
#include "shared/arrays.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/streamingPieces.h"
#include "shared/terrainFieldData.h"
#include "shared/withAbort.h"
#include "simulation/keptRun.h"
#include "simulation/liveRun.h"
#include "simulation/progressText.h"
#include "simulation/runNotes.h"
#include "simulation/sharedRun.h"

#include "vtkAlgorithmOutput.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkWeakPointer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

vtkStandardNewMacro(vtkRockfallSimulation);

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;
using rockfall::filters::KeptRun;
using rockfall::filters::LiveRun;
using rockfall::filters::Ranks;
using rockfall::filters::Stamp;

enum InputPorts
{
  TERRAIN_INPUT = 0,
  ROCKS_INPUT = 1
};

enum OutputPorts
{
  ROCKS = 0,
  TRAJECTORIES = 1,
  IMPACTS = 2,
  SUMMARY = 3,
  STRUCTURES = 4,
};

/// More time steps than this are not listed, only their range is.
constexpr double mostTimeSteps = 1e6;

/// A run that is watched shows what it has after so long, s: a short one is then over.
constexpr double kAtOnce = 0.3;
/// Looks at a run take a fifth of the window's time, and come once a second at most.
constexpr double kLookInterval = 1.0, kLookShare = 4.0;

/// The time of the data that came last from here or, before any did, from where it gets them; NaN
/// if nothing has come yet.
double timeShown(vtkAlgorithmOutput* from)
{
  while (from)
  {
    vtkAlgorithm* producer = from->GetProducer();
    vtkInformation* info = producer->GetOutputInformation(from->GetIndex());
    vtkDataObject* data = info ? info->Get(vtkDataObject::DATA_OBJECT()) : nullptr;
    if (data && data->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP()))
    {
      return data->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP());
    }
    const bool more =
      producer->GetNumberOfInputPorts() > 0 && producer->GetNumberOfInputConnections(0) > 0;
    from = more ? producer->GetInputConnection(0, 0) : nullptr;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

} // namespace

/// An error that was reported. Until something changes it is not reported again: an animation asks
/// for every one of its times.
struct vtkRockfallSimulation::Failure
{
  vtkMTimeType filter = 0;
  Stamp terrain, rocks;
  std::string message;
};

struct vtkRockfallSimulation::Inputs
{
  rockfall::filters::Input terrain{ rockfall::filters::InputKind::Terrain };
  rockfall::filters::Input rocks{ rockfall::filters::InputKind::Rocks };
  /// Where rocks that move come from, and the time at which they were shown first.
  vtkWeakPointer<vtkAlgorithmOutput> rocksFrom;
  double rocksShown = 0.0;

  double timeOfRocks(
    vtkAlgorithmOutput* from, vtkInformation* rocks, vtkInformationVector* outputs);

  const std::string& problem() const
  {
    return this->terrain.problem().empty() ? this->rocks.problem() : this->terrain.problem();
  }
};

//------------------------------------------------------------------------------
/// The time at which rocks that move are asked for: as they are shown when this is first asked. An
/// animation that goes on, or a change of the run before, makes no run of another time.
double vtkRockfallSimulation::Inputs::timeOfRocks(
  vtkAlgorithmOutput* from, vtkInformation* info, vtkInformationVector* outputs)
{
  if (this->rocksFrom == from)
  {
    return this->rocksShown;
  }
  this->rocksFrom = from;
  double time = timeShown(from);
  for (int port = 0; std::isnan(time) && port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* asked = outputs->GetInformationObject(port);
    if (asked->Has(Pipeline::UPDATE_TIME_STEP()))
    {
      time = asked->Get(Pipeline::UPDATE_TIME_STEP());
    }
  }
  const double* range = info->Get(Pipeline::TIME_RANGE());
  this->rocksShown =
    std::isnan(time) ? range[0] : std::clamp(time, range[0], std::max(range[0], range[1]));
  if (this->rocksShown > range[0] && Ranks().rank() == 0)
  {
    rockfall::filters::showNote("Rockfall Simulation: the Rocks move, and are taken as they are "
                                "shown, at " +
      rockfall::numberText(this->rocksShown) + " s; Force Time before them sets another time");
  }
  return this->rocksShown;
}

//------------------------------------------------------------------------------
vtkRockfallSimulation::vtkRockfallSimulation()
  : Taken(std::make_unique<Inputs>())
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(5);
}

//------------------------------------------------------------------------------
vtkRockfallSimulation::~vtkRockfallSimulation() = default;

//------------------------------------------------------------------------------
int vtkRockfallSimulation::FillInputPortInformation(int port, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  if (port == TERRAIN_INPUT)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // rocks may bring it
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkRockfallSimulation::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == SUMMARY ? "vtkTable" : "vtkPolyData");
  return 1;
}

//------------------------------------------------------------------------------
int vtkRockfallSimulation::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  // Only the rocks move; the inputs' own times, if any, are none of ours.
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    outputVector->GetInformationObject(port)->Remove(Pipeline::TIME_STEPS());
    outputVector->GetInformationObject(port)->Remove(Pipeline::TIME_RANGE());
  }
  if (!(this->EndTime > 0.0 && std::isfinite(this->EndTime) && this->OutputInterval > 0.0))
  {
    return 1; // RequestData says what is wrong
  }
  vtkInformation* info = outputVector->GetInformationObject(ROCKS);
  const double range[2] = { 0.0, this->EndTime };
  info->Set(Pipeline::TIME_RANGE(), range, 2);
  if (this->EndTime / this->OutputInterval <= mostTimeSteps)
  {
    std::vector<double> steps;
    // An interval that ends at EndTime but for rounding is the last one.
    const double last = this->EndTime - 1e-6 * this->OutputInterval;
    for (int k = 0; k * this->OutputInterval < last; ++k)
    {
      steps.push_back(k * this->OutputInterval);
    }
    steps.push_back(this->EndTime);
    info->Set(Pipeline::TIME_STEPS(), steps.data(), int(steps.size()));
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkRockfallSimulation::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  // The slope and the release are those of one moment, whatever time is looked at.
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    vtkInformation* info = inputVector[port]->GetInformationObject(0);
    if (info && port == ROCKS_INPUT && info->Has(Pipeline::TIME_RANGE()))
    {
      info->Set(Pipeline::UPDATE_TIME_STEP(),
        this->Taken->timeOfRocks(this->GetInputConnection(port, 0), info, outputVector));
    }
    else if (info && info->Has(Pipeline::TIME_STEPS()))
    {
      info->Set(Pipeline::UPDATE_TIME_STEP(), info->Get(Pipeline::TIME_STEPS(), 0));
    }
    else if (info)
    {
      info->Remove(Pipeline::UPDATE_TIME_STEP());
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
bool vtkRockfallSimulation::Simulate(vtkPolyData* terrainInput, vtkPolyData* rocksInput)
{
  const Ranks ranks;
  auto run = std::make_unique<KeptRun>();
  run->terrain = Stamp(terrainInput);
  run->rocks = Stamp(rocksInput);
  this->TakeProperties(*run);
  ranks.together([&] { this->CheckProperties(*run); }, this->NoMemory());
  bool same = false;
  ranks.together([&]
    { same = this->Kept && this->Kept->takesOver(*run, terrainInput, rocksInput, ranks); },
    this->NoMemory());
  const std::vector<int> kept = ranks.gather(same ? 1 : 0);
  if (std::find(kept.begin(), kept.end(), 0) == kept.end())
  {
    this->StateHash = this->Kept->stateHash;
    return true;
  }
  if (this->Live && this->Live->run().isLike(*run))
  {
    return this->Follow();
  }
  this->Live.reset();
  this->Kept.reset();
  this->StateHash.clear();
  const int threads = ranks.threads();
  run->parameters.threads = this->NumberOfThreads > 0 ? this->NumberOfThreads : threads;
  run->prepare(terrainInput, rocksInput, ranks, this->NoMemory());
  if (run->wholeFits())
  {
    run->parts.wholeIteration = this->FirstIteration + this->ShownIteration;
  }
  const bool tells = this->PrintNotes && ranks.rank() == 0;
  if (!this->RockRockContact && tells)
  {
    rockfall::filters::tellApart(run->frame.rocks);
    rockfall::filters::tellNewNets(run->slope);
  }
  if (tells)
  {
    rockfall::filters::tellOdd(run->slope, run->frame.rocks, run->frame.frequencies);
    rockfall::filters::tellAlike(run->slope, run->frame.rocks, run->parameters.iterations);
  }
  // Rocks that are the same in all iterations are known before they run.
  const bool anew = run->ensemble->pushesAnew();
  if (!anew && tells)
  {
    rockfall::filters::tellPushed(*run->ensemble, run->ensemble->pushed(), ranks);
  }
  if (this->Watched && ranks.count() == 1)
  {
    ++this->NumberOfRuns;
    this->Live = std::make_unique<LiveRun>(std::move(run), this->NoMemory());
    this->Live->wait(kAtOnce);
    return this->Follow();
  }
  rockfall::filters::RunSink sink(run->frame, run->parts);
  rockfall::filters::ProgressReport report(this, run->ensemble->size(),
    this->RockRockContact ? "iterations" : "trajectories", ranks.rank() == 0, this->PrintProgress);
  ++this->NumberOfRuns;
  if (!rockfall::filters::runShared(
        *run->ensemble, run->parts, &sink, ranks, std::ref(report), this->NoMemory()))
  {
    return false;
  }
  if (anew && this->PrintNotes) // on all ranks
  {
    rockfall::filters::tellPushed(
      *run->ensemble, rockfall::filters::pushedOnAll(*run->ensemble, ranks), ranks);
  }
  if (ranks.rank() == 0)
  {
    run->takeResults(sink);
    this->StateHash = run->stateHash;
  }
  else
  {
    run->dropInputs(); // only the first rank shows anything
  }
  ranks.share(this->StateHash);
  run->stateHash = this->StateHash;
  report.finish();
  this->Kept = std::move(run);
  return true;
}

//------------------------------------------------------------------------------
bool vtkRockfallSimulation::Follow()
{
  if (!this->Live->over())
  {
    this->Live->look();
    this->Looked = this->Live->trajectories();
    return true;
  }
  // Filters that took a part of the run, in the same pass of a view perhaps, are out of date.
  this->Modified();
  const std::unique_ptr<LiveRun> live = std::move(this->Live);
  const std::string how = rockfall::filters::statusOf(*live);
  this->Kept = live->take();
  const KeptRun& run = *this->Kept;
  this->StateHash = run.stateHash;
  this->RunStatus = how;
  if (run.ensemble->pushesAnew())
  {
    rockfall::filters::tellPushed(*run.ensemble, run.ensemble->pushed(), Ranks());
  }
  if (run.summary->GetNumberOfRows() < run.ensemble->size() * run.ensemble->trajectoriesPerUnit())
  {
    rockfall::filters::showNote("Rockfall Simulation was " + how);
  }
  return true;
}

//------------------------------------------------------------------------------
void vtkRockfallSimulation::SetRocksConnection(vtkAlgorithmOutput* rocks)
{
  this->SetInputConnection(ROCKS_INPUT, rocks);
}

//------------------------------------------------------------------------------
void vtkRockfallSimulation::SetTerrainConnection(int, vtkAlgorithmOutput* terrain)
{
  this->SetInputConnection(TERRAIN_INPUT, terrain);
}

//------------------------------------------------------------------------------
void vtkRockfallSimulation::Stop()
{
  if (this->Live)
  {
    this->Live->stop();
  }
}

//------------------------------------------------------------------------------
void vtkRockfallSimulation::RunAgain()
{
  this->Forget();
  this->Modified();
}

//------------------------------------------------------------------------------
bool vtkRockfallSimulation::GetNeedsUpdate()
{
  using Clock = std::chrono::steady_clock;
  this->Watched = true;
  if (!this->Live)
  {
    return false;
  }
  const Clock::time_point now = Clock::now();
  if (this->Drawn < this->Asked)
  {
    this->Drawn = now; // the first time that the window is free again
  }
  const std::chrono::duration<double> cost = this->Drawn - this->Asked, since = now - this->Drawn;
  const bool news = since.count() > std::max(kLookInterval, kLookShare * cost.count()) &&
    this->Live->trajectories() > this->Looked;
  if (news || this->Live->over())
  {
    this->Modified();
    return true;
  }
  return false;
}

//------------------------------------------------------------------------------
const char* vtkRockfallSimulation::GetProgramVersion()
{
  return rockfall::versionNumber();
}

//------------------------------------------------------------------------------
const char* vtkRockfallSimulation::GetRunStatus()
{
  if (this->Live)
  {
    this->RunStatus = rockfall::filters::statusOf(*this->Live);
  }
  return this->RunStatus.c_str();
}

//------------------------------------------------------------------------------
void vtkRockfallSimulation::Forget()
{
  this->Live.reset();
  this->Kept.reset();
  this->StateHash.clear();
}

//------------------------------------------------------------------------------
int vtkRockfallSimulation::Fail(
  vtkPolyData* terrain, vtkPolyData* rocks, const std::string& message)
{
  // The last run is kept: a property that was mistyped and is put right must not cost it.
  this->StateHash.clear();
  this->Failed =
    std::make_unique<Failure>(Failure{ this->GetMTime(), Stamp(terrain), Stamp(rocks), message });
  // The others have the same message, and are silent.
  return Ranks().rank() == 0 ? rockfall::filters::fail(this, message) : 1;
}

//------------------------------------------------------------------------------
int vtkRockfallSimulation::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const Ranks ranks;
  const bool first = ranks.rank() == 0;
  if (ranks.count() == 1 && rockfall::filters::isFurtherPiece(outputVector))
  {
    return 1;
  }
  vtkPolyData* rocks = this->Taken->rocks.take(inputVector[ROCKS_INPUT]);
  if (!rocks)
  {
    return first ? rockfall::filters::fail(this, "The Rocks input is missing") : 1;
  }
  vtkPolyData* terrain = this->Taken->terrain.take(inputVector[TERRAIN_INPUT]);
  if (!terrain)
  {
    terrain = rocks; // may have brought it
  }
  const bool inherited = rockfall::filters::inheritFailure(terrain, this) ||
    rockfall::filters::inheritFailure(rocks, this);
  const bool again = this->Failed && this->Failed->filter == this->GetMTime() &&
    this->Failed->terrain == Stamp(terrain) && this->Failed->rocks == Stamp(rocks);
  // A decision of one rank alone would leave the others waiting.
  const std::vector<int> known = ranks.gather(inherited ? 2 : (again ? 1 : 0));
  if (*std::max_element(known.begin(), known.end()) == 2)
  {
    this->Forget();
    return 1;
  }
  if (*std::min_element(known.begin(), known.end()) == 1)
  {
    if (first)
    {
      rockfall::filters::leaveError(this, this->Failed->message);
    }
    return 1;
  }
  this->Failed.reset();
  this->Asked = std::chrono::steady_clock::now();
  try
  {
    const rockfall::filters::HeardAbort heard(this);
    ranks.agree(this->Taken->problem());
    bool finished = this->Simulate(terrain, rocks);
    KeptRun* run = this->Live ? &this->Live->run() : this->Kept.get();
    vtkInformation* info = outputVector->GetInformationObject(ROCKS);
    double time = 0.0;
    if (info->Has(Pipeline::UPDATE_TIME_STEP()))
    {
      time = std::clamp(info->Get(Pipeline::UPDATE_TIME_STEP()), 0.0, this->EndTime);
    }
    vtkPolyData* output = vtkPolyData::GetData(outputVector, ROCKS);
    ranks.together(
      [&]
      {
        if (finished && first)
        {
          vtkNew<vtkPolyData> shown;
          // While a run goes on its blocks stand where they are released.
          finished = run->show(
            this->ShownIteration, this->Live ? 0.0 : time,
            [this](double) { return !this->CheckAbort(); }, shown);
          output->ShallowCopy(shown);
        }
      },
      this->NoMemory());
    if (ranks.gather(finished ? 1 : 0).front() == 0)
    {
      return rockfall::filters::giveUp(this); // on the others as on the one that was told to
    }
    // On every rank, or those without would be asked again when the first one is not.
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    vtkPolyData::GetData(outputVector, TRAJECTORIES)->ShallowCopy(run->trajectories);
    vtkPolyData::GetData(outputVector, IMPACTS)->ShallowCopy(run->impacts);
    vtkPolyData::GetData(outputVector, STRUCTURES)->ShallowCopy(run->structures);
    vtkTable::GetData(outputVector, SUMMARY)->ShallowCopy(run->summary);
    return 1;
  }
  catch (const rockfall::Aborted&)
  {
    return rockfall::filters::giveUp(this); // on all ranks
  }
  catch (...)
  {
    return this->Fail(terrain, rocks, rockfall::filters::reasonOf(this->NoMemory()));
  }
}
