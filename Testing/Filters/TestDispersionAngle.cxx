#include "helpers.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDispersionAngle.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <cmath>
#include <numbers>

namespace
{

/// Fans of straight paths that start at (100, 200, 50), run 80 m along an azimuth and end on the
/// ground, with the given lateral deviations there.
class TestDispersionAngle : public FilterTest
{
protected:
  void SetUp() override
  {
    this->FilterTest::SetUp();
    this->Shape->SetName("Shape");
    this->Points->SetDataTypeToDouble();
    this->Paths->SetPoints(this->Points);
    this->Paths->SetLines(this->Lines);
    this->Paths->GetCellData()->AddArray(this->Shape);
    this->Filter->SetInputData(this->Paths);
  }

  void AddPath(int shape, double azimuth, double lateral, double length = 80.0)
  {
    const double c = std::cos(azimuth), s = std::sin(azimuth);
    this->Lines->InsertNextCell(2);
    this->Lines->InsertCellPoint(this->Points->InsertNextPoint(100, 200, 50));
    this->Lines->InsertCellPoint(this->Points->InsertNextPoint(
      100 + length * c - lateral * s, 200 + length * s + lateral * c, 0));
    this->Shape->InsertNextValue(shape);
  }
  vtkTable* Table()
  {
    this->Filter->Update();
    return vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(0));
  }
  double Number(int row, const char* column)
  {
    return this->Table()->GetValueByName(row, column).ToDouble();
  }

  vtkNew<vtkPolyData> Paths;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Lines;
  vtkNew<vtkIntArray> Shape;
  vtkNew<vtkDispersionAngle> Filter;
};

constexpr double rad = std::numbers::pi / 180.0;

} // namespace

TEST_F(TestDispersionAngle, AngleOfAFan)
{
  for (double lateral : { -10.0, 0.0, 10.0 })
  {
    this->AddPath(4, 30 * rad, lateral);
  }
  ASSERT_EQ(this->Table()->GetNumberOfRows(), 1);
  EXPECT_EQ(this->Table()->GetValueByName(0, "Group").ToString(), "icosahedron");
  EXPECT_EQ(this->Number(0, "Trajectories"), 3);
  EXPECT_NEAR(this->Number(0, "Azimuth"), 60.0, 1e-9);
  EXPECT_NEAR(this->Number(0, "L"), 80.0, 1e-9);
  EXPECT_NEAR(this->Number(0, "W"), 20.0, 1e-9);
  EXPECT_NEAR(this->Number(0, "Theta"), std::atan(20.0 / 160.0) / rad, 1e-9);
  EXPECT_NEAR(this->Number(0, "LateralMin"), -10.0, 1e-9);
  EXPECT_NEAR(this->Number(0, "LateralMax"), 10.0, 1e-9);
  EXPECT_NEAR(this->Number(0, "LateralDeviation"), 10.0, 1e-9);
}

TEST_F(TestDispersionAngle, PathsAreCutAtLength)
{
  this->AddPath(0, 0.0, -10.0);
  this->AddPath(0, 0.0, 10.0);
  this->Filter->SetLength(40.0); // half way
  EXPECT_NEAR(this->Number(0, "L"), 40.0, 1e-9);
  EXPECT_NEAR(this->Number(0, "W"), 10.0, 1e-9);
}

TEST_F(TestDispersionAngle, GroupsHaveARowEach)
{
  this->AddPath(4, 0.0, -5.0);
  this->AddPath(0, 0.0, -10.0);
  this->AddPath(4, 0.0, 5.0);
  this->AddPath(0, 0.0, 10.0);
  ASSERT_EQ(this->Table()->GetNumberOfRows(), 2);
  EXPECT_EQ(this->Table()->GetValueByName(0, "Group").ToString(), "cube");
  EXPECT_NEAR(this->Number(0, "W"), 20.0, 1e-9);
  EXPECT_EQ(this->Table()->GetValueByName(1, "Group").ToString(), "icosahedron");
  EXPECT_NEAR(this->Number(1, "W"), 10.0, 1e-9);
  this->Filter->UseGroupsOff();
  ASSERT_EQ(this->Table()->GetNumberOfRows(), 1);
  EXPECT_EQ(this->Number(0, "Trajectories"), 4);
  this->Filter->UseGroupsOn();
  this->Filter->SetGroupBy("");
  ASSERT_EQ(this->Table()->GetNumberOfRows(), 1);
  EXPECT_EQ(this->Number(0, "Trajectories"), 4);
}

TEST_F(TestDispersionAngle, ClassesOfNumbers)
{
  for (const int number : { 3, 1, 7, 5 })
  {
    this->AddPath(number, 0.0, 0.0, 10.0 * number);
  }
  this->Filter->AddClassLimit(3.0);
  this->Filter->AddClassLimit(6.0);
  ASSERT_EQ(this->Table()->GetNumberOfRows(), 3);
  const char* const names[] = { "below 3", "3 to 6", "6 and above" };
  const double counts[] = { 1, 2, 1 }, means[] = { 10, 40, 70 };
  for (int row = 0; row < 3; ++row)
  {
    EXPECT_EQ(this->Table()->GetValueByName(row, "Group").ToString(), names[row]);
    EXPECT_EQ(this->Number(row, "Trajectories"), counts[row]);
    EXPECT_NEAR(this->Number(row, "RunOutMean"), means[row], 1e-9);
  }
  EXPECT_NEAR(this->Number(1, "RunOutDeviation"), std::sqrt(200.0), 1e-9);
  EXPECT_NEAR(this->Number(1, "RunOut50"), 40.0, 1e-9);
  EXPECT_NEAR(this->Number(1, "RunOut90"), 48.0, 1e-9);
  EXPECT_NEAR(this->Number(1, "RunOut99"), 49.8, 1e-9);
  EXPECT_NEAR(this->Number(1, "RunOutMaximum"), 50.0, 1e-9);
  this->Filter->AddClassLimit(6.0);
  EXPECT_EQ(this->Table()->GetNumberOfRows(), 0);
  this->ExpectOneError({ "ClassLimits", "6", "number 3" });
  for (int k = 7; k < 200; ++k)
  {
    this->Filter->AddClassLimit(k);
  }
  EXPECT_EQ(this->Table()->GetNumberOfRows(), 0);
  this->ExpectOneError({ "ClassLimits has 196 values", "100" });
  this->Filter->ClearClassLimits();
  EXPECT_EQ(this->Table()->GetNumberOfRows(), 4);
}

TEST_F(TestDispersionAngle, GivenDirection)
{
  this->AddPath(0, 30 * rad, 0.0);
  this->Filter->AutomaticDirectionOff();
  this->Filter->SetDirection(2.0, 0.0, -7.0); // its z does not count
  EXPECT_NEAR(this->Number(0, "Azimuth"), 90.0, 1e-12);
  EXPECT_NEAR(this->Number(0, "L"), 80 * std::cos(30 * rad), 1e-9);
  EXPECT_NEAR(this->Number(0, "LateralMax"), 80 * std::sin(30 * rad), 1e-9);
  // The other way round there is no angle, and a note says why.
  this->Filter->SetDirection(-2.0, 0.0, 0.0);
  EXPECT_EQ(this->Number(0, "L"), 0.0);
  EXPECT_TRUE(std::isnan(this->Number(0, "Theta")));
  auto* notes =
    vtkStringArray::SafeDownCast(this->Table()->GetFieldData()->GetAbstractArray("Notes"));
  ASSERT_TRUE(notes);
  EXPECT_EQ(notes->GetValue(0).find("1 of 1 groups have no Theta"), 0u) << notes->GetValue(0);
}

TEST_F(TestDispersionAngle, WedgeSpansWidthAndLength)
{
  this->AddPath(0, 0.0, -10.0);
  this->AddPath(0, 0.0, 6.0);
  this->Filter->AutomaticDirectionOff();
  this->Filter->Update();
  auto* wedge = vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(1));
  EXPECT_EQ(wedge->GetNumberOfLines(), 4);
  EXPECT_EQ(wedge->GetPoints()->GetDataType(), VTK_DOUBLE);
  double bounds[6];
  wedge->GetBounds(bounds);
  const double expected[6] = { 100, 180, 190, 206, 0, 50 };
  for (int k = 0; k < 6; ++k)
  {
    EXPECT_NEAR(bounds[k], expected[k], 1e-9);
  }
  EXPECT_NEAR(value(wedge->GetCellData(), "Theta"), this->Number(0, "Theta"), 1e-12);
}

TEST_F(TestDispersionAngle, CoordinateSystemIsThatOfTheTrajectories)
{
  this->AddPath(0, 0.0, 1.0);
  vtkNew<vtkStringArray> crs;
  crs->SetName("TerrainCRS");
  crs->InsertNextValue("somewhere");
  this->Paths->GetFieldData()->AddArray(crs);
  vtkNew<vtkDoubleArray> origin;
  origin->SetName("LocalOrigin");
  origin->SetNumberOfComponents(3);
  origin->InsertNextTuple3(1, 2, 0);
  this->Paths->GetFieldData()->AddArray(origin);
  this->Filter->Update();
  for (int port : { 0, 1 })
  {
    vtkFieldData* data = this->Filter->GetOutputDataObject(port)->GetFieldData();
    auto* copied = vtkStringArray::SafeDownCast(data->GetAbstractArray("TerrainCRS"));
    ASSERT_TRUE(copied) << port;
    EXPECT_EQ(copied->GetValue(0), "somewhere");
    EXPECT_EQ(value(data, "LocalOrigin", 0, 1), 2.0);
  }
}

TEST_F(TestDispersionAngle, FurtherPiecesAreEmpty)
{
  this->Filter->UpdatePiece(1, 2, 0); // as on the second of two ranks, which has no trajectories
  EXPECT_EQ(vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(0))->GetNumberOfRows(), 0);
}

TEST_F(TestDispersionAngle, BadInput)
{
  this->Filter->Update();
  this->ExpectOneError({ "no lines" });
  this->AddPath(0, 0.0, 1.0);
  this->Lines->Modified();
  this->Paths->Modified();
  this->Filter->SetGroupBy("Colour");
  EXPECT_EQ(this->Table()->GetNumberOfRows(), 0);
  this->ExpectOneError({ "Colour" });
  this->Filter->SetGroupBy("Shape");
  this->Filter->SetLength(-1.0);
  EXPECT_EQ(this->Table()->GetNumberOfRows(), 0);
  this->ExpectOneError({ "Length", "-1" });
  this->Filter->SetLength(0.0);
  this->Filter->AutomaticDirectionOff();
  this->Filter->SetDirection(0, 0, 1);
  EXPECT_EQ(this->Table()->GetNumberOfRows(), 0);
  this->ExpectOneError({ "Direction" });
  this->Filter->AutomaticDirectionOn();
  EXPECT_EQ(this->Table()->GetNumberOfRows(), 1);
}

TEST_F(TestDispersionAngle, PrintSelfNamesEveryProperty)
{
  std::ostringstream text;
  this->Filter->Print(text);
  for (const char* name : { "AutomaticDirection", "Direction", "Length", "GroupBy", "ClassLimits",
         "UseGroups", "RelativeToStart" })
  {
    EXPECT_NE(text.str().find(std::string(name) + ":"), std::string::npos) << name;
  }
}
