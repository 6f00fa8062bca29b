#include "vtkRockfallSimulation.h"

#include "base/errors.h"
#include "failure.h"
#include "pieces.h"
#include "runOutputs.h"
#include "simulation/ensemble.h"
#include "terrainFieldData.h"

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
#include <new>
#include <tuple>
#include <vector>

vtkStandardNewMacro(vtkRockfallSimulation);

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

enum OutputPorts
{
  ROCKS = 0,
  TRAJECTORIES = 1,
  IMPACTS = 2,
  SUMMARY = 3
};

/// More time steps than this are not listed, only their range is.
constexpr double mostTimeSteps = 1e6;

/// Everything that decides what a run gives; the number of threads does not.
auto runKey(const rockfall::SimulationParameters& p)
{
  return std::make_tuple(p.timeStep, p.endTime, p.outputInterval, p.gravity, p.normalPenalty,
    p.shearRatio, p.rigid, p.iterations, p.seed);
}

/// A data object as it is now.
struct Stamp
{
  vtkDataObject* object = nullptr;
  vtkMTimeType time = 0;

  Stamp() = default;
  explicit Stamp(vtkDataObject* data)
    : object(data)
    , time(data->GetMTime())
  {
  }
  bool operator==(const Stamp&) const = default;
};

} // namespace

/// A finished run, what it was made of, and its outputs that do not depend on time.
struct vtkRockfallSimulation::Cache
{
  rockfall::SimulationParameters parameters;
  Stamp terrain, rocks;
  std::unique_ptr<rockfall::TrajectoryStore> store; ///< What `run` looks at.
  rockfall::filters::FinishedRun run;
  vtkNew<vtkPolyData> trajectories, impacts;
  vtkNew<vtkTable> summary;
};

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
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(4);
}

//------------------------------------------------------------------------------
vtkRockfallSimulation::~vtkRockfallSimulation() = default;

//------------------------------------------------------------------------------
int vtkRockfallSimulation::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
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
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // The slope and the release are those of one moment, whatever time is looked at.
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    vtkInformation* info = inputVector[port]->GetInformationObject(0);
    if (info && info->Has(Pipeline::TIME_STEPS()))
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
  rockfall::SimulationParameters parameters;
  parameters.timeStep = this->TimeStep;
  parameters.endTime = this->EndTime;
  parameters.outputInterval = this->OutputInterval;
  parameters.gravity = this->Gravity;
  parameters.normalPenalty = this->NormalPenalty;
  parameters.shearRatio = this->ShearPenaltyRatio;
  parameters.rigid = this->Rigid;
  parameters.iterations = this->Iterations;
  if (this->Seed < 0)
  {
    throw rockfall::ParameterError(
      "Seed is " + std::to_string(this->Seed) + ", it must be at least 0");
  }
  parameters.seed = std::uint64_t(this->Seed);
  parameters.threads = this->NumberOfThreads;
  parameters.validate();
  if (this->RockRockContact)
  {
    throw rockfall::ParameterError(
      "RockRockContact is on, but collisions between rocks are not available in this version");
  }
  if (this->Kept && runKey(this->Kept->parameters) == runKey(parameters) &&
    this->Kept->terrain == Stamp(terrainInput) && this->Kept->rocks == Stamp(rocksInput))
  {
    return true;
  }

  this->Kept.reset();
  auto cache = std::make_unique<Cache>();
  cache->parameters = parameters;
  cache->terrain = Stamp(terrainInput);
  cache->rocks = Stamp(rocksInput);
  const rockfall::Terrain terrain = rockfall::filters::readTerrain(terrainInput);
  rockfall::filters::FinishedRun& run = cache->run;
  run.origin = terrain.geometry().origin();
  run.gravity = parameters.gravity;
  run.rocks = rockfall::filters::readRocks(rocksInput, run.origin);

  std::vector<rockfall::Rock> rocks;
  for (const rockfall::filters::ReleasedRock& released : run.rocks)
  {
    rocks.push_back(released.rock);
  }
  cache->store =
    std::make_unique<rockfall::TrajectoryStore>(int(rocks.size()), parameters.iterations);
  ++this->NumberOfRuns;
  const bool finished = rockfall::runEnsemble(terrain, rocks, parameters, *cache->store,
    [this](double share)
    {
      this->UpdateProgress(share);
      return !this->CheckAbort();
    });
  if (!finished)
  {
    return false;
  }
  run.trajectories = cache->store->trajectories();
  rockfall::filters::writeTrajectories(run, cache->trajectories);
  rockfall::filters::writeImpacts(run, cache->impacts);
  rockfall::filters::writeSummaries(run, cache->summary);
  for (vtkDataObject* output : { static_cast<vtkDataObject*>(cache->trajectories),
         static_cast<vtkDataObject*>(cache->impacts), static_cast<vtkDataObject*>(cache->summary) })
  {
    rockfall::filters::copyCoordinateSystem(terrainInput->GetFieldData(), output->GetFieldData());
  }
  this->Kept = std::move(cache);
  return true;
}

//------------------------------------------------------------------------------
int vtkRockfallSimulation::Fail(
  vtkPolyData* terrain, vtkPolyData* rocks, const std::string& message)
{
  this->Failed =
    std::make_unique<Failure>(Failure{ this->GetMTime(), Stamp(terrain), Stamp(rocks), message });
  return rockfall::filters::fail(this, message);
}

//------------------------------------------------------------------------------
int vtkRockfallSimulation::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (rockfall::filters::isFurtherPiece(outputVector))
  {
    return 1;
  }
  vtkPolyData* terrain = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* rocks = vtkPolyData::GetData(inputVector[1]);
  if (!terrain || !rocks)
  {
    return rockfall::filters::fail(
      this, std::string(terrain ? "The Rocks" : "The Terrain") + " input is missing");
  }
  if (rockfall::filters::inheritFailure(terrain, this) ||
    rockfall::filters::inheritFailure(rocks, this))
  {
    return 1;
  }
  if (this->Failed && this->Failed->filter == this->GetMTime() &&
    this->Failed->terrain == Stamp(terrain) && this->Failed->rocks == Stamp(rocks))
  {
    rockfall::filters::leaveError(this, this->Failed->message);
    return 1;
  }
  this->Failed.reset();
  try
  {
    if (!this->Simulate(terrain, rocks))
    {
      return 1; // aborted: the outputs stay empty
    }
    if (this->ShownIteration < 0 || this->ShownIteration >= this->Iterations)
    {
      throw rockfall::ParameterError("ShownIteration is " + std::to_string(this->ShownIteration) +
        ", it must be 0 to " + std::to_string(this->Iterations - 1));
    }
    vtkInformation* info = outputVector->GetInformationObject(ROCKS);
    double time = 0.0;
    if (info->Has(Pipeline::UPDATE_TIME_STEP()))
    {
      time = std::clamp(info->Get(Pipeline::UPDATE_TIME_STEP()), 0.0, this->EndTime);
    }
    vtkNew<vtkPolyData> shown;
    rockfall::filters::writeRocksAt(this->Kept->run, this->ShownIteration, time, shown);
    rockfall::filters::copyCoordinateSystem(terrain->GetFieldData(), shown->GetFieldData());
    vtkPolyData* output = vtkPolyData::GetData(outputVector, ROCKS);
    output->ShallowCopy(shown);
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    vtkPolyData::GetData(outputVector, TRAJECTORIES)->ShallowCopy(this->Kept->trajectories);
    vtkPolyData::GetData(outputVector, IMPACTS)->ShallowCopy(this->Kept->impacts);
    vtkTable::GetData(outputVector, SUMMARY)->ShallowCopy(this->Kept->summary);
    return 1;
  }
  catch (const rockfall::Error& error)
  {
    return this->Fail(terrain, rocks, error.what());
  }
  catch (const std::bad_alloc&)
  {
    return this->Fail(terrain, rocks,
      "The results do not fit in memory: Iterations is " + std::to_string(this->Iterations) +
        "; fewer of them or a longer OutputInterval take less");
  }
}

//------------------------------------------------------------------------------
void vtkRockfallSimulation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TimeStep: " << this->TimeStep << "\n";
  os << indent << "EndTime: " << this->EndTime << "\n";
  os << indent << "OutputInterval: " << this->OutputInterval << "\n";
  os << indent << "Gravity: " << this->Gravity << "\n";
  os << indent << "NormalPenalty: " << this->NormalPenalty << "\n";
  os << indent << "ShearPenaltyRatio: " << this->ShearPenaltyRatio << "\n";
  os << indent << "Iterations: " << this->Iterations << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "RockRockContact: " << this->RockRockContact << "\n";
  os << indent << "Rigid: " << this->Rigid << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "ShownIteration: " << this->ShownIteration << "\n";
  os << indent << "NumberOfRuns: " << this->NumberOfRuns << "\n";
  os << indent << "Kept: " << (this->Kept ? "a finished run" : "(none)") << "\n";
}
