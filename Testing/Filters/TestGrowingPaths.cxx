#include "helpers.h"
#include "trajectories.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkGrowingPaths.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkRockfallHazardMap.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTrajectoryCollector.h"

#include <initializer_list>

namespace
{

/// A rock at 10 m/s over 80 m from x = 100 m, and one at 5 m/s over 10 m from x = 300 m.
class TestGrowingPaths : public FilterTest
{
protected:
  void SetUp() override
  {
    this->FilterTest::SetUp();
    this->Paths.AddLevel(0, 0, { 100.0, 20.0, 50.0 }, 80.0, 10.0);
    this->Paths.AddLevel(3, 1, { 300.0, 20.0, 50.0 }, 10.0, 5.0);
    this->Filter->SetInputData(this->Paths.Data);
  }

  vtkPolyData* At(double time)
  {
    this->Filter->UpdateTimeStep(time);
    return this->Filter->GetOutput();
  }

  HandMadeTrajectories Paths;
  vtkNew<vtkGrowingPaths> Filter;
};

TEST_F(TestGrowingPaths, EndWhereTheRocksAre)
{
  vtkPolyData* output = this->At(3.0);
  ASSERT_EQ(output->GetNumberOfLines(), 2);
  double bounds[6];
  output->GetCellBounds(0, bounds);
  EXPECT_DOUBLE_EQ(bounds[0], 100.0);
  EXPECT_DOUBLE_EQ(bounds[1], 130.0); // 3 s at 10 m/s
  output->GetCellBounds(1, bounds);
  EXPECT_DOUBLE_EQ(bounds[1], 310.0); // at rest since 2 s
  vtkDataArray* times = output->GetPointData()->GetArray("Time");
  ASSERT_NE(times, nullptr);
  EXPECT_DOUBLE_EQ(times->GetComponent(1, 0), 3.0);
  EXPECT_EQ(output->GetCellData()->GetArray("Iteration")->GetComponent(1, 0), 3.0);
  EXPECT_NE(output->GetFieldData()->GetAbstractArray("TerrainCRS"), nullptr);
}

TEST_F(TestGrowingPaths, AreWholeWithoutATimeAndAfterTheLast)
{
  this->Filter->Update();
  double bounds[6];
  this->Filter->GetOutput()->GetBounds(bounds);
  EXPECT_DOUBLE_EQ(bounds[1], 310.0);
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 4);
  this->At(1.0)->GetBounds(bounds);
  EXPECT_DOUBLE_EQ(bounds[1], 305.0);
  this->At(100.0)->GetBounds(bounds);
  EXPECT_DOUBLE_EQ(bounds[1], 310.0);
}

TEST_F(TestGrowingPaths, AreTheInputsOwnWhenTheyAreWhole)
{
  // Else the arrays of a large run are copied and looked through once more.
  const auto shared = [this](double time)
  {
    vtkPolyData* output = this->At(time);
    return output->GetPointData()->GetArray("Time") ==
      this->Paths.Data->GetPointData()->GetArray("Time") &&
      output->GetPoints() == this->Paths.Data->GetPoints();
  };
  EXPECT_FALSE(shared(7.9));
  EXPECT_TRUE(shared(8.0));
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfLines(), 2);
  EXPECT_EQ(
    this->Filter->GetOutput()->GetCellData()->GetArray("Iteration")->GetComponent(1, 0), 3.0);
  EXPECT_NE(this->Filter->GetOutput()->GetFieldData()->GetAbstractArray("TerrainCRS"), nullptr);
  EXPECT_FALSE(shared(1.0)); // and back
  EXPECT_EQ(this->Paths.Data->GetNumberOfPoints(), 4);
}

TEST_F(TestGrowingPaths, KeepTheirNumbersBeforeTheyBegin)
{
  vtkPolyData* output = this->At(-1.0);
  ASSERT_EQ(output->GetNumberOfLines(), 2);
  double bounds[6];
  output->GetCellBounds(1, bounds);
  EXPECT_DOUBLE_EQ(bounds[0], 300.0);
  EXPECT_DOUBLE_EQ(bounds[1], 300.0);
}

TEST_F(TestGrowingPaths, TimeRangeIsThatOfTheTrajectories)
{
  this->Filter->Update();
  double range[2];
  this->Filter->GetOutputInformation(0)->Get(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range);
  EXPECT_DOUBLE_EQ(range[0], 0.0);
  EXPECT_DOUBLE_EQ(range[1], 8.0);
  this->Paths.AddLevel(0, 2, { 100.0, 0.0, 50.0 }, 90.0, 10.0);
  this->Paths.Data->GetPointData()->GetArray("Time")->Modified(); // or its range is the old one
  this->At(8.5);                                                  // beyond the old range
  double bounds[6];
  this->Filter->GetOutput()->GetCellBounds(2, bounds);
  EXPECT_DOUBLE_EQ(bounds[1], 185.0);
}

// A rock that comes to rest at 8 s would count, at 3 s, as one that rests there.
TEST_F(TestGrowingPaths, WhatCountsRocksRefusesHalfOfAPath)
{
  vtkNew<vtkTrajectoryCollector> line;
  line->SetInputConnection(this->Filter->GetOutputPort());
  line->AddPoint(150.0, 0.0, 0.0);
  line->AddPoint(150.0, 100.0, 0.0);
  vtkNew<vtkRockfallHazardMap> map;
  map->SetInputConnection(this->Filter->GetOutputPort());
  map->SetCellSize(5.0);
  for (vtkAlgorithm* product : std::initializer_list<vtkAlgorithm*>{ line, map })
  {
    product->UpdateTimeStep(3.0);
    this->ExpectOneError({ "The Input has paths up to 3 s", "Growing Paths" });
    product->UpdateTimeStep(8.0);
    EXPECT_TRUE(this->Heard->Errors.empty());
  }
}

TEST_F(TestGrowingPaths, OtherLinesAreRefused)
{
  this->Paths.Data->GetPointData()->RemoveArray("Time");
  this->Filter->Update();
  this->ExpectOneError({ "Input", "Time" });
}

} // namespace
