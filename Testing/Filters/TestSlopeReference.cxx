// The slope that rocks and trajectories refer to: shared within a process, as tiles in a file.
#include "simulationTest.h"

#include "shared/slopeReference.h"
#include "shared/terrainFieldData.h"

#include "vtkAppendPolyData.h"
#include "vtkCellData.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkRockfallHazardMap.h"
#include "vtkTrajectoryCollector.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

#include <algorithm>

namespace
{

namespace filters = rockfall::filters;

class TestSlopeReference : public SimulationTest
{
protected:
  void SetUp() override
  {
    this->SimulationTest::SetUp();
    this->Terrain->SetCellSize(0.5);
    this->Rocks->SetInputConnection(1, this->Terrain->GetOutputPort());
    this->Simulation->SetInputConnection(0, nullptr); // the rocks bring it
    this->Simulation->SetEndTime(6.0);
  }

  /// What a file of `data` gives to a program that knows no other slope.
  vtkSmartPointer<vtkPolyData> ReadElsewhere(vtkPolyData* data)
  {
    this->File = this->WriteFile("data.vtp", "");
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetFileName(this->File.c_str());
    writer->SetInputData(data);
    writer->SetDataModeToBinary(); // not every libexpat lets appended data be read back
    writer->Write();
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(this->File.c_str());
    reader->Update();
    vtkSmartPointer<vtkPolyData> read = reader->GetOutput();
    auto* key = vtkStringArray::SafeDownCast(read->GetFieldData()->GetAbstractArray("TerrainKey"));
    EXPECT_TRUE(key);
    key->SetValue(0, "0123456789abcdef"); // of no slope of this process
    return read;
  }

  /// All cell arrays of a map, and the heights at its corners where a rock came.
  std::vector<double> Map(vtkPolyData* trajectories)
  {
    vtkNew<vtkRockfallHazardMap> map;
    map->SetInputData(trajectories);
    map->SetCellSize(2.0);
    map->Update();
    std::vector<double> numbers;
    vtkCellData* cells = map->GetOutput()->GetCellData();
    for (int k = 0; k < cells->GetNumberOfArrays(); ++k)
    {
      for (vtkIdType c = 0; cells->GetArray(k) && c < cells->GetNumberOfTuples(); ++c)
      {
        const double number = cells->GetArray(k)->GetComponent(c, 0);
        numbers.push_back(std::isnan(number) ? -1e300 : number);
      }
    }
    auto* draped = vtkPolyData::SafeDownCast(map->GetOutputDataObject(1));
    for (vtkIdType k = 0; k < draped->GetNumberOfPoints(); ++k)
    {
      numbers.push_back(draped->GetPoint(k)[2]);
    }
    EXPECT_GT(draped->GetNumberOfPoints(), 10);
    return numbers;
  }

  std::vector<double> Line(vtkPolyData* trajectories)
  {
    vtkNew<vtkTrajectoryCollector> line;
    line->SetInputData(0, trajectories);
    line->Update();
    auto* crossings = vtkPolyData::SafeDownCast(line->GetOutputDataObject(0));
    EXPECT_GT(crossings->GetNumberOfPoints(), 0);
    return numbersOf(crossings);
  }

  std::string File;
};

} // namespace

TEST_F(TestSlopeReference, NoHeightsTravel)
{
  vtkPolyData* paths = this->Output(1);
  auto* rocks = vtkPolyData::SafeDownCast(this->Rocks->GetOutputDataObject(0));
  for (vtkPolyData* data : { paths, rocks })
  {
    vtkFieldData* fields = data->GetFieldData();
    EXPECT_FALSE(fields->GetAbstractArray("TerrainHeights"));
    EXPECT_FALSE(fields->GetAbstractArray("TerrainMaterial"));
    EXPECT_TRUE(filters::hasTerrain(fields));
    // The very array of the slope, no copy.
    EXPECT_EQ(filters::slopeOf(fields)->GetArray("TerrainHeights"),
      this->Terrain->GetOutput()->GetFieldData()->GetArray("TerrainHeights"));
  }
  this->ReadElsewhere(paths);
  EXPECT_LT(std::filesystem::file_size(this->File), 300e3); // the heights alone have 0.8 MB
}

TEST_F(TestSlopeReference, OutlivesItsSourceAndADeepCopy)
{
  vtkNew<vtkPolyData> paths, copy;
  paths->ShallowCopy(this->Output(1));
  copy->DeepCopy(paths);
  this->Simulation->RemoveAllInputConnections(1);
  this->Rocks->SetInputConnection(1, nullptr);
  this->Terrain->SetCellSize(5.0);
  this->Terrain->Update();
  EXPECT_EQ(filters::slopeUnder(paths, nullptr)->geometry().columns, 501);
  EXPECT_EQ(filters::slopeUnder(copy, nullptr)->geometry().columns, 501);
}

TEST_F(TestSlopeReference, MapsAndLinesOfAFileAreTheSame)
{
  vtkPolyData* paths = this->Output(1);
  const vtkSmartPointer<vtkPolyData> read = this->ReadElsewhere(paths);
  EXPECT_FALSE(filters::hasTerrain(read->GetFieldData()));
  EXPECT_EQ(this->Line(paths), this->Line(read));
  EXPECT_EQ(this->Map(paths), this->Map(read));
  // The elevations of places where no path came are not in the file.
  vtkNew<vtkRockfallHazardMap> all;
  all->SetInputData(read);
  all->SetCropToTrajectories(false);
  all->Update();
  EXPECT_TRUE(std::any_of(this->Heard->Notes.begin(), this->Heard->Notes.end(),
    [](const std::string& note)
    { return note.find("connect the slope as Terrain") != std::string::npos; }));
}

TEST_F(TestSlopeReference, PathsOfTwoFilesThatAreAppended)
{
  const vtkSmartPointer<vtkPolyData> first = this->ReadElsewhere(this->Output(1));
  this->Rocks->SetCenter(5, 90, 58);
  const vtkSmartPointer<vtkPolyData> second = this->ReadElsewhere(this->Output(1));
  second->GetFieldData()->RemoveArray("TerrainTiles");
  vtkNew<vtkAppendPolyData> append;
  append->AddInputData(first);
  append->AddInputData(second);
  append->Update();
  vtkNew<vtkPolyData> both;
  both->ShallowCopy(append->GetOutput());
  both->GetFieldData()->PassData(first->GetFieldData()); // as ParaView's filter does
  vtkNew<vtkRockfallHazardMap> map;
  map->SetInputData(both);
  map->Update();
  this->ExpectOneError({ "several files", "connect the slope as Terrain" });
  map->SetInputConnection(1, this->Terrain->GetOutputPort());
  map->Update();
  EXPECT_GT(map->GetOutput()->GetNumberOfCells(), 0);
}

TEST_F(TestSlopeReference, RocksOfAFileAskForTheirSlope)
{
  this->Rocks->Update();
  auto* rocks = vtkPolyData::SafeDownCast(this->Rocks->GetOutputDataObject(0));
  this->Simulation->SetInputData(1, this->ReadElsewhere(rocks));
  this->Simulation->Update();
  this->ExpectOneError({ "Rocks refer to a slope that is not here", "Terrain" });
  this->Simulation->SetInputConnection(0, this->Terrain->GetOutputPort());
  EXPECT_GT(this->Output(1)->GetNumberOfLines(), 0);
}
