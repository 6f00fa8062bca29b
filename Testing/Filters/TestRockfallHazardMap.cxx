#include "helpers.h"
#include "trajectories.h"

#include "vtkCell.h"
#include "vtkDEMToCFESource.h"
#include "vtkHazardMapWriter.h"
#include "vtkHazardPassageReader.h"
#include "vtkHazardPassageWriter.h"
#include "vtkImageData.h"
#include "vtkRockfallHazardMap.h"

#include "gis/raster/raster.h"

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

namespace
{

class TestRockfallHazardMap : public FilterTest
{
protected:
  void SetUp() override
  {
    this->FilterTest::SetUp();
    this->Filter->SetInputDataObject(0, this->Paths.Data);
  }

  /// Adds statistics that the map has beside the usual ones.
  void AddStatistics(std::initializer_list<int> numbers)
  {
    for (const int number : numbers)
    {
      this->Filter->AddStatistic(number);
    }
  }
  vtkImageData* Map()
  {
    this->Filter->Update();
    return this->Filter->GetOutput();
  }
  double At(const char* array, double x, double y) { return ValueAt(this->Map(), array, x, y); }
  static double ValueAt(vtkImageData* map, const char* array, double x, double y)
  {
    int ijk[3];
    double local[3];
    const double point[3] = { x, y, 0.0 };
    if (!map->ComputeStructuredCoordinates(point, ijk, local))
    {
      ADD_FAILURE() << x << ", " << y << " is not in the map";
      return 0.0;
    }
    return value(map->GetCellData(), array, map->ComputeCellId(ijk));
  }

  HandMadeTrajectories Paths;
  vtkNew<vtkRockfallHazardMap> Filter;
};

} // namespace

TEST_F(TestRockfallHazardMap, CellsOfTheWorld)
{
  // Of 5 m cells: cells are multiples of 5 m in the world, the map ends where the paths do.
  this->Paths.AddLevel(0, 0, { 500001, 4000003, 50 }, 20, 10, 2.0, 0);
  this->Paths.AddLevel(1, 0, { 500001, 4000003, 50 }, 9, 20);
  this->Paths.AddLevel(1, 1, { 500001, 4000013, 50 }, 20, 5);
  this->Filter->SetCellSize(5.0);
  this->AddStatistics({ 2, 3, 5 });
  vtkImageData* map = this->Map();
  EXPECT_EQ(map->GetDataObjectType(), VTK_IMAGE_DATA);
  const int* size = map->GetDimensions();
  EXPECT_EQ(size[0], 6);
  EXPECT_EQ(size[1], 4);
  EXPECT_EQ(size[2], 1);
  EXPECT_EQ(map->GetOrigin()[0], 500000.0);
  EXPECT_EQ(map->GetOrigin()[1], 4000000.0);
  EXPECT_EQ(map->GetSpacing()[0], 5.0);

  EXPECT_EQ(this->At("Rocks", 500007, 4000002), 2.0);
  EXPECT_EQ(this->At("Passages", 500007, 4000002), 2.0);
  EXPECT_NEAR(this->At("ReachProbability", 500007, 4000002), 2.0 / 3.0, 1e-7); // floats
  EXPECT_NEAR(this->At("ReachProbabilityError", 500007, 4000002), std::sqrt(2.0 / 9.0 / 3.0), 1e-7);
  EXPECT_NEAR(this->At("SpeedMean", 500007, 4000002), 15.0, 1e-5);
  EXPECT_NEAR(this->At("SpeedMaximum", 500007, 4000002), 20.0, 1e-5);
  EXPECT_NEAR(this->At("Speed90", 500007, 4000002), 19.0, 1e-5);
  EXPECT_NEAR(this->At("KineticEnergy50", 500007, 4000002), 125100.0, 0.1);
  EXPECT_NEAR(this->At("HeightOverGroundMaximum", 500007, 4000002), 2.0, 1e-6);
  EXPECT_NEAR(this->At("RotationRate99", 500007, 4000002), 5.0, 1e-6);
  EXPECT_EQ(this->At("Rocks", 500017, 4000002), 1.0);
  EXPECT_EQ(this->At("StoppingPoints", 500022, 4000002), 1.0); // the others left
  EXPECT_EQ(this->At("StoppingPoints", 500012, 4000002), 0.0);
  EXPECT_EQ(this->At("Rocks", 500007, 4000007), 0.0);
  EXPECT_EQ(this->At("ReachProbability", 500007, 4000007), 0.0);
  EXPECT_TRUE(std::isnan(this->At("SpeedMean", 500007, 4000007)));
  auto* crs = vtkStringArray::SafeDownCast(map->GetFieldData()->GetAbstractArray("TerrainCRS"));
  ASSERT_TRUE(crs);
  EXPECT_EQ(crs->GetValue(0), "EPSG:32632");
}

TEST_F(TestRockfallHazardMap, CellsOfTheTerrain)
{
  vtkNew<vtkDEMToCFESource> slope; // the default slope: 250 × 100 m, cells of 5 m
  this->Filter->SetInputConnection(1, slope->GetOutputPort());
  this->Paths.AddLevel(0, 0, { 101, 52, 80 }, 20, 10);
  this->Filter->CropToTrajectoriesOff();
  vtkImageData* map = this->Map();
  double slopeBounds[6], bounds[6];
  vtkPolyData* mesh = slope->GetOutput();
  mesh->GetBounds(slopeBounds);
  map->GetBounds(bounds);
  for (int k = 0; k < 4; ++k)
  {
    EXPECT_EQ(bounds[k], slopeBounds[k]) << k; // nodes are corners of cells
  }
  const vtkIdType cells = map->GetNumberOfCells();
  EXPECT_EQ(cells, mesh->GetNumberOfCells() / 2);
  EXPECT_EQ(this->At("Rocks", 103, 53), 1.0);
  double corner[3];
  map->GetPoint(0, corner);
  EXPECT_NEAR(value(map->GetPointData(), "Elevation"), slopeBounds[5], 1e-4); // its top, in floats

  this->Filter->CropToTrajectoriesOn();
  map = this->Map();
  map->GetBounds(bounds);
  EXPECT_EQ(bounds[0], 100.0);
  EXPECT_EQ(bounds[1], 125.0);
  EXPECT_EQ(bounds[2], 50.0);
  EXPECT_EQ(bounds[3], 55.0);
  EXPECT_EQ(this->At("Rocks", 103, 53), 1.0);
}

TEST_F(TestRockfallHazardMap, TrajectoriesBringTheirSlope)
{
  vtkNew<vtkDEMToCFESource> slope;
  slope->Update();
  this->Paths.AddLevel(0, 0, { 51, 52, 80 }, 20, 10);
  vtkFieldData* fields = this->Paths.Data->GetFieldData();
  for (int k = 0; k < slope->GetOutput()->GetFieldData()->GetNumberOfArrays(); ++k)
  {
    fields->AddArray(slope->GetOutput()->GetFieldData()->GetAbstractArray(k));
  }
  vtkImageData* map = this->Map(); // no cell size, no terrain
  EXPECT_EQ(map->GetNumberOfCells(), 5);
  EXPECT_EQ(map->GetSpacing()[0], 5.0);
  EXPECT_TRUE(map->GetPointData()->GetArray("Elevation"));
}

TEST_F(TestRockfallHazardMap, DrapedOnTheSlope)
{
  vtkNew<vtkDEMToCFESource> slope;
  this->Filter->SetInputConnection(1, slope->GetOutputPort());
  this->Paths.AddLevel(0, 0, { 51, 52, 80 }, 20, 10);
  this->Paths.AddLevel(0, 1, { 51, 72, 80 }, 20, 20);
  this->AddStatistics({ 2 });
  vtkImageData* map = this->Map();
  EXPECT_EQ(map->GetNumberOfCells(), 25);
  auto* draped = vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(1));
  ASSERT_TRUE(draped);
  ASSERT_EQ(
    draped->GetNumberOfCells(), 20); // two triangles each, without those that nothing passed
  EXPECT_EQ(draped->GetPoints()->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(draped->GetNumberOfPoints(), 24);
  EXPECT_FALSE(draped->GetFieldData()->GetArray("HazardMap"));
  EXPECT_STREQ(draped->GetCellData()->GetScalars()->GetName(), "ReachProbability");
  EXPECT_EQ(value(draped->GetCellData(), "Speed50", 0), 10.0);
  EXPECT_EQ(value(draped->GetCellData(), "Speed50", 10), 20.0);
  double b[6];
  draped->GetBounds(b);
  const double top = 57.7 * (1.0 - 0.50), foot = 57.7 * (1.0 - 0.75), lift = 0.1;
  EXPECT_EQ(b[0], 50.0);
  EXPECT_EQ(b[1], 75.0);
  EXPECT_EQ(b[2], 50.0);
  EXPECT_EQ(b[3], 75.0);
  EXPECT_NEAR(b[5], top + lift, 1e-4); // heights of the map are floats
  EXPECT_NEAR(b[4], foot + lift, 1e-4);
  // Cut from the north-west to the south-east, as the slope is.
  for (const auto& [cell, first, second] : { std::array{ 0, 0, 2 }, std::array{ 1, 0, 1 } })
  {
    double from[3], to[3];
    draped->GetPoint(draped->GetCell(cell)->GetPointId(first), from);
    draped->GetPoint(draped->GetCell(cell)->GetPointId(second), to);
    EXPECT_EQ(from[1] - to[1], 5.0);
    EXPECT_EQ(to[0] - from[0], 5.0);
  }
}

TEST_F(TestRockfallHazardMap, HasTheStatisticsThatAreChosen)
{
  this->Paths.AddLevel(0, 0, { 1, 3, 50 }, 20, 10);
  this->Filter->SetCellSize(5.0);
  const auto names = [this]
  {
    vtkCellData* data = this->Map()->GetCellData();
    std::vector<std::string> all;
    for (int k = 8; k < data->GetNumberOfArrays(); ++k) // after counts, probabilities and angles
    {
      all.emplace_back(data->GetArrayName(k));
    }
    // Behind them, where there is a quantile, which one the rocks of a cell can give.
    if (!all.empty() && all.back() == "HighestQuantile")
    {
      all.pop_back();
    }
    return all;
  };
  ASSERT_EQ(names().size(), 12u);
  EXPECT_EQ(names()[0], "KineticEnergyMean");
  EXPECT_EQ(names()[1], "KineticEnergyMaximum");
  EXPECT_EQ(names()[2], "KineticEnergy95");
  this->Filter->RemoveAllStatistics();
  EXPECT_TRUE(names().empty());
  this->AddStatistics({ 5, 1, 5 }); // each once, in the order of the numbers
  EXPECT_EQ(names(),
    (std::vector<std::string>{ "KineticEnergyMaximum", "KineticEnergy99", "SpeedMaximum", "Speed99",
      "HeightOverGroundMaximum", "HeightOverGround99", "RotationRateMaximum", "RotationRate99" }));
  EXPECT_EQ(value(this->Map()->GetCellData(), "SpeedMaximum", 1), 10.0);
}

/// Two rocks released at (1, 3, 50), one of which goes 20 m down at 45° and one 30 m down over 20 m.
TEST_F(TestRockfallHazardMap, EnergyLineAnglesAndWhatIsLeftEmpty)
{
  this->Paths.AddLevel(0, 0, { 1, 3, 50 }, 20, 10);
  this->Paths.AddLevel(1, 0, { 1, 3, 50 }, 20, 10);
  this->Paths.AddLevel(2, 0, { 1, 13, 50 }, 3, 10);
  const double ends[] = { 30.0, 20.0 };
  for (int k = 0; k < 2; ++k)
  {
    this->Paths.Points->SetPoint(2 * k + 1, 21, 3, ends[k]);
    for (int end = 0; end < 2; ++end) // straight down the line
    {
      this->Paths.Data->GetPointData()
        ->GetArray("Velocity")
        ->SetTuple3(2 * k + end, 10.0, 0.0, (ends[k] - 50.0) / 2);
    }
  }
  this->Filter->SetCellSize(5.0);
  const double steep = std::atan(1.5) * 180.0 / std::acos(-1.0);
  for (const double x : { 7.0, 12.0, 20.5 })
  {
    EXPECT_NEAR(this->At("EnergyLineAngleMinimum", x, 3), 45.0, 0.001);
    EXPECT_NEAR(this->At("EnergyLineAngleMean", x, 3), 0.5 * (45.0 + steep), 0.001);
  }
  EXPECT_EQ(this->At("EnergyLineAngleMinimum", 2, 13), 0.0); // level
  EXPECT_TRUE(std::isnan(this->At("EnergyLineAngleMean", 7, 13)));
  EXPECT_FALSE(this->Map()->GetFieldData()->GetArray("LeastReach"));

  // Without what is flatter than 50°: of two rocks one is left.
  this->Filter->SetAnnualFrequency(0.25);
  this->Filter->SetLeastAngle(50.0);
  EXPECT_EQ(this->At("Rocks", 7, 3), 1.0);
  EXPECT_NEAR(this->At("EnergyLineAngleMinimum", 7, 3), steep, 0.001);
  EXPECT_FLOAT_EQ(float(this->At("AnnualFrequency", 7, 3)), 0.25F / 3.0F);
  EXPECT_FALSE(std::isnan(this->At("ReachProbabilityError", 7, 3)));
  EXPECT_EQ(this->At("Rocks", 2, 13), 0.0);
  EXPECT_TRUE(std::isnan(this->At("ReachProbabilityError", 2, 13)));
  EXPECT_EQ(value(this->Map()->GetFieldData(), "CellsLeftEmpty"), 1.0);
  this->Filter->SetAnnualFrequency(0.0);
  this->Filter->SetLeastAngle(0.0);

  // What one rock of three reaches is left empty.
  this->Filter->SetLeastReach(0.5);
  EXPECT_EQ(this->At("Rocks", 2, 13), 0.0);
  EXPECT_TRUE(std::isnan(this->At("ReachProbabilityError", 2, 13)));
  EXPECT_EQ(this->At("Rocks", 7, 3), 2.0);
  EXPECT_EQ(value(this->Map()->GetFieldData(), "CellsLeftEmpty"), 1.0);
  this->Filter->SetAnnualFrequency(0.25);
  this->Filter->SetLeastAngle(50.0);
  EXPECT_EQ(this->At("AnnualFrequency", 7, 3), 0.0);
  EXPECT_EQ(value(this->Map()->GetFieldData(), "LeastAngle"), 50.0);
  auto* notes =
    vtkStringArray::SafeDownCast(this->Map()->GetFieldData()->GetAbstractArray("Notes"));
  ASSERT_TRUE(notes);
  EXPECT_NE(notes->GetValue(notes->GetNumberOfValues() - 1).find("LeastAngle, 50 degrees"),
    std::string::npos);
  this->Filter->SetLeastReach(1.5);
  EXPECT_EQ(this->Map()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "LeastReach is 1.5" });
}

/// Where rocks of different frequencies come to one cell, quantiles count each alike, and say so.
TEST_F(TestRockfallHazardMap, QuantilesOfRocksThatDifferInFrequency)
{
  vtkNew<vtkDoubleArray> frequency;
  frequency->SetName("Frequency");
  for (int rock = 0; rock < 2; ++rock)
  {
    this->Paths.AddLevel(0, rock, { 1, 3.0 + 10 * rock, 50 }, 20, 10);
    frequency->InsertNextValue(rock == 0 ? 0.5 : 0.01);
  }
  this->Paths.Data->GetCellData()->AddArray(frequency);
  const auto told = [this]
  {
    auto* notes =
      vtkStringArray::SafeDownCast(this->Map()->GetFieldData()->GetAbstractArray("Notes"));
    int count = 0;
    for (vtkIdType k = 0; notes && k < notes->GetNumberOfValues(); ++k)
    {
      count += notes->GetValue(k).find("by up to 50 times") != std::string::npos;
    }
    return count;
  };
  this->Filter->SetCellSize(5.0); // apart
  EXPECT_EQ(told(), 0);
  this->Filter->SetCellSize(40.0);
  EXPECT_EQ(told(), 1);
  this->Filter->RemoveAllStatistics();
  this->AddStatistics({ 1 });
  EXPECT_EQ(told(), 0);
}

/// Further rocks of another source do not make outliers of those that always come.
TEST_F(TestRockfallHazardMap, LeastReachAsksEachSource)
{
  vtkNew<vtkIdTypeArray> source;
  source->SetName("SourceId");
  for (int k = 0; k < 12; ++k) // rock 0 is the one of source 1; the last of source 2 goes apart
  {
    this->Paths.AddLevel(k / 4, k % 4, { 1, k % 4 == 0 ? 3.0 : k == 11 ? 23.0 : 13.0, 50 }, 20, 10);
    source->InsertNextValue(k % 4 == 0 ? 1 : 2);
  }
  this->Paths.Data->GetCellData()->AddArray(source);
  this->Filter->SetCellSize(5.0);
  this->Filter->SetLeastReach(0.5);
  const auto check = [](vtkImageData* map)
  {
    EXPECT_EQ(ValueAt(map, "Rocks", 7, 3), 3.0); // a quarter of all
    EXPECT_EQ(ValueAt(map, "Rocks", 7, 13), 8.0);
    EXPECT_EQ(ValueAt(map, "Rocks", 7, 23), 0.0); // a ninth of its source
  };
  check(this->Map());
  vtkNew<vtkDEMToCFESource> terrain;
  terrain->Update();
  this->Paths.Data->GetFieldData()->RemoveArray("TerrainCRS");
  vtkNew<vtkHazardPassageWriter> writer;
  writer->SetInputDataObject(0, this->Paths.Data);
  writer->SetInputConnection(1, terrain->GetOutputPort());
  writer->SetCellSize(5.0);
  const std::string name = this->WriteFile("sources.passages", "");
  writer->SetFileName(name.c_str());
  writer->Write();
  vtkNew<vtkHazardPassageReader> reader;
  reader->AddFileName(name.c_str());
  reader->SetLeastReach(0.5);
  reader->Update();
  check(reader->GetOutput());
}

/// The same run under other block ids, in a file of its own: its frequencies come twice.
TEST_F(TestRockfallHazardMap, ARunThatWasMadeAgainInFiles)
{
  vtkNew<vtkDEMToCFESource> terrain;
  terrain->Update();
  const auto notesOf = [&](double speed, int blocks)
  {
    vtkNew<vtkHazardPassageReader> reader;
    for (const int run : { 0, 1 })
    {
      HandMadeTrajectories paths;
      vtkNew<vtkIdTypeArray> source;
      source->SetName("SourceId");
      for (int rock = 0; rock < 4; ++rock)
      {
        paths.AddLevel(0, rock, { 1, 3.0 + 2 * rock, 50 }, 20, run == 0 ? 5.0 : speed);
        paths.Data->GetCellData()->GetArray("BlockId")->SetTuple1(rock, run * blocks + rock);
        source->InsertNextValue(1);
      }
      paths.AddLevel(0, 4, { 1, 23, 50 }, 20, 5.0 + run); // one that differs
      paths.Data->GetCellData()->GetArray("BlockId")->SetTuple1(4, run * blocks + 4);
      source->InsertNextValue(1);
      paths.Data->GetCellData()->AddArray(source);
      paths.Data->GetFieldData()->RemoveArray("TerrainCRS");
      vtkNew<vtkHazardPassageWriter> writer;
      writer->SetInputDataObject(0, paths.Data);
      writer->SetInputConnection(1, terrain->GetOutputPort());
      writer->SetCellSize(5.0);
      const std::string name = this->WriteFile(std::to_string(run) + ".passages", "");
      writer->SetFileName(name.c_str());
      writer->Write();
      reader->AddFileName(name.c_str());
    }
    reader->Update();
    std::string all;
    auto* notes =
      vtkStringArray::SafeDownCast(reader->GetOutput()->GetFieldData()->GetAbstractArray("Notes"));
    for (vtkIdType k = 0; notes && k < notes->GetNumberOfValues(); ++k)
    {
      all += notes->GetValue(k) + "\n";
    }
    return all;
  };
  EXPECT_NE(notesOf(5.0, 10).find("4 rocks fell exactly as another one of their iteration"),
    std::string::npos);
  EXPECT_EQ(notesOf(6.0, 10).find("fell exactly"), std::string::npos);
}

/// A scenario that is shared out over files gives the map of the whole, frequencies and all.
TEST_F(TestRockfallHazardMap, FrequenciesGoThroughFiles)
{
  const auto add = [](HandMadeTrajectories& paths, vtkDoubleArray* frequency, int parts, int part)
  {
    for (int k = 0; k < 12; ++k)
    {
      if (k % parts == part)
      {
        const int rock = k % 4;
        paths.AddLevel(k / 4, rock, { 1, 3.0 + 2 * rock, 50 }, 20, 5.0 + 3 * k);
        frequency->InsertNextValue(std::ldexp(0.3, -2 * rock)); // sums hang on their order
      }
    }
    paths.Data->GetCellData()->AddArray(frequency);
  };
  vtkNew<vtkDEMToCFESource> terrain;
  terrain->Update();
  std::vector<std::string> maps;
  for (const int parts : { 1, 3, 5 })
  {
    vtkNew<vtkHazardPassageReader> reader;
    for (int part = 0; part < parts; ++part)
    {
      HandMadeTrajectories paths;
      vtkNew<vtkDoubleArray> frequency;
      frequency->SetName("Frequency");
      add(paths, frequency, parts, part);
      paths.Data->GetFieldData()->RemoveArray("TerrainCRS");
      vtkNew<vtkHazardPassageWriter> writer;
      writer->SetInputDataObject(0, paths.Data);
      writer->SetInputConnection(1, terrain->GetOutputPort());
      writer->SetCellSize(5.0);
      const std::string name = this->WriteFile(std::to_string(part) + ".passages", "");
      writer->SetFileName(name.c_str());
      writer->Write();
      reader->AddFileName(name.c_str());
    }
    reader->Update();
    vtkImageData* map = reader->GetOutput();
    ASSERT_TRUE(map->GetCellData()->GetArray("AnnualFrequency30kJ"));
    ASSERT_GT(map->GetCellData()->GetArray("AnnualFrequency")->GetRange()[1], 0.3);
    std::ostringstream bits;
    bits.precision(17);
    for (int a = 0; a < map->GetCellData()->GetNumberOfArrays(); ++a)
    {
      vtkDataArray* array = map->GetCellData()->GetArray(a);
      bits << "\n" << array->GetName();
      for (vtkIdType k = 0; k < array->GetNumberOfValues(); ++k)
      {
        bits << " " << array->GetComponent(k, 0);
      }
    }
    maps.push_back(bits.str());
  }
  EXPECT_EQ(maps[1], maps[0]);
  EXPECT_EQ(maps[2], maps[0]);
}

TEST_F(TestRockfallHazardMap, FrequenciesAndIntensities)
{
  // 1000 kg: 10 m/s are 50.1 kJ, 30 m/s are 450.1 kJ, 5 m/s are 12.6 kJ.
  this->Paths.AddLevel(0, 0, { 1, 3, 50 }, 8, 10);
  this->Paths.AddLevel(0, 1, { 1, 3, 50 }, 3, 30);
  this->Paths.AddLevel(1, 0, { 1, 3, 50 }, 8, 5);
  this->Paths.AddLevel(1, 1, { 1, 13, 50 }, 3, 30);
  this->Filter->SetCellSize(5.0);
  EXPECT_EQ(this->Map()->GetCellData()->GetArray("AnnualFrequency"), nullptr);

  this->Filter->SetAnnualFrequency(0.0625); // 1/64 for each of the four
  EXPECT_EQ(this->At("AnnualFrequency", 2, 3), 3.0 / 64);
  EXPECT_EQ(this->At("AnnualFrequency30kJ", 2, 3), 2.0 / 64);
  EXPECT_EQ(this->At("AnnualFrequency300kJ", 2, 3), 1.0 / 64);
  EXPECT_EQ(this->At("ExceedanceProbability30kJ", 2, 3), 0.5);
  EXPECT_EQ(this->At("ExceedanceProbability300kJ", 2, 3), 0.25);
  EXPECT_EQ(this->At("ReturnPeriod", 7, 3), 32.0);
  EXPECT_EQ(this->At("PassageProbability100a", 7, 3), float(-std::expm1(-100.0 / 32)));
  EXPECT_EQ(this->At("PassageProbability100a", 7, 8), 0.0);
  EXPECT_NEAR(
    value(this->Map()->GetFieldData(), "AnnualFrequencyLimit"), std::log(20.0) / 64, 1e-15);
  EXPECT_EQ(this->At("Intensity30a", 2, 3), 1.0);
  EXPECT_EQ(this->At("Intensity100a", 2, 3), 3.0);
  EXPECT_EQ(this->At("Intensity30a", 7, 3), 0.0);
  EXPECT_EQ(this->At("AnnualFrequency", 7, 8), 0.0);
  EXPECT_TRUE(std::isnan(this->At("ReturnPeriod", 7, 8)));

  // A return period where a frequency is meant.
  this->Filter->SetAnnualFrequency(300.0);
  auto* notes =
    vtkStringArray::SafeDownCast(this->Map()->GetFieldData()->GetAbstractArray("Notes"));
  ASSERT_TRUE(notes);
  EXPECT_NE(notes->GetValue(notes->GetNumberOfValues() - 1).find("fall 300 times a year"),
    std::string::npos);

  // By rocks: 1/4 a year for rock 0, 1/128 for rock 1.
  this->Filter->SetAnnualFrequency(0.0);
  vtkNew<vtkDoubleArray> frequency;
  frequency->SetName("Frequency");
  for (const double value : { 0.25, 0.0078125, 0.25, 0.0078125 })
  {
    frequency->InsertNextValue(value);
  }
  this->Paths.Data->GetCellData()->AddArray(frequency);
  this->Paths.Data->Modified();
  EXPECT_EQ(this->At("AnnualFrequency", 2, 3), 0.25 + 1.0 / 256);
  EXPECT_EQ(this->At("AnnualFrequency30kJ", 2, 3), 0.125 + 1.0 / 256);
  EXPECT_EQ(this->At("AnnualFrequency300kJ", 2, 3), 1.0 / 256);
  EXPECT_EQ(this->At("Intensity30a", 2, 3), 2.0);
  EXPECT_EQ(this->At("Intensity300a", 2, 3), 3.0);
  this->Filter->RemoveAllEnergyThresholds();
  for (const double threshold : { 50.0, 12.0, 50.0 }) // each once, in their order
  {
    this->Filter->AddEnergyThreshold(threshold);
  }
  EXPECT_EQ(this->At("AnnualFrequency12kJ", 7, 3), 0.25);
  EXPECT_EQ(this->At("AnnualFrequency50kJ", 7, 3), 0.125);

  const auto expect = [this](const std::vector<std::string>& words)
  {
    EXPECT_EQ(this->Map()->GetNumberOfCells(), 0);
    this->ExpectOneError(words);
  };
  this->Filter->AddEnergyThreshold(0.0);
  expect({ "EnergyThresholds has 0 kJ" });
  this->Filter->RemoveAllEnergyThresholds();
  this->Filter->AddReturnPeriod(-1.0);
  expect({ "ReturnPeriods has -1 a" });
  this->Filter->RemoveAllReturnPeriods();
  for (int k = 1; k <= 20000; ++k) // minutes, and gigabytes of arrays
  {
    this->Filter->AddReturnPeriod(k);
  }
  expect({ "ReturnPeriods has 20000 values", "100" });
  this->Filter->RemoveAllReturnPeriods();
  this->Filter->SetAnnualFrequency(-2.0);
  expect({ "AnnualFrequency is -2" });
  this->Filter->SetAnnualFrequency(0.0);
  frequency->SetValue(2, 0.5);
  this->Paths.Data->Modified();
  expect({ "Frequency of rock 0", "0.5", "0.25" });
}

TEST_F(TestRockfallHazardMap, WrittenAsGeoTiff)
{
  this->Paths.AddLevel(0, 0, { 500001, 5100003, 50 }, 20, 10);
  this->Paths.AddLevel(0, 1, { 500001, 5100013, 50 }, 20, 10);
  this->Filter->SetCellSize(5.0);
  vtkNew<vtkHazardMapWriter> writer;
  const std::string path = this->WriteFile("map.tif", "older");
  writer->SetFileName(path.c_str());
  writer->SetInputConnection(this->Filter->GetOutputPort());
  EXPECT_EQ(writer->Write(), 1);
  const rockfall::RasterSurface read = rockfall::readRaster(path, { .cellSize = 0.0, .band = 2 });
  EXPECT_EQ(read.geometry.xOrigin, 500002.5);
  EXPECT_EQ(read.geometry.yOrigin, 5100002.5);
  EXPECT_NE(read.geometry.crs.find("UTM zone 32N"), std::string::npos);
  const std::vector<double> rocks = { 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1 };
  EXPECT_EQ(read.heights, rocks);

  vtkNew<vtkImageData> other;
  other->SetDimensions(2, 2, 1);
  writer->SetInputDataObject(other);
  writer->Write();
  this->ExpectOneError({ "no hazard map" });
  vtkNew<vtkImageData> resampled; // as ParaView's Resample To Image makes it
  resampled->DeepCopy(this->Filter->GetOutput());
  resampled->SetSpacing(5.0, 2.5, 1.0);
  writer->SetInputDataObject(resampled);
  writer->Write();
  this->ExpectOneError({ "5 x 2.5 m", "square" });
  EXPECT_EQ(rockfall::readRaster(path, { .cellSize = 0.0, .band = 2 }).heights, rocks);
}

/// A file that goes from hand to hand says by itself what is left out, and whom the run lost.
TEST_F(TestRockfallHazardMap, AGeoTiffHasTheNumbersAndNotesOfItsMap)
{
  this->Paths.AddLevel(0, 0, { 500001, 5100003, 50 }, 20, 10);
  this->Paths.AddLevel(0, 1, { 500001, 5100013, 50 }, 20, 10, 2.0, 2); // still moves
  this->Filter->SetCellSize(5.0);
  this->Filter->SetLeastReach(0.25);
  vtkNew<vtkHazardMapWriter> writer;
  const std::string path = this->WriteFile("map.tif", "");
  writer->SetFileName(path.c_str());
  writer->SetInputConnection(this->Filter->GetOutputPort());
  EXPECT_EQ(writer->Write(), 1);
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{ std::istreambuf_iterator<char>(in), {} };
  for (const char* item : { "<Item name=\"LeastReach\">0.25</Item>",
         "<Item name=\"RocksMoving\">1</Item>", "<Item name=\"Trajectories\">2</Item>",
         "<Item name=\"Note 1\">1 of 2 rocks were still moving" })
  {
    EXPECT_NE(bytes.find(item), std::string::npos) << item;
  }
}

TEST_F(TestRockfallHazardMap, BadInput)
{
  const auto expect = [this](const std::vector<std::string>& words)
  {
    EXPECT_EQ(this->Map()->GetNumberOfCells(), 0);
    this->ExpectOneError(words);
  };
  expect({ "no lines" });
  this->Paths.AddLevel(0, 0, { 1, 3, 50 }, 20, 10);
  expect({ "CellSize is 0", "Terrain" });
  this->Filter->SetCellSize(-1.0);
  expect({ "CellSize is -1" });
  this->Filter->SetCellSize(1e-7);
  expect({ "more than 50000000", "CellSize", "CropToTrajectories" });
  this->Filter->SetCellSize(5.0);
  this->AddStatistics({ 6 });
  expect({ "Statistics has 6", "0 to 5" });
  this->Filter->RemoveAllStatistics();
  EXPECT_EQ(this->Map()->GetNumberOfCells(), 5);
  this->Paths.AddLevel(0, 0, { 1, 3, 50 }, 20, 10);
  expect({ "iteration 0, rock 0", "twice" });
  this->Paths.Data->GetPointData()->RemoveArray("Velocity");
  this->Paths.Data->Modified();
  expect({ "Velocity" });
  vtkNew<vtkDEMToCFESource> slope;
  HandMadeTrajectories far;
  far.AddLevel(0, 0, { 5000, 3, 50 }, 20, 10);
  this->Filter->SetInputDataObject(0, far.Data);
  this->Filter->SetInputConnection(1, slope->GetOutputPort());
  expect({ "No trajectory" });
  this->Filter->CropToTrajectoriesOff();
  expect({ "No trajectory" });
}

TEST_F(TestRockfallHazardMap, TerrainOfAnotherPlaceOrCrs)
{
  vtkNew<vtkDEMToCFESource> slope;
  slope->Update();
  vtkNew<vtkPolyData> elsewhere;
  elsewhere->DeepCopy(slope->GetOutput());
  setCrs(elsewhere, "EPSG:32617");
  this->Paths.AddLevel(0, 0, { 101, 52, 80 }, 20, 10);
  this->Filter->SetInputDataObject(1, elsewhere);
  EXPECT_EQ(this->Map()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "trajectories", "EPSG:32632", "Terrain", "EPSG:32617" });

  vtkNew<vtkHazardPassageWriter> writer;
  const std::string path = this->WriteFile("run.passages", "older");
  writer->SetFileName(path.c_str());
  writer->SetInputDataObject(0, this->Paths.Data);
  writer->SetInputDataObject(1, elsewhere);
  writer->Write();
  this->ExpectOneError({ "trajectories", "EPSG:32632", "Terrain", "EPSG:32617" });
  HandMadeTrajectories far;
  far.AddLevel(0, 0, { 5000, 3, 50 }, 20, 10);
  writer->SetInputDataObject(0, far.Data);
  writer->SetInputDataObject(1, slope->GetOutput());
  writer->Write();
  this->ExpectOneError({ "No trajectory" });
  std::ifstream file(path);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "older");
}

TEST_F(TestRockfallHazardMap, PrintSelfNamesEveryProperty)
{
  std::ostringstream text;
  this->Filter->Print(text);
  for (const char* name :
    { "CellSize", "CropToTrajectories", "AnnualFrequency", "EnergyThresholds", "ReturnPeriods" })
  {
    EXPECT_NE(text.str().find(std::string(name) + ":"), std::string::npos) << name;
  }
}
