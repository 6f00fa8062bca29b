#include "helpers.h"
#include "trajectories.h"

#include "vtkAppendPolyData.h"
#include "vtkMergeCollectors.h"
#include "vtkTable.h"
#include "vtkTrajectoryCollector.h"

#include <cmath>
#include <sstream>

namespace
{

/// Rocks of some iterations past a line, collected in parts.
class TestMergeCollectors : public FilterTest
{
protected:
  void SetUp() override
  {
    this->FilterTest::SetUp();
    this->Points->SetDataTypeToDouble();
    for (const double x : { 500010.0, 500025.0 })
    {
      const vtkIdType first = this->Points->InsertNextPoint(x, 5099990, 0);
      this->Lines->InsertNextCell({ first, this->Points->InsertNextPoint(x, 5100100, 0) });
    }
    this->Drawn->SetPoints(this->Points);
    this->Drawn->SetLines(this->Lines);
  }

  /// The crossings of the rocks for which (iteration · 4 + rock) % parts == part.
  vtkSmartPointer<vtkTrajectoryCollector> Collect(int parts, int part, double barrier = 3.0)
  {
    HandMadeTrajectories paths;
    for (int k = 0; k < 12; ++k)
    {
      if (k % parts == part)
      {
        // The first of each iteration stops before the second line.
        paths.AddLevel(k / 4, k % 4, { 500000, 5100000.0 + 7 * (k % 4), 50 },
          k % 4 == 0 ? 20.0 : 30.0, 5.0 + 0.1 * k, 1.0 + 0.3 * k);
      }
    }
    auto collector = vtkSmartPointer<vtkTrajectoryCollector>::New();
    collector->SetInputDataObject(0, paths.Data);
    collector->SetInputDataObject(1, this->Drawn);
    collector->SetBarrierHeight(barrier);
    collector->Update();
    return collector;
  }

  static std::string TextOf(vtkTable* table)
  {
    std::ostringstream text;
    text.precision(17);
    for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
    {
      for (vtkIdType column = 0; column < table->GetNumberOfColumns(); ++column)
      {
        text << table->GetColumnName(column) << " " << table->GetValue(row, column) << "\n";
      }
    }
    return text.str();
  }

  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Lines;
  vtkNew<vtkPolyData> Drawn;
  vtkNew<vtkMergeCollectors> Filter;
};

} // namespace

TEST_F(TestMergeCollectors, PartsAreTheWhole)
{
  const auto whole = this->Collect(1, 0);
  ASSERT_EQ(whole->GetOutput()->GetNumberOfPoints(), 12 + 9);
  for (const int parts : { 1, 3, 12 })
  {
    vtkNew<vtkMergeCollectors> merge;
    for (int part = parts - 1; part >= 0; --part) // in any order
    {
      merge->AddInputDataObject(0, this->Collect(parts, part)->GetOutput());
    }
    merge->Update();
    for (const int port : { 1, 2 })
    {
      EXPECT_EQ(TextOf(vtkTable::SafeDownCast(merge->GetOutputDataObject(port))),
        TextOf(vtkTable::SafeDownCast(whole->GetOutputDataObject(port))))
        << parts << " parts, port " << port;
    }
    vtkPolyData *made = merge->GetOutput(), *wanted = whole->GetOutput();
    ASSERT_EQ(made->GetNumberOfPoints(), wanted->GetNumberOfPoints());
    EXPECT_EQ(made->GetNumberOfVerts(), wanted->GetNumberOfVerts());
    ASSERT_EQ(
      made->GetPointData()->GetNumberOfArrays(), wanted->GetPointData()->GetNumberOfArrays());
    for (vtkIdType k = 0; k < made->GetNumberOfPoints(); ++k)
    {
      EXPECT_EQ(made->GetPoint(k)[0], wanted->GetPoint(k)[0]);
      for (int a = 0; a < made->GetPointData()->GetNumberOfArrays(); ++a)
      {
        vtkAbstractArray* array = wanted->GetPointData()->GetAbstractArray(a);
        const vtkVariant is =
          made->GetPointData()->GetAbstractArray(array->GetName())->GetVariantValue(k);
        const vtkVariant was = array->GetVariantValue(k);
        const bool neither =
          is.IsNumeric() && std::isnan(is.ToDouble()) && std::isnan(was.ToDouble());
        EXPECT_TRUE(is == was || neither) << array->GetName() << " of " << k;
      }
    }
    EXPECT_EQ(value(made->GetFieldData(), "CollectorReleased"), 12.0);
    EXPECT_TRUE(made->GetFieldData()->GetAbstractArray("TerrainCRS"));
  }
}

TEST_F(TestMergeCollectors, APartWithoutCrossings)
{
  HandMadeTrajectories paths;
  paths.AddLevel(9, 0, { 500000, 5100000, 50 }, 5, 5.0);
  vtkNew<vtkTrajectoryCollector> none;
  none->SetInputDataObject(0, paths.Data);
  none->SetInputDataObject(1, this->Drawn);
  none->SetBarrierHeight(3.0);
  none->Update();
  this->Filter->AddInputDataObject(0, none->GetOutput());
  this->Filter->AddInputDataObject(0, this->Collect(1, 0)->GetOutput());
  this->Filter->Update();
  auto* table = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(1));
  EXPECT_EQ(table->GetValueByName(0, "Rocks").ToInt(), 12);
  EXPECT_DOUBLE_EQ(table->GetValueByName(0, "Share").ToDouble(), 12.0 / 13.0);
}

/// Where nothing crossed there is nothing else to know a part by.
TEST_F(TestMergeCollectors, APartWithoutCrossingsIsThereTwice)
{
  HandMadeTrajectories paths;
  paths.AddLevel(9, 0, { 500000, 5100000, 50 }, 5, 5.0);
  vtkNew<vtkTrajectoryCollector> none;
  none->SetInputDataObject(0, paths.Data);
  none->SetInputDataObject(1, this->Drawn);
  none->Update();
  for (int k = 0; k < 2; ++k)
  {
    this->Filter->AddInputDataObject(0, none->GetOutput());
  }
  this->Filter->Update();
  this->ExpectOneError({ "Rock 0 of iteration 9", "twice" });
}

TEST_F(TestMergeCollectors, BadInput)
{
  vtkNew<vtkPolyData> none;
  this->Filter->AddInputDataObject(0, none);
  this->Filter->Update();
  this->ExpectOneError({ "part 1", "CollectorBarrier", "Trajectory Collector" });

  const auto whole = this->Collect(1, 0);
  const auto expect = [&](vtkPolyData* other, const std::vector<std::string>& words)
  {
    vtkNew<vtkMergeCollectors> merge;
    merge->AddInputDataObject(0, whole->GetOutput());
    merge->AddInputDataObject(0, other);
    merge->Update();
    this->ExpectOneError(words);
    EXPECT_EQ(merge->GetOutput()->GetNumberOfPoints(), 0);
  };
  expect(whole->GetOutput(), { "Rock 0 of iteration 0", "twice" });
  expect(this->Collect(1, 0, 4.0)->GetOutput(), { "part 2", "other lines or barriers" });
  vtkNew<vtkPolyData> elsewhere, poorer;
  elsewhere->DeepCopy(whole->GetOutput());
  vtkStringArray::SafeDownCast(elsewhere->GetFieldData()->GetAbstractArray("TerrainCRS"))
    ->SetValue(0, "EPSG:2056");
  expect(elsewhere, { "part 2", "another CRS" });
  poorer->DeepCopy(whole->GetOutput());
  poorer->GetPointData()->RemoveArray("Velocity");
  expect(poorer, { "part 2", "Velocity" });
  // Crossings of another collector, appended: their numbers are those of its lines.
  vtkNew<vtkPolyData> appended;
  appended->DeepCopy(this->Collect(2, 1)->GetOutput());
  vtkStringArray::SafeDownCast(appended->GetPointData()->GetAbstractArray("LineName"))
    ->SetValue(3, "its own road");
  expect(appended, { "part 2", "\"its own road\"", "collectors appended" });
  // ParaView's Append Geometry and Group Datasets keep the rocks of one collector only.
  vtkNew<vtkAppendPolyData> append;
  append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  append->AddInputData(this->Collect(2, 0)->GetOutput());
  append->AddInputData(this->Collect(2, 1)->GetOutput());
  append->Update();
  vtkNew<vtkPolyData> halved;
  halved->ShallowCopy(append->GetOutput());
  halved->SetFieldData(this->Collect(2, 0)->GetOutput()->GetFieldData());
  vtkNew<vtkMergeCollectors> merge;
  merge->AddInputDataObject(0, halved);
  merge->Update();
  this->ExpectOneError({ "part 1", "rock 1", "(block 101)", "iteration 0", "Merge Collectors" });
}
