#include "vtkRockfallSimulation.h"

#include "base/version.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/ranks.h"
#include "shared/streamingPieces.h"
#include "shared/withAbort.h"
#include "simulation/currentRun.h"
#include "simulation/runInputs.h"

#include "vtkAlgorithmOutput.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <vector>

vtkStandardNewMacro(vtkRockfallSimulation);

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;
using rockfall::filters::KeptRun;
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

} // namespace

/// An error that was reported. Until something changes it is not reported again: an animation asks
/// for every one of its times.
struct vtkRockfallSimulation::Failure
{
  vtkMTimeType filter = 0;
  Stamp terrain, rocks;
  std::string message;
};

//------------------------------------------------------------------------------
vtkRockfallSimulation::vtkRockfallSimulation()
  : Current(std::make_unique<rockfall::filters::CurrentRun>(this))
  , Taken(std::make_unique<rockfall::filters::RunInputs>())
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
  this->Current->stop();
}

//------------------------------------------------------------------------------
void vtkRockfallSimulation::RunAgain()
{
  this->Current->forget();
  this->Modified();
}

//------------------------------------------------------------------------------
bool vtkRockfallSimulation::GetNeedsUpdate()
{
  const bool news = this->Current->hasNews();
  if (news)
  {
    this->Modified();
  }
  return news;
}

//------------------------------------------------------------------------------
int vtkRockfallSimulation::GetNumberOfRuns() const
{
  return this->Current->count();
}

//------------------------------------------------------------------------------
const char* vtkRockfallSimulation::GetStateHash() const
{
  return this->Failed ? "" : this->Current->stateHash();
}

//------------------------------------------------------------------------------
const char* vtkRockfallSimulation::GetProgramVersion()
{
  return rockfall::versionNumber();
}

//------------------------------------------------------------------------------
const char* vtkRockfallSimulation::GetRunStatus()
{
  return this->Current->status().c_str();
}

//------------------------------------------------------------------------------
int vtkRockfallSimulation::Fail(
  vtkPolyData* terrain, vtkPolyData* rocks, const std::string& message)
{
  // The last run is kept: a property that was mistyped and is put right must not cost it.
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
    this->Current->forget();
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
  this->Current->beginLook();
  std::unique_ptr<KeptRun> wanted = this->WantedRun(terrain, rocks);
  const std::string noMemory = wanted->noMemory();
  try
  {
    const rockfall::filters::HeardAbort heard(this);
    ranks.agree(this->Taken->problem());
    ranks.together([&] { this->CheckProperties(*wanted); }, noMemory);
    bool finished =
      this->Current->make(std::move(wanted), terrain, rocks, ranks, this->PrintProgress);
    KeptRun* run = this->Current->get();
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
            this->ShownIteration, this->Current->goesOn() ? 0.0 : time,
            [this](double) { return !this->CheckAbort(); }, shown);
          output->ShallowCopy(shown);
        }
      },
      noMemory);
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
    return this->Fail(terrain, rocks, rockfall::filters::reasonOf(noMemory));
  }
}
