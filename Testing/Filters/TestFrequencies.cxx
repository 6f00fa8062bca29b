// Frequencies of sources: from a layer to rocks, trajectories and their map.

#include "helpers.h"
#include "trajectories.h"

#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkDEMToCFESource.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkPoints.h"
#include "vtkRockBlockSource.h"
#include "vtkRockfallHazardMap.h"
#include "vtkRockfallSimulation.h"
#include "vtkTable.h"

#include <cmath>
#include <map>
#include <set>

namespace
{

class TestFrequencies : public FilterTest
{
protected:
  void SetUp() override
  {
    this->FilterTest::SetUp();
    this->Rocks->SetInputConnection(1, this->Slope->GetOutputPort());
  }
  void Read(const std::string& table)
  {
    this->Rocks->SetFileName(this->WriteFile("sources.csv", table).c_str());
    this->Rocks->Modified(); // an edited file is not noticed
    this->Rocks->Update();
  }

  vtkNew<vtkDEMToCFESource> Slope;
  vtkNew<vtkRockBlockSource> Rocks;
};

const char* const kSources =
  "WKT,source_id,amount,volume,vol_law,vol_min,vol_max,vol_exp,frequency,freq_ha,freq_a\n"
  "\"POINT(20 50)\",1,1,1,,,,,0.125,,\n"
  "\"POLYGON((10 20,30 20,30 40,10 40,10 20))\",2,4,1,,,,,,5,\n" // 0.04 ha: 0.2 a year
  "\"POINT(20 70)\",3,2,1,,1,4,1,,,0.5\n";                       // 0.5 (1 − 1/4) a year

} // namespace

TEST_F(TestFrequencies, AreSharedOutOverTheRocksOfASource)
{
  this->Rocks->SetPlaceOnGround(true);
  this->Read(kSources);
  vtkCellData* cells = this->Rocks->GetOutput()->GetCellData();
  ASSERT_TRUE(cells->GetArray("Frequency"));
  std::map<int, std::set<double>> found;
  for (vtkIdType k = 0; k < cells->GetNumberOfTuples(); ++k)
  {
    found[int(value(cells, "SourceId", k))].insert(value(cells, "Frequency", k));
  }
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[1], std::set<double>{ 0.125 });
  ASSERT_EQ(found[2].size(), 1u);
  EXPECT_NEAR(*found[2].begin(), 0.05, 1e-15);
  EXPECT_EQ(found[3], std::set<double>{ 0.1875 });

  vtkNew<vtkRockfallSimulation> fall;
  fall->SetInputConnection(0, this->Slope->GetOutputPort());
  fall->SetInputConnection(1, this->Rocks->GetOutputPort());
  fall->SetEndTime(0.2);
  fall->SetIterations(2);
  vtkNew<vtkRockfallHazardMap> map;
  map->SetInputConnection(0, fall->GetOutputPort(1));
  map->SetCellSize(1000.0); // all rocks of all sources are in its one cell
  map->Update();
  vtkCellData* paths = vtkPolyData::SafeDownCast(fall->GetOutputDataObject(1))->GetCellData();
  ASSERT_EQ(paths->GetNumberOfTuples(), 2 * 7);
  EXPECT_EQ(value(paths, "Frequency", 0), 0.125);
  EXPECT_EQ(value(paths, "Frequency", 6), 0.1875);
  vtkDataSetAttributes* rows = vtkTable::SafeDownCast(fall->GetOutputDataObject(3))->GetRowData();
  EXPECT_EQ(value(rows, "Frequency", 13), 0.1875);
  // Who goes on from the time shown has it, too.
  vtkCellData* shown = vtkPolyData::SafeDownCast(fall->GetOutputDataObject(0))->GetCellData();
  EXPECT_EQ(value(shown, "Frequency", 0), 0.125);
  EXPECT_FLOAT_EQ(
    float(value(map->GetOutput()->GetCellData(), "AnnualFrequency")), 0.125F + 0.2F + 0.375F);
}

/// A rock that breaks into pieces is released once.
TEST_F(TestFrequencies, PiecesAreNoReleases)
{
  HandMadeTrajectories paths;
  const auto add = [&](const char* name, const std::vector<double>& values)
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    for (const double value : values)
    {
      array->InsertNextValue(value);
    }
    paths.Data->GetCellData()->AddArray(array);
  };
  for (const int iteration : { 0, 1 })
  {
    for (int piece = 0; piece < 3; ++piece)
    {
      paths.AddLevel(iteration, 0, { 500000.0 + 10 * std::min(piece, 1), 5100000, 50 }, 10.0, 5.0);
    }
  }
  add("Piece", { 0, 1, 2, 0, 1, 2 });
  add("Frequency", { 0.25, 0.25, 0.25, 0.25, 0.25, 0.25 });
  vtkNew<vtkRockfallHazardMap> map;
  map->SetInputDataObject(0, paths.Data);
  map->SetCellSize(1000.0);
  map->Update();
  EXPECT_FLOAT_EQ(float(value(map->GetOutput()->GetCellData(), "AnnualFrequency")), 0.25F);
}

/// Typed, with a row that has its own.
TEST_F(TestFrequencies, PropertiesAreOfSourcesWithoutTheirOwn)
{
  this->Rocks->SetAnnualFrequency(0.5);
  this->Read("x,y,z,amount,frequency\n20,50,60,4,\n20,70,60,2,0.25\n");
  const auto at = [this](vtkIdType block) // of cubes
  { return value(this->Rocks->GetOutput()->GetCellData(), "Frequency", 6 * block); };
  EXPECT_EQ(at(0), 0.125);
  EXPECT_EQ(at(5), 0.125);

  this->Rocks->SetAnnualFrequency(0.0);
  this->Rocks->SetPowerLawFrequency(2.0);
  this->Rocks->SetVolumeExponent(1.0);
  this->Rocks->SetVolumeMinimum(0.5);
  this->Rocks->SetVolumeMaximum(4.0);
  this->Rocks->Update();
  EXPECT_EQ(at(0), 2.0 * (2.0 - 0.25) / 4);
  EXPECT_EQ(at(5), 0.125);
}

/// By amount or by intensity, whether the rest is outside of the grid or on its nodata.
TEST_F(TestFrequencies, OfPolygonsByTheirAreaOnTheTerrain)
{
  // Cells of 10 m from (5, 5) to (95, 45); the node at (75, 25) is nodata.
  std::string grid = "ncols 10\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                     "NODATA_value -9999\n";
  for (int row = 0; row < 5; ++row)
  {
    for (int column = 0; column < 10; ++column)
    {
      grid += std::to_string(row == 2 && column == 7 ? -9999 : 200 - 10 * column) + " ";
    }
    grid += "\n";
  }
  this->Slope->SetFileName(this->WriteFile("dem.asc", grid).c_str());
  this->Read("WKT,source_id,amount,intensity,volume,freq_ha\n"
             "\"POLYGON((-35 5,45 5,45 30,-35 30,-35 5))\",1,7,,0.01,2\n"
             "\"POLYGON((-35 5,45 5,45 30,-35 30,-35 5))\",2,,0.02,0.01,2\n"
             "\"POLYGON((5 5,45 5,45 30,5 30,5 5))\",3,7,,0.01,2\n"
             "\"POLYGON((55 15,85 15,85 35,55 35,55 15))\",4,3,,0.01,2\n");
  std::map<int, double> found;
  std::set<double> blocks;
  vtkCellData* cells = this->Rocks->GetOutput()->GetCellData();
  for (vtkIdType k = 0; k < cells->GetNumberOfTuples(); ++k)
  {
    if (blocks.insert(value(cells, "BlockId", k)).second)
    {
      found[int(value(cells, "SourceId", k))] += value(cells, "Frequency", k);
    }
  }
  const vtkIdType triangles =
    vtkPolyData::SafeDownCast(this->Slope->GetOutputDataObject(0))->GetNumberOfCells();
  const double gap = 90.0 * 40.0 - 50.0 * double(triangles);
  ASSERT_GE(gap, 200.0);
  EXPECT_NEAR(found[1], 2.0 * 0.1, 1e-12);
  EXPECT_NEAR(found[2], 2.0 * 0.1, 1e-12);
  EXPECT_NEAR(found[3], 2.0 * 0.1, 1e-12);
  EXPECT_NEAR(found[4], 2.0 * (600.0 - gap) / 1e4, 1e-12);
}

TEST_F(TestFrequencies, OfSteepTerrainByItsArea)
{
  constexpr double threshold = 25.0; // degrees
  this->Rocks->SetSlopeThreshold(threshold);
  this->Rocks->SetAmount(4);
  this->Rocks->SetFrequencyPerHectare(2.0);
  this->Rocks->Update();
  double area = 0.0; // in plan, m²
  vtkPolyData* slope = vtkPolyData::SafeDownCast(this->Slope->GetOutputDataObject(0));
  for (vtkIdType k = 0; k < slope->GetNumberOfCells(); ++k)
  {
    double a[3], b[3], c[3], twice[3];
    vtkPoints* corners = slope->GetCell(k)->GetPoints();
    corners->GetPoint(0, a);
    corners->GetPoint(1, b);
    corners->GetPoint(2, c);
    vtkMath::Subtract(b, a, b);
    vtkMath::Subtract(c, a, c);
    vtkMath::Cross(b, c, twice);
    const double steep = std::abs(twice[2]) / vtkMath::Norm(twice);
    area += steep <= std::cos(vtkMath::RadiansFromDegrees(threshold)) ? std::abs(twice[2]) / 2 : 0;
  }
  ASSERT_GT(area, 0.0);
  EXPECT_NEAR(value(this->Rocks->GetOutput()->GetCellData(), "Frequency"), 2.0 * area / 1e4 / 4,
    1e-12 * area);
}

TEST_F(TestFrequencies, WithoutThemThereIsNoArray)
{
  this->Read("x,y,z\n20,50,60\n");
  EXPECT_EQ(this->Rocks->GetOutput()->GetCellData()->GetArray("Frequency"), nullptr);
}

TEST_F(TestFrequencies, BadOnes)
{
  const auto expect = [this](const std::string& table, const std::vector<std::string>& words)
  {
    SCOPED_TRACE(table);
    this->Read(table);
    EXPECT_EQ(this->Rocks->GetOutput()->GetNumberOfCells(), 0);
    this->ExpectOneError(words);
  };
  expect("x,y,z,frequency\n20,50,60,0.1\n30,50,60,\n", { "row 2", "row 1", "all have one" });
  expect("x,y,z,frequency\n20,50,60,-1\n", { "row 1", "frequency", "-1" });
  expect("x,y,z,freq_ha\n20,50,60,1\n", { "row 1", "freq_ha", "polygons" });
  expect("x,y,z,freq_a,vol_min\n20,50,60,1,0\n", { "row 1", "0 to 10 m³" });
  expect("x,y,z,frequency,freq_a\n20,50,60,1,1\n", { "row 1", "one of them" });
  this->Rocks->SetAnnualFrequency(0.1);
  this->Rocks->SetPowerLawFrequency(1.0);
  expect("x,y,z\n20,50,60\n", { "AnnualFrequency and PowerLawFrequency" });
  this->Rocks->SetPowerLawFrequency(0.0);
  this->Rocks->SetAnnualFrequency(-1.0);
  expect("x,y,z\n20,50,60\n", { "AnnualFrequency is -1" });
  this->Rocks->SetAnnualFrequency(0.0);
  this->Rocks->SetFrequencyPerHectare(1.0);
  expect("x,y,z\n20,50,60\n", { "row 1", "FrequencyPerHectare is 1", "no area" });
}
