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
  sure->SetAttitudeLaw(vtkRockBlockSource::AS_GIVEN);
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

TEST_F(TestReleaseUncertainty, DefaultsDifferBetweenIterations)
{
  vtkNew<vtkDEMToCFESource> slope;
  vtkNew<vtkRockBlockSource> rock;
  this->Simulation->SetInputConnection(0, slope->GetOutputPort());
  this->Simulation->SetInputConnection(1, rock->GetOutputPort());
  this->Simulation->SetIterations(2);
  this->Simulation->SetEndTime(3.0);
  vtkFieldData* rows = this->Summary()->GetRowData();
  EXPECT_NE(value(rows, "StopX", 0), value(rows, "StopX", 1));
  this->ForgetBareRock();
  ASSERT_EQ(this->Heard->Notes.size(), 1u); // of the short run, none on iterations that are alike
  EXPECT_NE(this->Heard->Notes[0].find("2 of 2 rocks were still moving"), std::string::npos);
  EXPECT_EQ(value(rock->GetOutput()->GetCellData(), "AttitudeLaw"), vtkRockBlockSource::RANDOM);
  // An attitude that is given is kept.
  rock->SetOrientation(0.0, 0.0, 30.0);
  rock->Update();
  EXPECT_EQ(value(rock->GetOutput()->GetCellData(), "AttitudeLaw"), vtkRockBlockSource::AS_GIVEN);
  rock->SetOrientation(0.0, 0.0, 0.0);
  const std::string table =
    this->WriteFile("sources.csv", "x,y,z,rx,ry,rz\n5,50,58,0,0,0\n5,60,58,,,\n");
  rock->SetFileName(table.c_str());
  rock->Update();
  vtkCellData* cells = rock->GetOutput()->GetCellData();
  const vtkIdType last = rock->GetOutput()->GetNumberOfCells() - 1;
  EXPECT_EQ(value(cells, "AttitudeLaw", 0), vtkRockBlockSource::AS_GIVEN);
  EXPECT_EQ(value(cells, "AttitudeLaw", last), vtkRockBlockSource::RANDOM);
}

TEST_F(TestReleaseUncertainty, ANoteSaysWhereNothingDiffers)
{
  vtkNew<vtkRockBlockSource> sure;
  sure->SetAttitudeLaw(vtkRockBlockSource::AS_GIVEN);
  this->Simulation->SetInputConnection(1, sure->GetOutputPort());
  this->Simulation->SetEndTime(0.05); // a look, of which nobody is told lost
  this->Simulation->SetIterations(1);
  this->Simulation->Update();
  this->ForgetBareRock();
  EXPECT_TRUE(this->Heard->Notes.empty());
  sure->SetDensity(2.7); // t/m³
  this->Simulation->Update();
  this->ForgetBareRock();
  ASSERT_EQ(this->Heard->Notes.size(), 1u);
  EXPECT_NE(this->Heard->Notes[0].find("1 of 1 densities of rocks"), std::string::npos);
  this->Heard->Notes.clear();
  sure->SetDensity(2700.0);
  const double* place = sure->GetCenter();
  sure->SetCenter(place[0], place[1], place[2] + 30.0); // of another slope
  this->Simulation->Update();
  this->ForgetBareRock();
  ASSERT_EQ(this->Heard->Notes.size(), 1u);
  EXPECT_NE(this->Heard->Notes[0].find("1 of 1 heights of rocks"), std::string::npos);
  this->Heard->Notes.clear();
  sure->SetCenter(place[0], place[1], place[2] - 30.0);
  this->Simulation->SetIterations(3);
  this->Simulation->Update();
  this->ForgetBareRock();
  ASSERT_EQ(this->Heard->Notes.size(), 1u);
  EXPECT_NE(this->Heard->Notes[0].find("All 3 iterations are alike"), std::string::npos);
  this->Heard->Notes.clear();
  this->Terrain->SetFrictionAngleDeviation(2.0);
  this->Simulation->Update();
  this->ForgetBareRock();
  EXPECT_TRUE(this->Heard->Notes.empty());
}
