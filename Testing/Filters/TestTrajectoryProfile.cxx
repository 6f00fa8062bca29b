#include "helpers.h"
#include "shared/rockPaths.h"
#include "trajectories.h"

#include "vtkTable.h"
#include "vtkTrajectoryProfile.h"

namespace
{

/// A rock of 1000 kg at 10 m/s over 80 m, one at 5 m/s over 10 m.
class TestTrajectoryProfile : public FilterTest
{
protected:
  void SetUp() override
  {
    this->FilterTest::SetUp();
    this->Paths.AddLevel(0, 0, { 100.0, 20.0, 50.0 }, 80.0, 10.0);
    this->Paths.AddLevel(3, 1, { 300.0, 20.0, 40.0 }, 10.0, 5.0, 1.5);
    this->Filter->SetInputData(this->Paths.Data);
  }

  double Number(int row, const char* column)
  {
    return this->Filter->GetOutput()->GetValueByName(row, column).ToDouble();
  }

  HandMadeTrajectories Paths;
  vtkNew<vtkTrajectoryProfile> Filter;
};

TEST_F(TestTrajectoryProfile, ColumnsAreThoseOfTheTrajectory)
{
  this->Filter->SetTrajectory(1);
  this->Filter->Update();
  ASSERT_EQ(this->Filter->GetOutput()->GetNumberOfRows(), 2);
  EXPECT_DOUBLE_EQ(this->Number(0, "Distance"), 0.0);
  EXPECT_DOUBLE_EQ(this->Number(1, "Distance"), 10.0);
  EXPECT_DOUBLE_EQ(this->Number(1, "Time"), 2.0);
  EXPECT_DOUBLE_EQ(this->Number(1, "Elevation"), 40.0);
  EXPECT_DOUBLE_EQ(this->Number(1, "Speed"), 5.0);
  EXPECT_DOUBLE_EQ(this->Number(1, "EnergyInKilojoules"), 12.6); // 0.5 * 1000 * 25 + 100 J
  EXPECT_DOUBLE_EQ(this->Number(1, "HeightOverGround"), 1.5);
  vtkFieldData* field = this->Filter->GetOutput()->GetFieldData();
  EXPECT_EQ(field->GetArray("BlockId")->GetComponent(0, 0), 101.0);
  EXPECT_EQ(field->GetArray("RockId")->GetComponent(0, 0), 1.0);
  EXPECT_EQ(field->GetArray("Iteration")->GetComponent(0, 0), 3.0);
  auto* path = vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(1));
  ASSERT_TRUE(path);
  EXPECT_EQ(path->GetNumberOfLines(), 1);
  EXPECT_EQ(path->GetBounds()[0], 300.0);
  EXPECT_EQ(path->GetBounds()[1], 310.0);
}

TEST_F(TestTrajectoryProfile, ATrajectoryThatARunHasNotMadeYetIsEmpty)
{
  rockfall::filters::markRunning(this->Paths.Data->GetFieldData());
  this->Filter->SetTrajectory(2);
  this->Filter->Update();
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfRows(), 0);
}

TEST_F(TestTrajectoryProfile, ATrajectoryThatIsNotThereIsAnError)
{
  this->Filter->SetTrajectory(2);
  this->Filter->Update();
  this->ExpectOneError({ "Trajectory is 2", "0 to 1" });
  this->Filter->SetTrajectory(-1);
  this->Filter->Update();
  this->ExpectOneError({ "Trajectory is -1" });
}

} // namespace
