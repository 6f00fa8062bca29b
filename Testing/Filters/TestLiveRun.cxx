#include "simulationTest.h"

#include "vtkCellData.h"
#include "vtkIntArray.h"
#include "vtkMergeCollectors.h"
#include "vtkPointData.h"
#include "vtkRockfallHazardMap.h"
#include "vtkStringArray.h"
#include "vtkTrajectoryCollector.h"

#include <chrono>
#include <thread>

namespace
{

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class TestLiveRun : public SimulationTest
{
protected:
  void SetUp() override
  {
    this->SimulationTest::SetUp();
    this->Terrain->SetRoughnessDeviation(0.1); // iterations differ
    this->Simulation->SetEndTime(30.0);
  }
  /// As a window does: asks now and then, and updates when there is something new.
  void AskUntilOver()
  {
    const Clock::time_point start = Clock::now();
    for (bool over = false; !over;)
    {
      // Asked before the last look: the run may end between the two.
      const std::string status = this->Simulation->GetRunStatus();
      over = status.rfind("running", 0) != 0 && status.rfind("stopping", 0) != 0;
      if (this->Simulation->GetNeedsUpdate())
      {
        this->Simulation->Update();
        ++this->Looks;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      ASSERT_LT(since(start), 60.0);
    }
  }
  int Looks = 0;
};

} // namespace

TEST_F(TestLiveRun, ComesToTheSameBits)
{
  this->Simulation->SetIterations(100);
  const std::vector<double> waited = numbersOf(this->Output(1));
  const std::string hash = this->Simulation->GetStateHash();

  vtkNew<vtkRockfallSimulation> live;
  live->SetInputConnection(0, this->Terrain->GetOutputPort());
  live->SetInputConnection(1, this->Rocks->GetOutputPort());
  live->SetEndTime(30.0);
  live->SetIterations(100);
  EXPECT_FALSE(live->GetNeedsUpdate()); // it is watched from now on
  const Clock::time_point start = Clock::now();
  live->Update();
  EXPECT_LT(since(start), 5.0); // seconds of work; nobody waits for all of it
  for (bool over = false; !over;)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    over = std::string(live->GetRunStatus()).rfind("running", 0) != 0;
    if (live->GetNeedsUpdate())
    {
      live->Update();
    }
    ASSERT_LT(since(start), 60.0);
  }
  EXPECT_EQ(std::string(live->GetStateHash()), hash);
  EXPECT_EQ(numbersOf(vtkPolyData::SafeDownCast(live->GetOutputDataObject(1))), waited);
  EXPECT_EQ(live->GetNumberOfRuns(), 1);
  EXPECT_FALSE(live->GetNeedsUpdate());
}

TEST_F(TestLiveRun, StopsAndKeepsWhatIsMade)
{
  this->Simulation->SetIterations(40);
  const std::vector<double> first = numbersOf(this->Output(1));
  const vtkIdType firstPoints = this->Output(1)->GetNumberOfPoints();

  this->Simulation->SetIterations(100000);
  this->Simulation->GetNeedsUpdate();
  this->Simulation->Update();
  EXPECT_EQ(std::string(this->Simulation->GetRunStatus()).rfind("running: ", 0), 0U);
  while (this->Output(1)->GetNumberOfCells() < 40) // what is made can be looked at
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    this->Simulation->Modified();
  }
  EXPECT_EQ(this->Output(0)->GetNumberOfCells(), 6); // the block where it is released
  const Clock::time_point start = Clock::now();
  this->Simulation->Stop();
  this->AskUntilOver();
  EXPECT_LT(since(start), 2.0);
  const vtkIdType made = this->Summary()->GetNumberOfRows();
  EXPECT_GE(made, 40);
  EXPECT_LT(made, 100000);
  EXPECT_EQ(this->Output(1)->GetNumberOfCells(), made);
  EXPECT_EQ(
    std::string(this->Simulation->GetRunStatus()).rfind("stopped by its user after ", 0), 0U);
  // Whole ones, in their order: the first are those of a shorter run.
  auto* iteration =
    vtkIntArray::SafeDownCast(this->Output(1)->GetCellData()->GetArray("Iteration"));
  for (vtkIdType k = 0; k < made; ++k)
  {
    ASSERT_EQ(iteration->GetValue(k), k);
  }
  for (vtkIdType k = 0; k < firstPoints; ++k)
  {
    double point[3];
    this->Output(1)->GetPoint(k, point);
    ASSERT_EQ(point[2], first[std::size_t(3 * k + 2)]) << k;
  }
  // The state stays so until something changes.
  const int runs = this->Simulation->GetNumberOfRuns();
  this->Simulation->Update();
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), runs);
  this->Simulation->RunAgain();
  this->Simulation->Update();
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), runs + 1);
  this->Simulation->Stop();
  this->AskUntilOver();
}

TEST_F(TestLiveRun, VeryManyPathsAreLookedAtOnce)
{
  this->Simulation->SetOutputInterval(1e-3); // a million points are soon made
  this->Simulation->SetIterations(100000);
  this->Simulation->GetNeedsUpdate();
  this->Simulation->Update();
  vtkIdType shown = 0;
  const Clock::time_point start = Clock::now();
  for (bool few = true; few && since(start) < 60.0;)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    this->Simulation->GetNeedsUpdate();
    this->Simulation->Modified();
    shown = this->Output(1)->GetNumberOfCells();
    few = this->Output(1)->GetNumberOfPoints() <= 1'000'000;
  }
  EXPECT_GT(shown, 1);
  EXPECT_EQ(this->Summary()->GetNumberOfRows(), shown);
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_FALSE(this->Simulation->GetNeedsUpdate());
  this->Simulation->Modified();
  EXPECT_EQ(this->Output(1)->GetNumberOfCells(), shown);
  this->Simulation->Stop();
  this->AskUntilOver();
  this->Simulation->GetNeedsUpdate(); // as the window asks after the last one
  EXPECT_GT(this->Output(1)->GetNumberOfCells(), shown);
}

TEST_F(TestLiveRun, MapsOfARunThatHasMadeNothingAreEmpty)
{
  // Thirty rocks that fall together: the first iteration takes a while.
  this->Rocks->SetInputConnection(1, this->Terrain->GetOutputPort());
  this->Rocks->SetSlopeThreshold(25.0);
  this->Rocks->SetIntensity(0.01);
  this->Simulation->SetRockRockContact(true);
  this->Simulation->SetPushRocksApart(true);
  this->Simulation->SetIterations(1000);
  this->Simulation->GetNeedsUpdate();
  this->Simulation->Update();
  vtkNew<vtkRockfallHazardMap> map;
  map->SetInputConnection(this->Simulation->GetOutputPort(1));
  map->Update();
  EXPECT_TRUE(this->Heard->Errors.empty());
  this->Simulation->Stop();
  this->AskUntilOver();
}

TEST_F(TestLiveRun, ALineIsNotCalledUnreachedBeforeTheEnd)
{
  this->Simulation->SetIterations(100000);
  this->Simulation->GetNeedsUpdate();
  this->Simulation->Update();
  while (this->Output(1)->GetNumberOfCells() == 0)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    this->Simulation->Modified();
  }
  vtkNew<vtkTrajectoryCollector> line;
  line->SetInputConnection(this->Simulation->GetOutputPort(1));
  line->AddPoint(199.0, 1.0, 0.0); // at the far end
  line->AddPoint(199.0, 99.0, 0.0);
  const auto notes = [&line]
  {
    line->Update();
    auto* all = vtkStringArray::SafeDownCast(
      line->GetOutputDataObject(1)->GetFieldData()->GetAbstractArray("Notes"));
    std::string text;
    for (vtkIdType k = 0; all && k < all->GetNumberOfValues(); ++k)
    {
      text += all->GetValue(k);
    }
    return text;
  };
  EXPECT_EQ(notes(), "The run goes on: these are its rocks so far");
  this->Simulation->Stop();
  this->AskUntilOver();
  this->Simulation->GetNeedsUpdate(); // as the window asks after the last one
  // What is missing is told by all that is made of the run, also by what is made of that.
  const std::string told = notes();
  EXPECT_EQ(told.rfind("Rockfall Simulation was stopped by its user after ", 0), 0U) << told;
  EXPECT_NE(told.find(": shares and frequencies are of these alone"), std::string::npos) << told;
  EXPECT_NE(told.find("No rock reached line"), std::string::npos) << told;
  vtkNew<vtkMergeCollectors> merged;
  merged->SetInputConnection(line->GetOutputPort());
  merged->Update();
  auto* further = vtkStringArray::SafeDownCast(
    merged->GetOutputDataObject(1)->GetFieldData()->GetAbstractArray("Notes"));
  ASSERT_NE(further, nullptr);
  EXPECT_EQ(told.rfind(further->GetValue(0), 0), 0U) << further->GetValue(0);
}

TEST_F(TestLiveRun, ErrorsComeAsEver)
{
  this->Rocks->SetCenter(5.0, 500.0, 58.0);
  this->Simulation->GetNeedsUpdate();
  this->ExpectEmpty();
  this->ExpectOneError({ "outside the slope" });
}
