// What is drawn of a release travels with the rocks, and the outputs show what was drawn.

#include "simulationTest.h"

#include "vtkAppendPolyData.h"
#include "vtkCellData.h"
#include "vtkMassProperties.h"
#include "vtkStringArray.h"
#include "vtkTriangleFilter.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

#include <cmath>
#include <set>

namespace
{

class TestReleaseUncertainty : public SimulationTest
{
protected:
  void SetUp() override
  {
    this->SimulationTest::SetUp();
    this->Rocks->SetVolumeLaw(vtkRockBlockSource::LOG_NORMAL);
    this->Rocks->RedrawVolumeOn();
    this->Rocks->SetHorizontalDeviation(1.0);
    this->Rocks->SetAttitudeLaw(vtkRockBlockSource::RANDOM);
    this->Rocks->SetSourceName("niche");
    this->Simulation->SetEndTime(0.5);
    this->Simulation->SetIterations(4);
  }

  std::string Text(const char* column, vtkIdType row)
  {
    auto* words =
      vtkStringArray::SafeDownCast(this->Summary()->GetRowData()->GetAbstractArray(column));
    return words ? std::string(words->GetValue(row)) : "(no such column)";
  }
};

} // namespace

TEST_F(TestReleaseUncertainty, TheShownBlockIsTheOneThatFalls)
{
  std::set<double> volumes;
  for (int iteration = 0; iteration < 4; ++iteration)
  {
    this->Simulation->SetShownIteration(iteration);
    vtkPolyData* shown = this->RocksAt(0.0);
    vtkFieldData* row = this->Summary()->GetRowData();
    vtkNew<vtkTriangleFilter> triangles;
    triangles->SetInputData(shown);
    vtkNew<vtkMassProperties> mass;
    mass->SetInputConnection(triangles->GetOutputPort());
    const double volume = value(row, "Volume", iteration);
    EXPECT_NEAR(mass->GetVolume(), volume, 1e-9 * volume);
    EXPECT_DOUBLE_EQ(value(row, "Mass", iteration), 2500.0 * volume);
    EXPECT_EQ(value(shown->GetCellData(), "Volume"), volume);
    EXPECT_EQ(value(this->Output(1)->GetCellData(), "Volume", iteration), volume);
    // A cube's centre is the middle of its box at any attitude.
    EXPECT_NEAR(shown->GetCenter()[0], value(row, "StartX", iteration), 1e-9);
    EXPECT_NEAR(shown->GetCenter()[1], value(row, "StartY", iteration), 1e-9);
    EXPECT_NEAR(shown->GetCenter()[2], value(row, "StartZ", iteration), 1e-9);
    const double* b = shown->GetBounds();
    EXPECT_GT(b[1] - b[0], 1.01 * std::cbrt(volume)); // it is turned
    volumes.insert(volume);
  }
  EXPECT_EQ(volumes.size(), 4u);
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), 1);
}

TEST_F(TestReleaseUncertainty, SourcesAreInTheOutputs)
{
  this->Rocks->SetAmount(2);
  this->Rocks->SetFirstSourceId(12);
  EXPECT_EQ(this->Text("SourceName", 7), "niche");
  EXPECT_EQ(value(this->Summary()->GetRowData(), "SourceId", 7), 12);
  EXPECT_EQ(value(this->Output(1)->GetCellData(), "SourceId", 7), 12);
  // Two rocks of one source are drawn apart.
  vtkFieldData* rows = this->Summary()->GetRowData();
  EXPECT_NE(value(rows, "StartX", 0), value(rows, "StartX", 1));
  EXPECT_NE(value(rows, "Volume", 0), value(rows, "Volume", 1));
}

TEST_F(TestReleaseUncertainty, SurvivesAppendingAndSaving)
{
  vtkNew<vtkRockBlockSource> sure;
  sure->SetFirstBlockId(2);
  sure->SetFirstSourceId(2);
  sure->SetCenter(5.0, 30.0, 58.0);
  vtkNew<vtkAppendPolyData> both;
  both->AddInputConnection(this->Rocks->GetOutputPort());
  both->AddInputConnection(sure->GetOutputPort());
  const std::string name = this->WriteFile("rocks.vtp", "");
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(both->GetOutputPort());
  writer->SetFileName(name.c_str());
  ASSERT_TRUE(writer->Write());
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(name.c_str());

  vtkFieldData* direct = this->Summary()->GetRowData();
  std::vector<double> expected;
  for (int iteration = 0; iteration < 4; ++iteration)
  {
    expected.push_back(value(direct, "Volume", iteration));
  }
  this->Simulation->SetInputConnection(1, reader->GetOutputPort());
  vtkFieldData* rows = this->Summary()->GetRowData();
  for (int iteration = 0; iteration < 4; ++iteration)
  {
    // The volume is a function of seed, iteration and index; the faces went through a file.
    EXPECT_NEAR(value(rows, "Volume", 2 * iteration), expected[std::size_t(iteration)], 1e-9);
    EXPECT_NEAR(value(rows, "Volume", 2 * iteration + 1), 1.0, 1e-9);
    EXPECT_EQ(value(rows, "SourceId", 2 * iteration + 1), 2);
  }
  EXPECT_EQ(this->Text("SourceName", 1), "source 2");
}
