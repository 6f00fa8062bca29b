// Names go with what they are of, through every filter that takes blocks out, appends and reorders
// them; and nothing that only shows makes a simulation run again.
#include "simulationTest.h"

#include "vtkAppendPolyData.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkGeometryFilter.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkThreshold.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

#include <map>

namespace
{

class TestTravellingNames : public SimulationTest
{
protected:
  void SetUp() override
  {
    this->SimulationTest::SetUp();
    this->Rocks->SetInputConnection(1, this->Terrain->GetOutputPort());
    this->Rocks->SetFileName(
      this
        ->WriteFile("src.csv",
          "x,y,height,source,volume,shape\n5,40,0,alpha,1,cube\n5,50,0,beta,2,octahedron\n"
          "5,60,0,gamma,3,icosahedron\n")
        .c_str());
    this->Simulation->SetEndTime(1.0);
  }

  /// Blocks of these numbers.
  void Keep(vtkThreshold* threshold, double low, double high)
  {
    threshold->SetInputConnection(this->Rocks->GetOutputPort());
    threshold->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "BlockId");
    threshold->SetLowerThreshold(low);
    threshold->SetUpperThreshold(high);
  }

  std::map<int, std::string> NamesByBlock()
  {
    std::map<int, std::string> names;
    vtkTable* table = this->Summary();
    for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
    {
      names[table->GetValueByName(row, "BlockId").ToInt()] =
        table->GetValueByName(row, "SourceName").ToString();
    }
    return names;
  }

  vtkNew<vtkThreshold> Some;
  vtkNew<vtkGeometryFilter> Surface;
  vtkNew<vtkAppendPolyData> All;
};

using Names = std::map<int, std::string>;

} // namespace

TEST_F(TestTravellingNames, BlocksTakenOutAndAppended)
{
  this->Keep(this->Some, 2, 3);
  this->Surface->SetInputConnection(this->Some->GetOutputPort());
  vtkNew<vtkRockBlockSource> delta;
  delta->SetCenter(20, 50, 60);
  delta->SetFirstBlockId(9);
  delta->SetSourceName("delta");
  this->All->AddInputConnection(this->Surface->GetOutputPort());
  this->All->AddInputConnection(delta->GetOutputPort());
  this->Simulation->SetInputConnection(1, this->All->GetOutputPort());
  EXPECT_EQ(this->NamesByBlock(), (Names{ { 2, "beta" }, { 3, "gamma" }, { 9, "delta" } }));
}

TEST_F(TestTravellingNames, OtherOrders)
{
  // The last block first, and of the two appended the one with the lower number last.
  vtkNew<vtkThreshold> last;
  this->Keep(this->Some, 1, 2);
  this->Keep(last, 3, 3);
  vtkNew<vtkGeometryFilter> lastSurface;
  lastSurface->SetInputConnection(last->GetOutputPort());
  this->Surface->SetInputConnection(this->Some->GetOutputPort());
  this->All->AddInputConnection(lastSurface->GetOutputPort());
  this->All->AddInputConnection(this->Surface->GetOutputPort());
  this->Simulation->SetInputConnection(1, this->All->GetOutputPort());
  EXPECT_EQ(this->NamesByBlock(), (Names{ { 1, "alpha" }, { 2, "beta" }, { 3, "gamma" } }));
  vtkTable* table = this->Summary();
  EXPECT_EQ(table->GetValueByName(0, "BlockId").ToInt(), 3);
  EXPECT_EQ(table->GetValueByName(0, "Shape").ToString(), "icosahedron");
}

TEST_F(TestTravellingNames, ThroughAFile)
{
  this->Keep(this->Some, 3, 3);
  this->Surface->SetInputConnection(this->Some->GetOutputPort());
  const std::string path = this->WriteFile("rocks.vtp", "");
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(this->Surface->GetOutputPort());
  writer->SetFileName(path.c_str());
  ASSERT_TRUE(writer->Write());
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  this->Simulation->SetInputConnection(1, reader->GetOutputPort());
  EXPECT_EQ(this->NamesByBlock(), (Names{ { 3, "gamma" } }));
}

TEST_F(TestTravellingNames, RocksWithoutANameHaveTheNumberOfTheirSource)
{
  this->Rocks->SetFirstSourceId(7);
  this->Rocks->Update();
  vtkNew<vtkPolyData> bare;
  bare->ShallowCopy(this->Rocks->GetOutput());
  bare->GetCellData()->RemoveArray("SourceName");
  this->Simulation->SetInputData(1, bare);
  EXPECT_EQ(
    this->NamesByBlock(), (Names{ { 1, "source 7" }, { 2, "source 8" }, { 3, "source 9" } }));
}

TEST_F(TestTravellingNames, WhatOnlyShowsRunsNothingAgain)
{
  this->Rocks->SetFileName("");
  this->Rocks->SetCenter(5, 50, 58.5);
  this->Rocks->SetSourceName("before");
  const auto before = numbersOf(this->Output(1));
  const std::string hash = this->Simulation->GetStateHash();
  ASSERT_EQ(this->Simulation->GetNumberOfRuns(), 1);
  // Fewer triangles of the slope; its notes change, too.
  this->Terrain->SetMaximumDisplayCells(500);
  this->RocksAt(0.5);
  EXPECT_LT(this->Terrain->GetOutput()->GetNumberOfCells(), 501);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 1);
  // Names: the table has the new one, and who holds the table of before keeps that.
  vtkNew<vtkTable> held;
  held->ShallowCopy(this->Summary());
  this->Rocks->SetSourceName("after");
  EXPECT_EQ(this->NamesByBlock(), (Names{ { 1, "after" } }));
  EXPECT_EQ(held->GetValueByName(0, "SourceName").ToString(), "before");
  // The name of a material that no table of contacts asks for.
  this->Rocks->SetMaterialName("slag");
  this->RocksAt(0.7);
  // A source that is made again and comes out the same.
  this->Terrain->Modified();
  this->Rocks->Modified();
  this->Simulation->Modified();
  EXPECT_EQ(numbersOf(this->Output(1)), before);
  EXPECT_EQ(this->Simulation->GetStateHash(), hash);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 1);
}

TEST_F(TestTravellingNames, WhatCountsRunsAgain)
{
  this->Rocks->SetFileName("");
  this->Rocks->SetCenter(5, 50, 58.5);
  int runs = 0;
  const auto expectRun = [&]
  {
    this->Simulation->Update();
    EXPECT_EQ(this->Simulation->GetNumberOfRuns(), ++runs);
  };
  expectRun();
  this->Rocks->SetCenter(5, 50, 58.500001);
  expectRun();
  this->Rocks->SetDensity(2501);
  expectRun();
  this->Rocks->SetFirstBlockId(4);
  expectRun();
  this->Terrain->SetFrictionAngle(16);
  expectRun();
  this->Terrain->SetRoughnessDeviation(0.01);
  expectRun();
  this->Terrain->SetCellSize(4.0);
  expectRun();
}

TEST_F(TestTravellingNames, AMeshThatWasMovedIsStillRefused)
{
  this->Simulation->Update();
  ASSERT_EQ(this->Simulation->GetNumberOfRuns(), 1);
  vtkNew<vtkPolyData> moved;
  moved->DeepCopy(this->Terrain->GetOutput());
  for (vtkIdType id = 0; id < moved->GetNumberOfPoints(); ++id)
  {
    double p[3];
    moved->GetPoint(id, p);
    p[0] += 10.0;
    moved->GetPoints()->SetPoint(id, p);
  }
  this->Simulation->SetInputData(0, moved);
  this->Simulation->Update();
  this->ExpectOneError({ "Terrain input", "moved or otherwise changed" });
}
