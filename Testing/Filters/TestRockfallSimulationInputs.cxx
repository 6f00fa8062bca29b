// What may be put into Rockfall Simulation: saved, appended, displaced and made by others.

#include "simulationTest.h"

#include "vtkAppendPolyData.h"
#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkDoubleArray.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

#include <cmath>

namespace
{

class TestRockfallSimulationInputs : public SimulationTest
{
};

} // namespace

TEST_F(TestRockfallSimulationInputs, SavedInputsGiveTheSameRun)
{
  this->Terrain->SetRestitutionModel(vtkDEMToCFESource::NORMAL_TANGENTIAL); // not the default
  const auto direct = numbersOf(this->Output(1));
  vtkNew<vtkXMLPolyDataReader> readers[2];
  vtkAlgorithm* sources[2] = { this->Terrain, this->Rocks };
  for (int port = 0; port < 2; ++port)
  {
    const std::string file = this->WriteFile(port ? "rocks.vtp" : "terrain.vtp", "");
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetDataModeToBinary();
    writer->SetInputConnection(sources[port]->GetOutputPort());
    writer->SetFileName(file.c_str());
    ASSERT_EQ(writer->Write(), 1);
    readers[port]->SetFileName(file.c_str());
    this->Simulation->SetInputConnection(port, readers[port]->GetOutputPort());
  }
  EXPECT_EQ(direct, numbersOf(this->Output(1)));
}

TEST_F(TestRockfallSimulationInputs, TerrainsOfBeforeThereWereModelsFallAsEver)
{
  const auto now = numbersOf(this->Output(1));
  vtkNew<vtkPolyData> old;
  old->DeepCopy(this->Terrain->GetOutput());
  vtkNew<vtkDoubleArray> material;
  material->SetName("TerrainMaterial");
  for (int k = 0; k < 7; ++k)
  {
    material->InsertNextValue(value(old->GetFieldData(), "TerrainMaterial", 0, k));
  }
  old->GetFieldData()->AddArray(material);
  this->Simulation->SetInputData(0, old);
  EXPECT_EQ(now, numbersOf(this->Output(1)));
}

TEST_F(TestRockfallSimulationInputs, RestitutionIsTheMaterials)
{
  const auto whole = numbersOf(this->Output(1));
  this->Terrain->SetTangentialRestitution(0.5); // that model has no use for it
  this->Terrain->SetRestitutionSpeed(1.0);
  EXPECT_EQ(whole, numbersOf(this->Output(1)));
  this->Terrain->SetRestitutionModel(vtkDEMToCFESource::NORMAL_TANGENTIAL);
  EXPECT_NE(whole, numbersOf(this->Output(1)));
}

TEST_F(TestRockfallSimulationInputs, CoarselyShownTerrainIsUsedInFull)
{
  this->Terrain->SetRoughnessDeviation(0.1); // makes every node matter
  const auto full = numbersOf(this->Output(1));
  this->Terrain->SetMaximumDisplayCells(600);
  vtkNew<vtkRockfallSimulation> other;
  other->SetInputConnection(0, this->Terrain->GetOutputPort());
  other->SetInputConnection(1, this->Rocks->GetOutputPort());
  other->SetEndTime(3.0);
  other->Update();
  ASSERT_LE(this->Terrain->GetOutput()->GetNumberOfCells(), 600);
  EXPECT_EQ(full, numbersOf(vtkPolyData::SafeDownCast(other->GetOutputDataObject(1))));
  EXPECT_EQ(other->GetNumberOfRuns(), 1);
}

TEST_F(TestRockfallSimulationInputs, RealCoordinatesOnlyShiftTheResult)
{
  // The same incline at the origin and in a UTM zone. 4e6 m leave a double 5e-10 m.
  const auto grid = [](const char* corner)
  {
    std::ostringstream text;
    text << "ncols 21\nnrows 11\n" << corner << "\ncellsize 5\nNODATA_value -9999\n";
    for (int row = 0; row < 11; ++row)
    {
      for (int column = 0; column < 21; ++column)
      {
        text << 50.0 - 2.5 * column << " ";
      }
      text << "\n";
    }
    return text.str();
  };
  this->Rocks->SetCenter(10, 25, 50);
  this->Terrain->SetFileName(
    this->WriteFile("near.asc", grid("xllcorner 1000\nyllcorner 2000")).c_str());
  this->Rocks->SetCenter(1010, 2025, 50);
  vtkNew<vtkPolyData> nearLines;
  nearLines->DeepCopy(this->Output(1));
  this->Terrain->SetFileName(
    this->WriteFile("far.asc", grid("xllcorner 500000\nyllcorner 4000000")).c_str());
  this->Rocks->SetCenter(500010, 4000025, 50);
  vtkPolyData* farLines = this->Output(1);
  // Until the first bounces have amplified the rounding of the block's corners.
  for (vtkIdType id = 0; id < 20; ++id)
  {
    EXPECT_NEAR(farLines->GetPoint(id)[0] - 499000, nearLines->GetPoint(id)[0], 1e-5);
    EXPECT_NEAR(farLines->GetPoint(id)[1] - 3998000, nearLines->GetPoint(id)[1], 1e-5);
    EXPECT_NEAR(farLines->GetPoint(id)[2], nearLines->GetPoint(id)[2], 1e-5);
  }
  EXPECT_EQ(value(farLines->GetFieldData(), "LocalOrigin", 0, 0), 500002.5);
}

TEST_F(TestRockfallSimulationInputs, TakesAnyClosedSurface)
{
  vtkNew<vtkCubeSource> cube; // 24 points, single precision, no arrays
  cube->SetCenter(5, 50, 58);
  this->Simulation->SetInputConnection(1, cube->GetOutputPort());
  vtkPolyData* rock = this->RocksAt(0.4);
  EXPECT_EQ(rock->GetNumberOfCells(), 6);
  EXPECT_EQ(rock->GetNumberOfPoints(), 8);
  EXPECT_NEAR(middle(rock, 2), releaseHeight - 0.5 * gravity * 0.16, 1e-5);
}

TEST_F(TestRockfallSimulationInputs, TakesAppendedSources)
{
  vtkNew<vtkRockBlockSource> other;
  other->SetShape(vtkRockBlockSource::OCTAHEDRON);
  other->SetAttitudeLaw(vtkRockBlockSource::AS_GIVEN);
  other->SetCenter(5, 60, 58);
  other->SetFirstBlockId(2);
  vtkNew<vtkAppendPolyData> append;
  append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  append->AddInputConnection(this->Rocks->GetOutputPort());
  append->AddInputConnection(other->GetOutputPort());
  this->Simulation->SetInputConnection(1, append->GetOutputPort());
  EXPECT_EQ(this->Summary()->GetNumberOfRows(), 2);
  other->SetFirstBlockId(1);
  this->ExpectEmpty();
  this->ExpectOneError({ "block 1", "First Block Id" });
}
