// Properties of a simulation: the parameters that they make, their checks, and how they print.

#include "vtkRockfallSimulation.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "shared/errorReport.h"
#include "simulation/currentRun.h"

#include "vtkNew.h"

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

//------------------------------------------------------------------------------
std::unique_ptr<rockfall::filters::KeptRun> vtkRockfallSimulation::WantedRun(
  vtkPolyData* terrain, vtkPolyData* rocks)
{
  auto run = std::make_unique<rockfall::filters::KeptRun>();
  run->terrain = rockfall::filters::Stamp(terrain);
  run->rocks = rockfall::filters::Stamp(rocks);
  rockfall::SimulationParameters& p = run->parameters;
  p.timeStep = this->TimeStep;
  p.endTime = this->EndTime;
  p.outputInterval = this->OutputInterval;
  p.gravity = this->Gravity;
  p.normalPenalty = this->NormalPenalty;
  p.shearRatio = this->ShearPenaltyRatio;
  p.rigid = this->Rigid;
  p.impactResolution = rockfall::ImpactResolution(this->ImpactResolution);
  p.rockRockContact = this->RockRockContact;
  p.rockRestitution = this->RockRestitution;
  p.rockFrictionAngle = rockfall::radians(this->RockFrictionAngle);
  p.rockCohesion = this->RockCohesion;
  run->contactFile = this->RockContactFile;
  run->contactSheet = this->RockContactSheet;
  run->allowReferences = this->AllowReferences != 0;
  p.pushRocksApart = this->PushRocksApart;
  p.fragmentation = { this->Fragmentation, this->FragmentationEnergy, this->FractalDimension,
    this->LeastFragment, this->SurvivalRate, this->FragmentationLoss,
    rockfall::radians(this->FragmentSpread) };
  p.iterations = this->Iterations;
  p.firstIteration = this->FirstIteration;
  p.seed = std::uint64_t(this->Seed);
  p.threads = this->NumberOfThreads;
  run->parts.retention = rockfall::Retention(this->TrajectoryOutput);
  run->parts.impacts = this->KeepImpacts;
  run->parts.wholeIteration = this->FirstIteration + this->ShownIteration;
  run->printNotes = this->PrintNotes;
  run->idle = this->IdleNotes();
  return run;
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkRockfallSimulation::IdleNotes() const
{
  rockfall::filters::IdleProperties idle;
  const vtkNew<vtkRockfallSimulation> usual;
  const bool references = this->AllowReferences != 0;
  if (!this->RockRockContact)
  {
    const char* cause = "RockRockContact is off, without which these have no effect";
    idle.addTo(cause, "RockContactFile", this->RockContactFile, usual->RockContactFile);
    idle.addTo(cause, "RockContactSheet", this->RockContactSheet, usual->RockContactSheet);
    idle.addTo(cause, "PushRocksApart", this->PushRocksApart, usual->PushRocksApart);
    idle.addTo(cause, "RockRestitution", this->RockRestitution, usual->RockRestitution);
    idle.addTo(cause, "RockFrictionAngle", this->RockFrictionAngle, usual->RockFrictionAngle);
    idle.addTo(cause, "RockCohesion", this->RockCohesion, usual->RockCohesion);
    idle.addTo(cause, "AllowReferences", references, false);
  }
  else if (this->RockContactFile.empty())
  {
    const char* why = "there is no RockContactFile";
    idle.add("RockContactSheet", this->RockContactSheet, usual->RockContactSheet, why);
    idle.add("AllowReferences", references, false, why);
  }
  if (!this->Fragmentation)
  {
    using Simulation = vtkRockfallSimulation;
    static constexpr std::pair<const char*, double Simulation::*> law[] = {
      { "FragmentationEnergy", &Simulation::FragmentationEnergy },
      { "FractalDimension", &Simulation::FractalDimension },
      { "LeastFragment", &Simulation::LeastFragment },
      { "SurvivalRate", &Simulation::SurvivalRate },
      { "FragmentationLoss", &Simulation::FragmentationLoss },
      { "FragmentSpread", &Simulation::FragmentSpread },
    };
    for (const auto& [name, value] : law)
    {
      idle.addTo("Fragmentation is off, without which these have no effect", name, this->*value,
        usual->*value);
    }
  }
  return idle.notes();
}

//------------------------------------------------------------------------------
void vtkRockfallSimulation::CheckProperties(const rockfall::filters::KeptRun& run) const
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
  inRange(this->ImpactResolution, IMPULSE, SPRINGS, "ImpactResolution");
  inRange(this->TrajectoryOutput, NOTHING, FULL, "TrajectoryOutput");
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
  os << indent << "RockContactSheet: " << this->RockContactSheet << "\n";
  os << indent << "AllowReferences: " << this->AllowReferences << "\n";
  os << indent << "PushRocksApart: " << this->PushRocksApart << "\n";
  os << indent << "Fragmentation: " << this->Fragmentation << "\n";
  os << indent << "FragmentationEnergy: " << this->FragmentationEnergy << "\n";
  os << indent << "FractalDimension: " << this->FractalDimension << "\n";
  os << indent << "LeastFragment: " << this->LeastFragment << "\n";
  os << indent << "SurvivalRate: " << this->SurvivalRate << "\n";
  os << indent << "FragmentationLoss: " << this->FragmentationLoss << "\n";
  os << indent << "FragmentSpread: " << this->FragmentSpread << "\n";
  os << indent << "Rigid: " << this->Rigid << "\n";
  os << indent << "ImpactResolution: " << this->ImpactResolution << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "ShownIteration: " << this->ShownIteration << "\n";
  os << indent << "TrajectoryOutput: " << this->TrajectoryOutput << "\n";
  os << indent << "KeepImpacts: " << this->KeepImpacts << "\n";
  os << indent << "PrintNotes: " << this->PrintNotes << "\n";
  os << indent << "PrintProgress: " << this->PrintProgress << "\n";
  os << indent << "StateHash: " << this->GetStateHash() << "\n";
  os << indent << "RunStatus: " << this->GetRunStatus() << "\n";
  os << indent << "NumberOfRuns: " << this->GetNumberOfRuns() << "\n";
  os << indent << "Kept: " << (this->Current->isOver() ? "a finished run" : "(none)") << "\n";
}
