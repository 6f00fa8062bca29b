#include "vtkRockfallSimulation.h"

#include "arrays.h"
#include "base/errors.h"
#include "base/numberText.h"
#include "failure.h"
#include "jointFaces.h"
#include "keptRun.h"
#include "pieces.h"
#include "progressText.h"
#include "sharedRun.h"
#include "terrainFieldData.h"

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

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

vtkStandardNewMacro(vtkRockfallSimulation);

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;
using rockfall::filters::addArray;
using rockfall::filters::KeptRun;
using rockfall::filters::Ranks;
using rockfall::filters::Stamp;

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

/// Blocks that fit together, as those of a cut mass, are meant to hold and push each other.
void tellApart(std::span<const rockfall::Rock> rocks)
{
  const std::int64_t joined = rockfall::filters::countFaceOnFace(rocks);
  if (joined > 0)
  {
    rockfall::filters::showNote("RockRockContact is off: each of the " +
      std::to_string(rocks.size()) +
      " blocks falls as if it were alone, through the others, though " + std::to_string(joined) +
      " of them lie face on face, as the blocks of a rock mass. " +
      "Switch it on for them to hit and push each other");
  }
}

void tellPushed(
  const rockfall::Ensemble& ensemble, const rockfall::PushedApart& pushed, const Ranks& ranks)
{
  if (ranks.rank() != 0 || pushed.rocks == 0)
  {
    return;
  }
  const int iterations = ensemble.parameters().iterations;
  rockfall::filters::showNote("PushRocksApart moved " +
    std::string(ensemble.pushesAnew() ? "up to " : "") + std::to_string(pushed.rocks) + " of " +
    std::to_string(ensemble.trajectoriesPerUnit()) + " blocks, by up to " +
    rockfall::numberText(pushed.farthest, 4) + " m, in " + std::to_string(pushed.iterations) +
    " of " + std::to_string(iterations) + " iterations");
}

} // namespace

struct vtkRockfallSimulation::Cache : KeptRun
{
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
  this->SetNumberOfOutputPorts(5);
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
void vtkRockfallSimulation::TakeProperties(Cache& run)
{
  rockfall::SimulationParameters& p = run.parameters;
  p.timeStep = this->TimeStep;
  p.endTime = this->EndTime;
  p.outputInterval = this->OutputInterval;
  p.gravity = this->Gravity;
  p.normalPenalty = this->NormalPenalty;
  p.shearRatio = this->ShearPenaltyRatio;
  p.rigid = this->Rigid;
  p.rockRockContact = this->RockRockContact;
  p.rockRestitution = this->RockRestitution;
  p.rockFrictionAngle = rockfall::radians(this->RockFrictionAngle);
  p.rockCohesion = this->RockCohesion;
  run.contactFile = this->RockContactFile;
  p.pushRocksApart = this->PushRocksApart;
  p.iterations = this->Iterations;
  p.firstIteration = this->FirstIteration;
  p.seed = std::uint64_t(this->Seed);
  p.threads = this->NumberOfThreads;
  run.parts.retention = rockfall::Retention(this->TrajectoryOutput);
  run.parts.impacts = this->KeepImpacts;
}

//------------------------------------------------------------------------------
void vtkRockfallSimulation::CheckProperties(const Cache& run) const
{
  const auto inRange = [](int value, int least, int most, const char* name)
  {
    if (value < least || value > most)
    {
      const bool open = most == std::numeric_limits<int>::max();
      throw rockfall::ParameterError(std::string(name) + " is " + rockfall::numberText(value) +
        ", it must be " + (open ? "at least " : "") + rockfall::numberText(least) +
        (open ? "" : " to " + rockfall::numberText(most)));
    }
  };
  inRange(this->Seed, 0, std::numeric_limits<int>::max(), "Seed");
  run.parameters.validate();
  inRange(this->ShownIteration, 0, this->Iterations - 1, "ShownIteration");
  inRange(this->TrajectoryOutput, NOTHING, FULL, "TrajectoryOutput");
}

//------------------------------------------------------------------------------
std::string vtkRockfallSimulation::NoMemory() const
{
  return "The results do not fit in memory: Iterations is " + std::to_string(this->Iterations) +
    "; fewer of them, a longer OutputInterval or a TrajectoryOutput that keeps less take less";
}

//------------------------------------------------------------------------------
bool vtkRockfallSimulation::Simulate(vtkPolyData* terrainInput, vtkPolyData* rocksInput)
{
  const Ranks ranks;
  auto run = std::make_unique<Cache>();
  run->terrain = Stamp(terrainInput);
  run->rocks = Stamp(rocksInput);
  this->TakeProperties(*run);
  ranks.together([&] { this->CheckProperties(*run); }, this->NoMemory());
  const std::vector<int> kept = ranks.gather(this->Kept && this->Kept->isLike(*run) ? 1 : 0);
  if (std::find(kept.begin(), kept.end(), 0) == kept.end())
  {
    this->StateHash = this->Kept->stateHash;
    return true;
  }
  this->Kept.reset();
  this->StateHash.clear();
  const int threads = ranks.threads();
  run->parameters.threads = this->NumberOfThreads > 0 ? this->NumberOfThreads : threads;
  run->prepare(terrainInput, rocksInput, ranks, this->NoMemory());
  if (run->wholeFits())
  {
    run->parts.wholeIteration = this->FirstIteration + this->ShownIteration;
  }
  if (!this->RockRockContact && ranks.rank() == 0)
  {
    tellApart(run->frame.rocks);
  }
  // What is the same in all iterations is known before they run.
  const bool anew = run->ensemble->pushesAnew();
  if (!anew)
  {
    tellPushed(*run->ensemble, run->ensemble->pushed(), ranks);
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
  if (anew)
  {
    tellPushed(*run->ensemble, rockfall::filters::pushedOnAll(*run->ensemble, ranks), ranks);
  }
  if (ranks.rank() == 0)
  {
    sink.finish(run->trajectories, run->impacts, run->summary, run->structures);
    run->whole = std::move(sink.whole());
    run->wholeIteration = run->parts.wholeIteration;
    this->StateHash = sink.stateHash();
    addArray<vtkStringArray>(run->summary->GetFieldData(), "StateHash")
      ->InsertNextValue(this->StateHash);
    for (vtkDataObject* output :
      { static_cast<vtkDataObject*>(run->trajectories), static_cast<vtkDataObject*>(run->impacts),
        static_cast<vtkDataObject*>(run->summary), static_cast<vtkDataObject*>(run->structures) })
    {
      rockfall::filters::copyCoordinateSystem(run->coordinates, output->GetFieldData());
    }
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
void vtkRockfallSimulation::Forget()
{
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
  vtkPolyData* terrain = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* rocks = vtkPolyData::GetData(inputVector[1]);
  if (!terrain || !rocks)
  {
    return first ? rockfall::filters::fail(
                     this, std::string(terrain ? "The Rocks" : "The Terrain") + " input is missing")
                 : 1;
  }
  const bool inherited = rockfall::filters::inheritFailure(terrain, this) ||
    rockfall::filters::inheritFailure(rocks, this);
  const bool again = this->Failed && this->Failed->filter == this->GetMTime() &&
    this->Failed->terrain == Stamp(terrain) && this->Failed->rocks == Stamp(rocks);
  // Whatever one rank decided alone would leave the others waiting.
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
  try
  {
    bool finished = this->Simulate(terrain, rocks);
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
          finished = this->Kept->show(
            this->ShownIteration, time, [this](double) { return !this->CheckAbort(); }, shown);
          output->ShallowCopy(shown);
        }
      },
      this->NoMemory());
    if (ranks.gather(finished ? 1 : 0).front() == 0)
    {
      output->Initialize();
      this->SetAbortOutput(true); // on the others as on the one that was told to
      return 1;                   // the outputs stay empty
    }
    // On every rank, or those without would be asked again when the first one is not.
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    vtkPolyData::GetData(outputVector, TRAJECTORIES)->ShallowCopy(this->Kept->trajectories);
    vtkPolyData::GetData(outputVector, IMPACTS)->ShallowCopy(this->Kept->impacts);
    vtkPolyData::GetData(outputVector, STRUCTURES)->ShallowCopy(this->Kept->structures);
    vtkTable::GetData(outputVector, SUMMARY)->ShallowCopy(this->Kept->summary);
    return 1;
  }
  catch (const rockfall::Error& error)
  {
    return this->Fail(terrain, rocks, error.what());
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
  os << indent << "FirstIteration: " << this->FirstIteration << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "RockRockContact: " << this->RockRockContact << "\n";
  os << indent << "RockRestitution: " << this->RockRestitution << "\n";
  os << indent << "RockFrictionAngle: " << this->RockFrictionAngle << "\n";
  os << indent << "RockCohesion: " << this->RockCohesion << "\n";
  os << indent
     << "RockContactFile: " << (this->RockContactFile.empty() ? "(none)" : this->RockContactFile)
     << "\n";
  os << indent << "PushRocksApart: " << this->PushRocksApart << "\n";
  os << indent << "Rigid: " << this->Rigid << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "ShownIteration: " << this->ShownIteration << "\n";
  os << indent << "TrajectoryOutput: " << this->TrajectoryOutput << "\n";
  os << indent << "KeepImpacts: " << this->KeepImpacts << "\n";
  os << indent << "PrintProgress: " << this->PrintProgress << "\n";
  os << indent << "StateHash: " << this->StateHash << "\n";
  os << indent << "NumberOfRuns: " << this->NumberOfRuns << "\n";
  os << indent << "Kept: " << (this->Kept ? "a finished run" : "(none)") << "\n";
}
