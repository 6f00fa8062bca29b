// What a simulation leaves at a time, saved and given back as Rocks, goes on as it was.

#include "simulationTest.h"

#include "vtkCellData.h"
#include "vtkPolyDataReader.h"
#include "vtkPolyDataWriter.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

#include <algorithm>

namespace
{

class TestContinuedRuns : public SimulationTest
{
protected:
  void SetUp() override
  {
    this->SimulationTest::SetUp();
    this->Rocks->SetShape(vtkRockBlockSource::EOTA_221);
    this->Rocks->SetVolume(0.7);
    this->Rocks->SetDensity(2711.0);
    this->Rocks->SetYoungModulus(3e10);
    this->Rocks->SetPoissonRatio(0.21);
    this->Rocks->SetMaterialName("slag");
    this->Rocks->SetSourceName("the cliff");
    this->Rocks->SetFirstSourceId(7);
    this->Rocks->SetFirstBlockId(31);
    this->Rocks->SetAngularVelocity(1, 2, 3);
    this->Rocks->SetOrientation(10, 20, 30);
    this->Rocks->SetHorizontalDeviation(0.5); // drawn once, at the release
    this->Simulation->SetEndTime(10.0);
  }

  /// The blocks at this time through a file of this kind, as the Rocks of another simulation.
  void GoOn(double time, const std::string& extension, vtkRockfallSimulation* next)
  {
    const std::string file = this->WriteFile("rocks" + extension, "");
    vtkPolyData* rocks = this->RocksAt(time);
    vtkSmartPointer<vtkAlgorithm> reader;
    if (extension == ".vtp")
    {
      vtkNew<vtkXMLPolyDataWriter> writer;
      writer->SetInputData(rocks);
      writer->SetFileName(file.c_str());
      ASSERT_EQ(writer->Write(), 1);
      auto xml = vtkSmartPointer<vtkXMLPolyDataReader>::New();
      xml->SetFileName(file.c_str());
      reader = xml;
    }
    else
    {
      vtkNew<vtkPolyDataWriter> writer;
      writer->SetInputData(rocks);
      writer->SetFileName(file.c_str());
      writer->SetFileTypeToBinary();
      ASSERT_EQ(writer->Write(), 1);
      auto legacy = vtkSmartPointer<vtkPolyDataReader>::New();
      legacy->SetFileName(file.c_str());
      reader = legacy;
    }
    next->SetInputConnection(0, this->Terrain->GetOutputPort());
    next->SetInputConnection(1, reader->GetOutputPort());
    next->SetEndTime(10.0 - time);
    next->Update();
  }
};

} // namespace

TEST_F(TestContinuedRuns, InFlightTheRockGoesOnToTheSamePlace)
{
  this->Simulation->Update();
  // Before the first touch, so that no coefficient is drawn for another rock.
  vtkTable* before = this->Summary();
  const double mass = before->GetValueByName(0, "Mass").ToDouble();
  for (const char* extension : { ".vtp", ".vtk" })
  {
    SCOPED_TRACE(extension);
    vtkNew<vtkRockfallSimulation> next;
    this->GoOn(0.2, extension, next);
    vtkPolyData* rocks = this->RocksAt(0.2);
    next->UpdateTimeStep(0.0);
    auto* first = vtkPolyData::SafeDownCast(next->GetOutputDataObject(0));
    ASSERT_EQ(first->GetNumberOfPoints(), rocks->GetNumberOfPoints());
    for (vtkIdType id = 0; id < rocks->GetNumberOfPoints(); ++id)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        EXPECT_NEAR(first->GetPoint(id)[axis], rocks->GetPoint(id)[axis], 1e-9);
      }
    }
    for (const char* name : { "BlockId", "Density", "YoungModulus", "PoissonRatio", "Velocity",
           "RotationRate", "AngularVelocity", "Volume", "SourceId", "Shape", "KineticEnergy" })
    {
      for (int c = 0; c < rocks->GetCellData()->GetArray(name)->GetNumberOfComponents(); ++c)
      {
        const double expected = value(rocks->GetCellData(), name, 0, c);
        EXPECT_NEAR(value(first->GetCellData(), name, 0, c), expected,
          1e-9 * std::max(1.0, std::abs(expected)))
          << name;
      }
    }
    auto* material =
      vtkStringArray::SafeDownCast(first->GetFieldData()->GetAbstractArray("Material"));
    ASSERT_TRUE(material);
    EXPECT_EQ(material->GetValue(0), "slag");
    auto* table = vtkTable::SafeDownCast(next->GetOutputDataObject(3));
    EXPECT_NEAR(table->GetValueByName(0, "Mass").ToDouble(), mass, 1e-9 * mass);
    EXPECT_EQ(table->GetValueByName(0, "SourceName").ToString(), "the cliff");
    // Until the bounces have amplified the rounding.
    const double later = 0.5;
    next->UpdateTimeStep(later);
    auto* goneOn = vtkPolyData::SafeDownCast(next->GetOutputDataObject(0));
    vtkPolyData* whole = this->RocksAt(0.2 + later);
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_NEAR(middle(goneOn, axis), middle(whole, axis), 1e-4) << axis;
    }
  }
}

TEST_F(TestContinuedRuns, AtAnyTimeTheRockIsTaken)
{
  // In contact it presses the springs, which are soft, so that this lasts; a rock that stopped stays.
  this->Simulation->SetNormalPenalty(1e9);
  this->Simulation->Update();
  bool touched = false;
  for (double time = 0.0; time <= 10.0; time += 0.02)
  {
    SCOPED_TRACE(time);
    vtkNew<vtkPolyData> rocks;
    rocks->DeepCopy(this->RocksAt(time));
    const double state = value(rocks->GetCellData(), "State");
    vtkNew<vtkRockfallSimulation> next;
    next->SetInputConnection(0, this->Terrain->GetOutputPort());
    next->SetInputData(1, rocks);
    next->SetEndTime(0.5);
    next->Update();
    if (state == 3)
    {
      this->ExpectOneError({ "had left the slope" });
      break;
    }
    touched = touched || state == 1;
    auto* table = vtkTable::SafeDownCast(next->GetOutputDataObject(3));
    ASSERT_EQ(table->GetNumberOfRows(), 1);
    if (state == 2)
    {
      EXPECT_LT(table->GetValueByName(0, "RunOut").ToDouble(), 0.05);
      EXPECT_LT(table->GetValueByName(0, "MaxSpeed").ToDouble(), 0.5);
    }
  }
  EXPECT_TRUE(touched);
}

TEST_F(TestContinuedRuns, RocksThatLeftAreLeftOutWithANote)
{
  vtkNew<vtkPolyData> two;
  this->Rocks->SetCenter(20, 50, 60);
  this->Rocks->SetAmount(2);
  this->Rocks->SetClusterRadius(3.0);
  two->DeepCopy(this->RocksAt(0.1));
  vtkDataArray* state = two->GetCellData()->GetArray("State");
  for (vtkIdType cell = 0; cell < two->GetNumberOfCells() / 2; ++cell)
  {
    state->SetComponent(cell, 0, 3);
  }
  this->Simulation->SetInputData(1, two);
  this->Heard->Notes.clear();
  EXPECT_EQ(this->Summary()->GetNumberOfRows(), 1);
  const auto said = [this](const std::string& words)
  {
    return std::any_of(this->Heard->Notes.begin(), this->Heard->Notes.end(),
      [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(said("1 of 2 blocks of the Rocks input had left the slope"));
}

TEST_F(TestContinuedRuns, AHairInsideTheSlopeIsOnIt)
{
  // The default slope falls by 57.7 m over 100 m; a grid of single precision is 1e-5 m off.
  this->Rocks->SetHorizontalDeviation(0.0);
  this->Rocks->SetPlaceOnGround(true);
  this->Rocks->SetInputConnection(1, this->Terrain->GetOutputPort());
  this->Rocks->Update();
  for (const double lowered : { 1e-6, 1e-5 })
  {
    vtkNew<vtkPolyData> low;
    low->DeepCopy(this->Rocks->GetOutput());
    for (vtkIdType id = 0; id < low->GetNumberOfPoints(); ++id)
    {
      const double* p = this->Rocks->GetOutput()->GetPoint(id);
      low->GetPoints()->SetPoint(id, p[0], p[1], p[2] - lowered);
    }
    this->Simulation->SetInputData(1, low);
    EXPECT_EQ(this->Summary()->GetNumberOfRows(), 1) << lowered;
  }
}
