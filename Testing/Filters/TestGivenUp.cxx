// Work of every filter is given up within a second of an abort, and leaves empty outputs.
#include "helpers.h"
#include "trajectories.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDEMToCFESource.h"
#include "vtkImageData.h"
#include "vtkJointedRockMass.h"
#include "vtkRockBlockSource.h"
#include "vtkRockfallHazardMap.h"
#include "vtkRockfallSimulation.h"
#include "vtkTrajectoryCollector.h"

#include <chrono>
#include <ctime>

namespace
{

constexpr double kWanted = 0.2; // s
constexpr double kHeard = 1.0;  // s of the processor, which other programs do not make longer

class TestGivenUp : public FilterTest
{
protected:
  using Clock = std::chrono::steady_clock;

  double Elapsed() const
  {
    return std::chrono::duration<double>(Clock::now() - this->Started).count();
  }

  /// Updates a filter that is to abort after kWanted, and what it is heard by.
  void ExpectHeard(vtkAlgorithm* filter)
  {
    vtkNew<vtkCallbackCommand> stop;
    stop->SetClientData(this);
    stop->SetCallback(
      [](vtkObject* caller, unsigned long, void* test, void*)
      {
        if (static_cast<TestGivenUp*>(test)->Elapsed() > kWanted)
        {
          vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1);
        }
      });
    filter->AddObserver(vtkCommand::ProgressEvent, stop);
    this->Started = Clock::now();
    const std::clock_t begun = std::clock();
    filter->Update();
    EXPECT_GE(this->Elapsed(), kWanted) << "it was done before";
    EXPECT_LE(double(std::clock() - begun) / CLOCKS_PER_SEC, kWanted + kHeard);
    EXPECT_TRUE(filter->GetAbortOutput());
    for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
    {
      EXPECT_EQ(filter->GetOutputDataObject(port)->GetNumberOfElements(vtkDataObject::CELL), 0);
    }
  }

  Clock::time_point Started;
};

/// Paths of some hundred metres, each over many cells of a map.
void addPaths(HandMadeTrajectories& paths, int count)
{
  for (int rock = 0; rock < count; ++rock)
  {
    paths.AddLevel(0, rock, { 500000, 5100000.0 + 0.01 * rock, 50 }, 500, 10.0);
  }
}

TEST_F(TestGivenUp, RockBlocks)
{
  vtkNew<vtkRockBlockSource> rocks;
  rocks->SetMaximumRocks(10'000'000);
  rocks->SetAmount(2'000'000);
  this->ExpectHeard(rocks);
}

TEST_F(TestGivenUp, JointedRockMass)
{
  vtkNew<vtkJointedRockMass> mass;
  mass->SetLengths(100, 100, 100);
  mass->SetMaximumRocks(10'000'000);
  mass->SetNumberOfJointSets(3);
  mass->SetJointSet(0, 90, 0, 0.5, 0, 0, 0);
  mass->SetJointSet(1, 90, 90, 0.5, 0, 0, 0);
  mass->SetJointSet(2, 0, 0, 0.5, 0, 0, 0);
  this->ExpectHeard(mass);
}

TEST_F(TestGivenUp, HazardMap)
{
  HandMadeTrajectories paths;
  addPaths(paths, 20000);
  vtkNew<vtkRockfallHazardMap> map;
  map->SetInputDataObject(0, paths.Data);
  map->SetCellSize(0.1);
  this->ExpectHeard(map);
}

TEST_F(TestGivenUp, TrajectoryCollector)
{
  HandMadeTrajectories paths;
  addPaths(paths, 50000);
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  points->SetDataTypeToDouble();
  for (int k = 0; k < 200; ++k)
  {
    const vtkIdType ends[] = { points->InsertNextPoint(500001 + 2 * k, 5099990, 0),
      points->InsertNextPoint(500001 + 2 * k, 5101000, 0) };
    lines->InsertNextCell(2, ends);
  }
  vtkNew<vtkPolyData> drawn;
  drawn->SetPoints(points);
  drawn->SetLines(lines);
  vtkNew<vtkTrajectoryCollector> collector;
  collector->SetInputDataObject(0, paths.Data);
  collector->SetInputDataObject(1, drawn);
  this->ExpectHeard(collector);
}

TEST_F(TestGivenUp, SimulationWhileItPushesRocksApart)
{
  vtkNew<vtkDEMToCFESource> slope;
  vtkNew<vtkRockBlockSource> rocks;
  rocks->SetCenter(40, 50, 60);
  rocks->SetAmount(4000); // in one place
  vtkNew<vtkRockfallSimulation> simulation;
  simulation->SetInputConnection(0, slope->GetOutputPort());
  simulation->SetInputConnection(1, rocks->GetOutputPort());
  simulation->SetRockRockContact(true);
  simulation->SetPushRocksApart(true);
  rocks->Update();
  this->ExpectHeard(simulation);
  EXPECT_STREQ(simulation->GetStateHash(), "");
}

} // namespace
