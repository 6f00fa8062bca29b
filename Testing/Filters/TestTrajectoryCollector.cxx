#include "helpers.h"
#include "trajectories.h"

#include "vtkDEMToCFESource.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkTrajectoryCollector.h"
#include "vtkTrajectoryLayerWriter.h"

#include "gis/layers/sources.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace
{

class TestTrajectoryCollector : public FilterTest
{
protected:
  void SetUp() override
  {
    this->FilterTest::SetUp();
    // Four rocks of 5, 10, 15 and 20 m/s, 1 to 4 m high, past x = 500010; one that stops before.
    for (int rock = 0; rock < 4; ++rock)
    {
      this->Paths.AddLevel(
        2, rock, { 500000, 5100000.0 + 10 * rock, 50 }, 30, 5.0 * (rock + 1), 1.0 + rock);
    }
    this->Paths.AddLevel(2, 4, { 500000, 5100000, 50 }, 5, 5, 1.0, 0);
    this->Points->SetDataTypeToDouble();
    this->Points->InsertNextPoint(500010, 5099990, 0);
    this->Points->InsertNextPoint(500010, 5100100, 0);
    this->Drawn->SetPoints(this->Points);
    vtkNew<vtkCellArray> lines;
    lines->InsertNextCell({ 0, 1 });
    this->Drawn->SetLines(lines);
    this->Filter->SetInputDataObject(0, this->Paths.Data);
  }
  std::string Json(const std::string& properties, double x)
  {
    const std::string east = std::to_string(int(x));
    return this->WriteFile("lines.geojson",
      R"({ "type": "FeatureCollection", "crs": { "type": "name", "properties": { "name": "EPSG:32632" } },
           "features": [ { "type": "Feature", "properties": )" +
        properties + R"(, "geometry": { "type": "LineString", "coordinates": [[)" + east +
        ", 5099990], [" + east + ", 5100100]] } } ] }");
  }
  vtkPolyData* Crossings()
  {
    this->Filter->Update();
    return this->Filter->GetOutput();
  }
  vtkTable* Table(int port)
  {
    this->Filter->Update();
    return vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(port));
  }
  double Number(const char* column, int row = 0, int port = 1)
  {
    return this->Table(port)->GetValueByName(row, column).ToDouble();
  }

  HandMadeTrajectories Paths;
  vtkNew<vtkPolyData> Drawn;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkTrajectoryCollector> Filter;
};

} // namespace

TEST_F(TestTrajectoryCollector, EveryPassingIsARow)
{
  this->Filter->SetInputDataObject(1, this->Drawn);
  vtkPolyData* crossings = this->Crossings();
  ASSERT_EQ(crossings->GetNumberOfPoints(), 4);
  EXPECT_EQ(crossings->GetPoints()->GetDataType(), VTK_DOUBLE);
  vtkPointData* data = crossings->GetPointData();
  for (int k = 0; k < 4; ++k)
  {
    const double speed = 5.0 * (k + 1);
    double point[3];
    crossings->GetPoint(k, point);
    EXPECT_NEAR(point[0], 500010.0, 1e-9);
    EXPECT_NEAR(point[1], 5100000.0 + 10 * k, 1e-9);
    EXPECT_NEAR(value(data, "Time", k), 10.0 / speed, 1e-12);
    EXPECT_NEAR(value(data, "Distance", k), 10.0 + 10 * k, 1e-9);
    EXPECT_NEAR(value(data, "Speed", k), speed, 1e-9);
    EXPECT_NEAR(value(data, "Velocity", k), speed, 1e-9);
    EXPECT_NEAR(value(data, "KineticEnergy", k), 500 * speed * speed + 100, 1e-6);
    EXPECT_NEAR(value(data, "TranslationalEnergy", k), 500 * speed * speed, 1e-6);
    EXPECT_NEAR(value(data, "RotationalEnergy", k), 100, 1e-6);
    EXPECT_NEAR(value(data, "HeightOverGround", k), 1.0 + k, 1e-12);
    EXPECT_NEAR(value(data, "HorizontalAngle", k), 0.0, 1e-9);
    EXPECT_NEAR(value(data, "VerticalAngle", k), 0.0, 1e-9);
    EXPECT_EQ(value(data, "RotationRate", k, 2), 4.0);
    EXPECT_EQ(value(data, "Direction", k), -1); // drawn northwards, passed to its right
    EXPECT_EQ(value(data, "BlockId", k), 100 + k);
    EXPECT_EQ(value(data, "RockId", k), k);
    EXPECT_EQ(value(data, "Iteration", k), 2);
    EXPECT_EQ(value(data, "Fate", k), 1);
    EXPECT_EQ(value(data, "Passing", k), 0);
    EXPECT_EQ(value(data, "Line", k), 0);
  }
  EXPECT_TRUE(crossings->GetFieldData()->GetAbstractArray("TerrainCRS"));
}

TEST_F(TestTrajectoryCollector, LinesAreDrawnOrAcrossThePaths)
{
  // Without any line: square to the mean way, (4 × 30 + 5 + 30) / 6 m along x, in its middle, and a
  // little beyond y = 5100000 … 5100040.
  this->Paths.AddLevel(2, 5, { 500000, 5100040, 50 }, 30, 5.0);
  EXPECT_EQ(this->Table(1)->GetNumberOfRows(), 1);
  const double* placed = this->Filter->GetPlacedLine();
  EXPECT_NEAR(placed[0], 500000.0 + 155.0 / 12.0, 1e-6);
  EXPECT_NEAR(placed[3], placed[0], 1e-6);
  EXPECT_NEAR(placed[1], 5100000.0 - 2.0, 1e-6);
  EXPECT_NEAR(placed[4], 5100040.0 + 2.0, 1e-6);
  EXPECT_EQ(this->Crossings()->GetNumberOfPoints(), 5); // one path is too short
  this->Filter->AddPoint(500010, 5099990, 99);
  this->Filter->AddPoint(500010, 5100100, -7);
  vtkPolyData* crossings = this->Crossings();
  ASSERT_EQ(crossings->GetNumberOfPoints(), 5);
  EXPECT_NEAR(value(crossings->GetPointData(), "Distance", 1), 20.0, 1e-9);
  EXPECT_EQ(this->Table(1)->GetValueByName(0, "LineName").ToString(), "drawn line");
  auto* walls = vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(3));
  ASSERT_TRUE(walls);
  ASSERT_EQ(walls->GetNumberOfCells(), 1); // no slope to follow
  EXPECT_NEAR(value(walls->GetCellData(), "Share"), 5.0 / 6.0, 1e-12);
  double b[6];
  walls->GetBounds(b);
  EXPECT_EQ(b[5] - b[4], 4.0); // BarrierHeight
  // Beside lines that are connected.
  this->Filter->SetInputDataObject(1, this->Drawn);
  EXPECT_EQ(this->Table(1)->GetNumberOfRows(), 2);
  EXPECT_NEAR(this->Number("EnergyInKilojoules", 0, 2), 200.1, 1e-9);
}

TEST_F(TestTrajectoryCollector, SharesAndCurves)
{
  this->Filter->SetInputDataObject(1, this->Drawn);
  this->Filter->SetBarrierHeight(3.0);
  this->Filter->SetBarrierCapacity(60.0); // kJ: 10 m/s has 50.1 kJ, 15 m/s 112.6 kJ
  ASSERT_EQ(this->Table(1)->GetNumberOfRows(), 1);
  EXPECT_EQ(this->Number("Rocks"), 4);
  EXPECT_NEAR(this->Number("Share"), 0.8, 1e-12);
  EXPECT_NEAR(this->Number("ShareError"), std::sqrt(0.16 / 5), 1e-12);
  EXPECT_EQ(this->Number("Caught"), 2);
  EXPECT_NEAR(this->Number("CaughtShare"), 0.5, 1e-12);
  EXPECT_NEAR(this->Number("CaughtShareError"), 0.25, 1e-12);
  EXPECT_NEAR(this->Number("SpeedMean"), 12.5, 1e-9);
  EXPECT_NEAR(this->Number("HeightOverGround50"), 2.5, 1e-12);
  EXPECT_NEAR(this->Number("KineticEnergyMaximum"), 200100.0, 1e-6);
  ASSERT_EQ(this->Table(2)->GetNumberOfRows(), 5);
  EXPECT_NEAR(this->Number("KineticEnergy", 1, 2), 112600.0, 1e-6);
  EXPECT_NEAR(this->Number("HeightOverGround", 1, 2), 3.0, 1e-12);
  EXPECT_NEAR(this->Number("ShareOfPassing", 1, 2), 0.5, 1e-12);
  EXPECT_NEAR(this->Number("ShareOfReleased", 1, 2), 0.4, 1e-12);
  // All have at least nothing.
  EXPECT_EQ(this->Number("KineticEnergy", 4, 2), 0.0);
  EXPECT_EQ(this->Number("EnergyInKilojoules", 4, 2), 0.0);
  EXPECT_EQ(this->Number("HeightOverGround", 4, 2), 0.0);
  EXPECT_EQ(this->Number("ShareOfPassing", 4, 2), 1.0);
  EXPECT_NEAR(this->Number("ShareOfReleased", 4, 2), 0.8, 1e-12);
  this->Filter->SetBarrierHeight(1.5);
  EXPECT_EQ(this->Number("Caught"), 1);
}

TEST_F(TestTrajectoryCollector, NetsThatNobodySellsAreNoted)
{
  const auto noted = [this]
  {
    auto* notes =
      vtkStringArray::SafeDownCast(this->Table(1)->GetFieldData()->GetAbstractArray("Notes"));
    int count = 0;
    for (vtkIdType k = 0; notes && k < notes->GetNumberOfValues(); ++k)
    {
      count += notes->GetValue(k).find("of barriers look implausible, first feature 1") !=
        std::string::npos;
    }
    return count;
  };
  this->Filter->SetInputDataObject(1, this->Drawn);
  EXPECT_EQ(noted(), 0);
  this->Filter->SetBarrierHeight(0.4);
  this->Filter->SetBarrierCapacity(30000.0); // kJ
  EXPECT_EQ(noted(), 2);
  this->Filter->SetBarrierCapacity(0.0); // nothing would be caught, nothing is asked
  EXPECT_EQ(noted(), 0);
}

TEST_F(TestTrajectoryCollector, LinesOfAFile)
{
  this->Filter->SetFileName(
    this->Json(R"({ "name": "road", "height": 2.0, "capacity": 1e5 })", 500003).c_str());
  ASSERT_EQ(this->Table(1)->GetNumberOfRows(), 1);
  EXPECT_EQ(this->Table(1)->GetValueByName(0, "LineName").ToString(), "road");
  EXPECT_EQ(this->Number("Rocks"), 5);
  EXPECT_EQ(this->Number("BarrierHeight"), 2.0);
  EXPECT_EQ(this->Number("BarrierCapacity"), 1e5);
  EXPECT_EQ(this->Number("Caught"), 3);
  this->Filter->SetInputDataObject(1, this->Drawn); // and those that are drawn, before
  ASSERT_EQ(this->Table(1)->GetNumberOfRows(), 2);
  EXPECT_EQ(this->Number("Rocks", 0), 4);
  EXPECT_EQ(this->Number("Rocks", 1), 5);
  EXPECT_EQ(this->Number("BarrierHeight", 0), 4.0);
}

// A report of a name has one line.
TEST_F(TestTrajectoryCollector, LinesOfOneNameAreToldApart)
{
  const std::string y = " 5099990,", end = " 5100100";
  this->Filter->SetFileName(
    this
      ->WriteFile("roads.csv",
        "WKT,name\n\"MULTILINESTRING((500003" + y + "500003" + end + "),(500400" + y + "500400" +
          end + "))\",road\n\"LINESTRING(500010" + y + "500010" + end + ")\",road\n")
      .c_str());
  ASSERT_EQ(this->Table(1)->GetNumberOfRows(), 3);
  EXPECT_EQ(this->Table(1)->GetValueByName(0, "LineName").ToString(), "road");
  EXPECT_EQ(this->Table(1)->GetValueByName(1, "LineName").ToString(), "road (2)");
  EXPECT_EQ(this->Table(1)->GetValueByName(2, "LineName").ToString(), "road (3)");
  EXPECT_TRUE(std::ranges::any_of(this->Heard->Notes,
    [](const std::string& note)
    {
      return note.find("2 of 3 lines have the name of another one and get a number, first "
                       "\"road (2)\"") != std::string::npos;
    }));
}

TEST_F(TestTrajectoryCollector, LineThatNobodyComesToHasNoPassage)
{
  this->Filter->SetFileName(this->Json(R"({ "name": "village" })", 500400).c_str());
  ASSERT_EQ(this->Table(1)->GetNumberOfRows(), 1);
  EXPECT_EQ(this->Number("Rocks"), 0);
  EXPECT_TRUE(this->Heard->Errors.empty());
}

/// Lines count centres: a rock of 3 m that rests 1 m before one lies across it, and is told.
TEST_F(TestTrajectoryCollector, RocksThatLieAcrossALineAreTold)
{
  this->Paths.Data->GetCellData()->GetArray("Width")->SetTuple1(4, 3.0); // rests at 500005
  for (const auto& [x, told] : { std::pair(500006, 1), std::pair(500007, 0) })
  {
    this->Heard->Notes.clear();
    this->Filter->SetFileName(this->Json(R"({ "name": "road" })", x).c_str());
    EXPECT_EQ(this->Number("Rocks"), 4);
    EXPECT_EQ(std::count_if(this->Heard->Notes.begin(), this->Heard->Notes.end(),
                [](const std::string& note)
                {
                  return note.find("On 1 of 1 lines rocks lie whose centre has not passed it, "
                                   "first \"road\" by 1") != std::string::npos;
                }),
      told);
  }
}

TEST_F(TestTrajectoryCollector, BadInput)
{
  const auto expect = [this](const std::vector<std::string>& words)
  {
    this->Filter->Update();
    this->ExpectOneError(words);
    EXPECT_EQ(this->Table(1)->GetNumberOfRows(), 0);
    this->Heard->Errors.clear();
  };
  this->Filter->AddPoint(500010, 5100000, 0);
  expect({ "Points", "no two different places" });
  this->Filter->ClearPoints();
  this->Filter->AddPoint(700000, 5100000, 0);
  this->Filter->AddPoint(700010, 5100000, 0);
  expect({ "drawn line", "far from the trajectories", "700010" });
  this->Filter->ClearPoints();
  this->Filter->SetFileName(this->Json("{}", 600003).c_str());
  expect({ "lines.geojson", "far from the trajectories", "600003" });
  this->Filter->SetFileName("missing.gpkg");
  expect({ "missing.gpkg" });
  this->Filter->SetFileName("");
  this->Filter->SetLayerName("roads"); // not a line that nobody asked for
  expect({ "LayerName is \"roads\"", "FileName names no file" });
  this->Filter->SetLayerName("");
  this->Filter->SetInputDataObject(1, this->Drawn);
  this->Filter->SetBarrierHeight(-1.0);
  expect({ "BarrierHeight is -1" });
  this->Filter->SetBarrierHeight(1.0);
  this->Filter->SetBarrierCapacity(-2.0);
  expect({ "BarrierCapacity is -2" });
  this->Filter->SetBarrierCapacity(2.0);
  vtkNew<vtkPolyData> empty;
  this->Filter->SetInputDataObject(1, empty);
  expect({ "Lines input has no lines" });
  this->Filter->SetInputDataObject(1, this->Drawn);
  vtkNew<vtkDEMToCFESource> slope;
  slope->Update();
  setCrs(slope->GetOutput(), "EPSG:32617");
  this->Filter->SetInputDataObject(2, slope->GetOutput());
  expect({ "trajectories", "EPSG:32632", "Terrain", "EPSG:32617" });
  setCrs(slope->GetOutput(), "EPSG:32632");
  slope->GetOutput()->Modified();
  this->Filter->Modified();
  expect({ "No trajectory of the Input is over the Terrain" });
  this->Filter->SetInputDataObject(2, nullptr);
  this->Points->SetPoint(0, 10, 9990, 0); // in local coordinates
  this->Points->SetPoint(1, 10, 10100, 0);
  this->Points->Modified();
  this->Drawn->Modified();
  expect({ "Lines input", "far from the trajectories", "x 10 to 10" });
}

TEST_F(TestTrajectoryCollector, WrittenAsGeoPackage)
{
  this->Filter->SetInputDataObject(1, this->Drawn);
  vtkNew<vtkTrajectoryLayerWriter> writer;
  const std::string path = this->WriteFile("crossings.gpkg", "older");
  writer->SetFileName(path.c_str());
  writer->SetInputConnection(this->Filter->GetOutputPort());
  EXPECT_EQ(writer->Write(), 1);
  const auto [rows, crs, ownCrs, notes] = rockfall::readSourceLayer(path, {});
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_NEAR((rows[2].position - rockfall::Vec3(500010, 5100020, 50)).norm(), 0.0, 1e-9);
  EXPECT_NE(crs.find("UTM zone 32N"), std::string::npos);

  vtkNew<vtkPolyData> empty;
  writer->SetInputDataObject(empty);
  writer->Write();
  this->ExpectOneError({ "crossings.gpkg", "neither lines nor vertices" });
  EXPECT_EQ(rockfall::readSourceLayer(path, {}).rows.size(), 4u); // as it was
}

TEST_F(TestTrajectoryCollector, PrintSelfNamesEveryProperty)
{
  std::ostringstream text;
  this->Filter->Print(text);
  for (const char* name : { "FileName", "BarrierHeight", "BarrierCapacity" })
  {
    EXPECT_NE(text.str().find(std::string(name) + ":"), std::string::npos) << name;
  }
}
