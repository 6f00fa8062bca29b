#include "simulationTest.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cmath>

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

class TestRockfallSimulation : public SimulationTest
{
};

} // namespace

TEST_F(TestRockfallSimulation, PublishesItsTimes)
{
  this->Simulation->SetEndTime(1.02);
  this->Simulation->SetOutputInterval(0.1);
  this->Simulation->UpdateInformation();
  vtkInformation* info = this->Simulation->GetOutputInformation(0);
  ASSERT_EQ(info->Length(Pipeline::TIME_STEPS()), 12); // 0, 0.1 ... 1.0, 1.02
  EXPECT_EQ(info->Get(Pipeline::TIME_STEPS())[0], 0.0);
  EXPECT_NEAR(info->Get(Pipeline::TIME_STEPS())[10], 1.0, 1e-12);
  EXPECT_EQ(info->Get(Pipeline::TIME_STEPS())[11], 1.02);
  EXPECT_EQ(info->Get(Pipeline::TIME_RANGE())[1], 1.02);
  // What does not move has no times.
  EXPECT_FALSE(this->Simulation->GetOutputInformation(1)->Has(Pipeline::TIME_STEPS()));
  // 0.3 / 0.1 is not quite 3, and there is no step between the third and the end.
  this->Simulation->SetEndTime(0.3);
  this->Simulation->UpdateInformation();
  EXPECT_EQ(info->Length(Pipeline::TIME_STEPS()), 4);
}

TEST_F(TestRockfallSimulation, FallsFreely)
{
  // Between samples the position is linear: off by at most g h² / 8 = 3 mm for h = 0.05 s.
  for (double time : { 0.0, 0.1, 0.225, 0.4 })
  {
    vtkPolyData* rock = this->RocksAt(time);
    ASSERT_EQ(rock->GetNumberOfCells(), 6);
    EXPECT_EQ(rock->GetPoints()->GetDataType(), VTK_DOUBLE);
    EXPECT_NEAR(middle(rock, 2), releaseHeight - 0.5 * gravity * time * time, 3.1e-3);
    EXPECT_NEAR(middle(rock, 0), 5.0, 1e-9);
    EXPECT_NEAR(value(rock->GetCellData(), "Velocity", 3, 2), -gravity * time, 1e-9);
    EXPECT_NEAR(value(rock->GetCellData(), "Speed"), gravity * time, 1e-9);
    EXPECT_EQ(value(rock->GetCellData(), "State"), 0);
    EXPECT_EQ(value(rock->GetCellData(), "BlockId"), 1);
  }
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 1);
}

TEST_F(TestRockfallSimulation, RequestsBeyondTheEndsAreClamped)
{
  const double end = middle(this->RocksAt(3.0), 0);
  EXPECT_EQ(middle(this->RocksAt(100.0), 0), end);
  EXPECT_EQ(this->Simulation->GetOutputDataObject(0)->GetInformation()->Get(
              vtkDataObject::DATA_TIME_STEP()),
    3.0);
  EXPECT_NEAR(middle(this->RocksAt(-5.0), 2), releaseHeight, 1e-9);
}

TEST_F(TestRockfallSimulation, SimulatesOnceUntilSomethingChanges)
{
  this->RocksAt(0.0);
  this->RocksAt(1.0);
  this->RocksAt(2.5);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 1);
  this->Simulation->SetIterations(2);
  this->RocksAt(2.5);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 2);
  this->Simulation->SetShownIteration(1);
  this->RocksAt(2.5);
  this->Simulation->SetNumberOfThreads(1);
  this->RocksAt(1.0);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 2);
  this->Rocks->SetVelocity(1, 0, 0);
  this->RocksAt(1.0);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 3);
  this->Terrain->SetFrictionAngle(20);
  this->RocksAt(1.0);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 4);
  this->Simulation->SetNormalPenalty(2e9);
  this->RocksAt(1.0);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 5);
}

TEST_F(TestRockfallSimulation, OutputsTellOneStory)
{
  this->Rocks->SetFileName(this
                             ->WriteFile("sources.csv",
                               "x,y,z,shape\n5,40,58,cube\n"
                               "6,60,58,icosahedron\n")
                             .c_str());
  this->Terrain->SetRoughnessDeviation(0.1);
  this->Simulation->SetIterations(3);
  this->Simulation->SetShownIteration(2);
  vtkPolyData* lines = this->Output(1);
  vtkPolyData* impacts = this->Output(2);
  vtkTable* summary = this->Summary();
  ASSERT_EQ(lines->GetNumberOfLines(), 6);
  ASSERT_EQ(summary->GetNumberOfRows(), 6);
  int impactCount = 0;
  for (int row = 0; row < 6; ++row)
  {
    const int rock = row % 2;
    const auto number = [&](const char* column)
    { return summary->GetValueByName(row, column).ToDouble(); };
    EXPECT_EQ(number("Iteration"), row / 2);
    EXPECT_EQ(number("BlockId"), rock + 1);
    EXPECT_EQ(summary->GetValueByName(row, "Shape").ToString(), rock ? "icosahedron" : "cube");
    EXPECT_EQ(value(lines->GetCellData(), "Iteration", row), row / 2);
    EXPECT_EQ(value(lines->GetCellData(), "BlockId", row), rock + 1);
    EXPECT_EQ(value(lines->GetCellData(), "Fate", row), number("FateCode"));
    EXPECT_EQ(summary->GetValueByName(row, "Fate").ToString(), "moving"); // after 3 s
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    lines->GetCellPoints(row, size, ids);
    int even = 0; // beside the knots
    for (vtkIdType k = 0; k < size; ++k)
    {
      const double intervals = value(lines->GetPointData(), "Time", ids[k]) / 0.05;
      even += std::abs(intervals - std::round(intervals)) < 1e-9;
    }
    ASSERT_EQ(even, 61); // 3 s at 0.05 s
    EXPECT_EQ(value(lines->GetPointData(), "Time", ids[0]), 0.0);
    EXPECT_NEAR(value(lines->GetPointData(), "Time", ids[size - 1]), 3.0, 1e-9);
    const double* first = lines->GetPoint(ids[0]);
    EXPECT_NEAR(first[1], rock ? 60 : 40, 1e-9);
    EXPECT_NEAR(number("StartZ"), 58, 1e-9);
    const double* last = lines->GetPoint(ids[size - 1]);
    EXPECT_NEAR(number("StopX"), last[0], 1e-9);
    impactCount += int(number("Impacts"));
    // The rocks that are shown are those of iteration 2, where their lines end.
    if (row >= 4)
    {
      vtkPolyData* shown = this->RocksAt(3.0);
      ASSERT_EQ(shown->GetNumberOfCells(), 6 + 20);
      EXPECT_EQ(value(shown->GetCellData(), "Iteration"), 2);
      double centre[3] = { 0, 0, 0 };
      const vtkIdType from = rock ? 8 : 0, to = rock ? 20 : 8;
      for (vtkIdType id = from; id < to; ++id)
      {
        for (int k = 0; k < 3; ++k)
        {
          centre[k] += shown->GetPoint(id)[k] / double(to - from);
        }
      }
      lines->GetCellPoints(row, size, ids);
      for (int k = 0; k < 3; ++k)
      {
        EXPECT_NEAR(centre[k], lines->GetPoint(ids[size - 1])[k], 1e-9);
      }
    }
  }
  EXPECT_GT(impactCount, 0);
  ASSERT_EQ(impacts->GetNumberOfVerts(), impactCount);
  for (const char* name : { "BlockId", "RockId", "Iteration", "Time", "Normal", "CFEId", "Impulse",
         "ApproachSpeed", "VelocityBefore", "VelocityAfter", "EnergyLoss", "Restitution" })
  {
    EXPECT_TRUE(impacts->GetPointData()->GetArray(name)) << name;
  }
  for (vtkIdType k = 0; k < impactCount; ++k)
  {
    EXPECT_GT(value(impacts->GetPointData(), "Impulse", k), 0.0);
    EXPECT_GE(value(impacts->GetPointData(), "CFEId", k), 1.0);
    EXPECT_EQ(value(impacts->GetPointData(), "Restitution", k), 0.8);
  }
}

TEST_F(TestRockfallSimulation, EveryJouleIsInTheTables)
{
  this->Terrain->SetRoughnessDeviation(0.1);
  this->Rocks->SetVelocity(2.0, 0.0, 0.0);
  this->Simulation->SetIterations(3);
  this->Simulation->SetGravity(5.0);
  vtkTable* summary = this->Summary();
  vtkPolyData* lines = this->Output(1);
  vtkFieldData* points = lines->GetPointData();
  for (int row = 0; row < 3; ++row)
  {
    const auto number = [&](const char* column)
    {
      EXPECT_TRUE(summary->GetColumnByName(column)) << column;
      return summary->GetValueByName(row, column).ToDouble();
    };
    const double released = number("EnergyReleased");
    const double spent = number("EnergyKinetic") + number("EnergyStrain") +
      number("EnergyFriction") + number("EnergyRestitution") + number("EnergyVibration") +
      number("EnergyDamping") + number("EnergyNumerical");
    EXPECT_GT(released, 1e4); // J; some 10 m of fall of 2500 kg at 5 m/s²
    EXPECT_NEAR(spent, released, 1e-9 * released);

    // What a trajectory says is the same: its fall and its speed at the start.
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    lines->GetCellPoints(row, size, ids);
    const vtkIdType first = ids[0], last = ids[size - 1];
    const double weight = number("Mass") * 5.0; // N
    EXPECT_NEAR(value(points, "PotentialEnergy", first), weight * number("StartZ"), 1e-3);
    EXPECT_NEAR(value(points, "PotentialEnergy", last), weight * number("StopZ"), 1e-3);
    EXPECT_NEAR(value(points, "PotentialEnergy", first) + value(points, "KineticEnergy", first) -
        value(points, "PotentialEnergy", last),
      released, 1e-9 * released);
  }
}

TEST_F(TestRockfallSimulation, FurtherPiecesAreEmpty)
{
  // As on the second of two ranks, on which sources leave their output empty.
  this->Simulation->UpdatePiece(1, 2, 0);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 0);
  for (int port = 0; port < 4; ++port)
  {
    vtkDataObject* output = this->Simulation->GetOutputDataObject(port);
    EXPECT_EQ(output->GetNumberOfElements(vtkDataObject::POINT), 0) << port;
    EXPECT_EQ(output->GetNumberOfElements(vtkDataObject::ROW), 0) << port;
    EXPECT_FALSE(output->GetFieldData()->GetAbstractArray("Error")) << port;
  }
  this->Simulation->UpdatePiece(0, 2, 0);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 1);
  EXPECT_GT(this->Simulation->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::POINT), 0);
}

TEST_F(TestRockfallSimulation, ResultsDoNotDependOnThreads)
{
  this->Terrain->SetRoughnessDeviation(0.1);
  this->Simulation->SetIterations(4);
  this->Simulation->SetNumberOfThreads(1);
  const auto one = numbersOf(this->Output(1));
  vtkNew<vtkRockfallSimulation> other;
  other->SetInputConnection(0, this->Terrain->GetOutputPort());
  other->SetInputConnection(1, this->Rocks->GetOutputPort());
  other->SetEndTime(3.0);
  other->SetIterations(4);
  other->SetNumberOfThreads(3);
  other->Update();
  EXPECT_EQ(one, numbersOf(vtkPolyData::SafeDownCast(other->GetOutputDataObject(1))));
  this->Simulation->SetSeed(2);
  EXPECT_NE(one, numbersOf(this->Output(1)));
}

TEST_F(TestRockfallSimulation, KeepsWhatIsAskedFor)
{
  this->Terrain->SetRoughnessDeviation(0.1);
  this->Simulation->SetIterations(3);
  const auto shown = [&](double time)
  {
    vtkPolyData* rocks = this->RocksAt(time);
    std::vector<double> numbers;
    for (vtkIdType id = 0; id < rocks->GetNumberOfPoints(); ++id)
    {
      numbers.insert(numbers.end(), rocks->GetPoint(id), rocks->GetPoint(id) + 3);
    }
    return numbers;
  };
  vtkNew<vtkPolyData> full, ends;
  full->DeepCopy(this->Output(1));
  const std::string hash = this->Simulation->GetStateHash();
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
  auto* field =
    vtkStringArray::SafeDownCast(this->Summary()->GetFieldData()->GetAbstractArray("StateHash"));
  ASSERT_TRUE(field);
  EXPECT_EQ(field->GetValue(0), hash);
  const auto rocksThen = shown(1.3);
  const vtkIdType impacts = this->Output(2)->GetNumberOfVerts();
  EXPECT_GT(impacts, 0);
  EXPECT_TRUE(full->GetPointData()->HasArray("FrictionLoss"));

  vtkIdType before = 0;
  for (int kept = vtkRockfallSimulation::NOTHING; kept <= vtkRockfallSimulation::FULL; ++kept)
  {
    this->Simulation->SetTrajectoryOutput(kept);
    vtkPolyData* lines = this->Output(1);
    const vtkIdType points = lines->GetNumberOfPoints();
    EXPECT_GE(points, before) << kept; // each keeps more than the one before
    before = points;
    EXPECT_EQ(lines->GetNumberOfCells(), kept == vtkRockfallSimulation::NOTHING ? 0 : 3) << kept;
    EXPECT_EQ(lines->GetNumberOfVerts(), kept == vtkRockfallSimulation::STOPPING_POINTS ? 3 : 0);
    EXPECT_EQ(this->Summary()->GetNumberOfRows(), 3) << kept;
    EXPECT_EQ(this->Simulation->GetStateHash(), hash) << kept;
    EXPECT_EQ(this->Output(2)->GetNumberOfVerts(), impacts) << kept;
    EXPECT_EQ(shown(1.3), rocksThen) << kept;
    if (kept == vtkRockfallSimulation::STOPPING_POINTS)
    {
      ends->DeepCopy(lines);
    }
  }
  for (vtkIdType row = 0; row < 3; ++row)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    full->GetCellPoints(row, size, ids);
    EXPECT_EQ(ends->GetPoint(row)[0], full->GetPoint(ids[size - 1])[0]);
    EXPECT_EQ(ends->GetPoint(row)[2], full->GetPoint(ids[size - 1])[2]);
  }
  this->Simulation->KeepImpactsOff();
  EXPECT_EQ(this->Output(2)->GetNumberOfVerts(), 0);
  EXPECT_GT(this->Summary()->GetValueByName(0, "Impacts").ToDouble(), 0.0);
  EXPECT_EQ(this->Simulation->GetStateHash(), hash);
}

TEST_F(TestRockfallSimulation, AnyIterationCanBeShown)
{
  this->Terrain->SetRoughnessDeviation(0.1);
  this->Simulation->SetOutputInterval(0.025);
  this->Simulation->SetTrajectoryOutput(vtkRockfallSimulation::STOPPING_POINTS);
  this->Simulation->SetIterations(4);
  this->Simulation->SetFirstIteration(5);
  for (int shown : { 0, 3, 1 })
  {
    this->Simulation->SetShownIteration(shown);
    vtkPolyData* rocks = this->RocksAt(3.0);
    EXPECT_EQ(value(rocks->GetCellData(), "Iteration"), 5 + shown);
    // Where its trajectory ends.
    const double* end = this->Output(1)->GetPoint(shown);
    this->RocksAt(3.0);
    double centre = 0.0;
    for (vtkIdType id = 0; id < 8; ++id)
    {
      centre += rocks->GetPoint(id)[0] / 8.0;
    }
    EXPECT_NEAR(centre, end[0], 1e-9) << shown;
  }
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 1);
  // Where there may be more samples than are kept each time is simulated for itself: the same.
  const double there = middle(this->RocksAt(1.37), 0);
  this->Simulation->SetEndTime(1e5); // it rests or leaves long before
  EXPECT_EQ(middle(this->RocksAt(1.37), 0), there);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 2);
}

TEST_F(TestRockfallSimulation, PartsOfAStudyAreThoseOfTheWhole)
{
  this->Terrain->SetRoughnessDeviation(0.1);
  this->Simulation->SetIterations(6);
  vtkNew<vtkTable> whole;
  whole->DeepCopy(this->Summary());
  this->Simulation->SetIterations(2);
  for (int first : { 0, 2, 4 })
  {
    this->Simulation->SetFirstIteration(first);
    vtkTable* part = this->Summary();
    ASSERT_EQ(part->GetNumberOfRows(), 2);
    for (vtkIdType row = 0; row < 2; ++row)
    {
      for (vtkIdType column = 0; column < whole->GetNumberOfColumns(); ++column)
      {
        EXPECT_EQ(part->GetValue(row, column), whole->GetValue(first + row, column))
          << whole->GetColumnName(column);
      }
    }
  }
}

TEST_F(TestRockfallSimulation, TellsItsProgressWhenAsked)
{
  this->Terrain->SetRoughnessDeviation(0.1);
  this->Simulation->SetIterations(20);
  std::vector<std::string> texts;
  vtkNew<vtkCallbackCommand> listen;
  listen->SetClientData(&texts);
  listen->SetCallback(
    [](vtkObject* caller, unsigned long, void* clientData, void*)
    {
      const char* text = vtkAlgorithm::SafeDownCast(caller)->GetProgressText();
      static_cast<std::vector<std::string>*>(clientData)->push_back(text ? text : "");
    });
  this->Simulation->AddObserver(vtkCommand::ProgressEvent, listen);
  testing::internal::CaptureStderr();
  this->Simulation->Update();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(std::any_of(texts.begin(), texts.end(),
    [](const std::string& text)
    { return text.find(" of 20 trajectories (") != std::string::npos; }));
  EXPECT_FALSE(this->Simulation->GetProgressText());
  this->Simulation->PrintProgressOn();
  this->Simulation->SetSeed(2);
  testing::internal::CaptureStderr();
  this->Simulation->Update();
  EXPECT_NE(testing::internal::GetCapturedStderr().find("Rockfall Simulation: 20 trajectories in "),
    std::string::npos);
}

TEST_F(TestRockfallSimulation, AbortLeavesNothing)
{
  this->Terrain->SetRoughnessDeviation(0.1);
  this->Simulation->SetIterations(100000); // far more than are done before the first progress
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1); });
  const unsigned long tag = this->Simulation->AddObserver(vtkCommand::ProgressEvent, stop);
  this->ExpectEmpty();
  this->Simulation->RemoveObserver(tag);
  EXPECT_LE(this->Simulation->GetNumberOfRuns(), 1); // 0: heard before it began
  EXPECT_STREQ(this->Simulation->GetStateHash(), "");
  this->Simulation->SetAbortExecute(0);
  this->Simulation->SetIterations(2);
  EXPECT_EQ(this->Summary()->GetNumberOfRows(), 2);
}

TEST_F(TestRockfallSimulation, ReportsProgress)
{
  this->Terrain->SetRoughnessDeviation(0.1);
  this->Simulation->SetEndTime(20.0);
  this->Simulation->SetIterations(10);
  std::vector<double> shares;
  vtkNew<vtkCallbackCommand> listen;
  listen->SetClientData(&shares);
  listen->SetCallback([](vtkObject*, unsigned long, void* clientData, void* share)
    { static_cast<std::vector<double>*>(clientData)->push_back(*static_cast<double*>(share)); });
  this->Simulation->AddObserver(vtkCommand::ProgressEvent, listen);
  this->Simulation->Update();
  EXPECT_GT(shares.size(), 2u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
}

TEST_F(TestRockfallSimulation, PrintSelfNamesEveryProperty)
{
  std::ostringstream text;
  this->Simulation->Print(text);
  for (const char* name : { "TimeStep", "EndTime", "OutputInterval", "Gravity", "NormalPenalty",
         "ShearPenaltyRatio", "Iterations", "Seed", "RockRockContact", "RockContactFile", "Rigid",
         "ImpactResolution", "NumberOfThreads", "ShownIteration", "FirstIteration",
         "TrajectoryOutput", "KeepImpacts", "PrintProgress", "StateHash", "NumberOfRuns" })
  {
    EXPECT_NE(text.str().find(std::string(name) + ":"), std::string::npos) << name;
  }
}
