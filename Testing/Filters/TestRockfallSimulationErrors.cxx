#include "simulationTest.h"

#include "vtkClipPolyData.h"
#include "vtkPlane.h"
#include "vtkPlaneSource.h"
#include "vtkTransform.h"
#include "vtkTransformPolyDataFilter.h"

#include <cmath>

namespace
{

constexpr double cubeRadius = 0.8660254037844386; // m, half of the diagonal of 1 m³

class TestRockfallSimulationErrors : public SimulationTest
{
};

} // namespace

TEST_F(TestRockfallSimulationErrors, TerrainMustBeWhatItWas)
{
  vtkNew<vtkPlaneSource> plane;
  this->Simulation->SetInputConnection(0, plane->GetOutputPort());
  this->ExpectEmpty();
  this->ExpectOneError({ "Terrain", "DEM to CFE Mesh" });

  vtkNew<vtkTransform> transform;
  transform->Translate(0, 0, 1);
  vtkNew<vtkTransformPolyDataFilter> moved;
  moved->SetTransform(transform);
  moved->SetInputConnection(this->Terrain->GetOutputPort());
  this->Simulation->SetInputConnection(0, moved->GetOutputPort());
  this->ExpectEmpty();
  this->ExpectOneError({ "Terrain", "moved" });

  vtkNew<vtkPlane> half;
  half->SetOrigin(120, 0, 0);
  half->SetNormal(-1, 0, 0);
  vtkNew<vtkClipPolyData> clipped;
  clipped->SetClipFunction(half);
  clipped->SetInputConnection(this->Terrain->GetOutputPort());
  this->Simulation->SetInputConnection(0, clipped->GetOutputPort());
  this->ExpectEmpty();
  this->ExpectOneError({ "Terrain", "clipped" });
}

TEST_F(TestRockfallSimulationErrors, BadValuesAreOneErrorAndNothingElse)
{
  const struct
  {
    void (vtkRockfallSimulation::*set)(double);
    const char* name;
    double good;
  } values[] = { { &vtkRockfallSimulation::SetTimeStep, "TimeStep", 0.005 },
    { &vtkRockfallSimulation::SetEndTime, "EndTime", 3.0 },
    { &vtkRockfallSimulation::SetOutputInterval, "OutputInterval", 0.05 },
    { &vtkRockfallSimulation::SetNormalPenalty, "NormalPenalty", 1e9 },
    { &vtkRockfallSimulation::SetShearPenaltyRatio, "ShearPenaltyRatio", 1.0 } };
  for (const auto& entry : values)
  {
    for (double bad : { 0.0, -1.0, std::nan("") })
    {
      if (bad == 0.0 && entry.name == std::string("NormalPenalty"))
      {
        continue; // by mass
      }
      (this->Simulation->*entry.set)(bad);
      this->ExpectEmpty();
      this->ExpectOneError({ entry.name });
      this->RocksAt(1.0); // another time of the same failure is no other error
      EXPECT_TRUE(this->Heard->Errors.empty());
    }
    (this->Simulation->*entry.set)(entry.good);
  }
  this->Simulation->SetIterations(0);
  this->ExpectEmpty();
  this->ExpectOneError({ "Iterations", "0" });
  this->Simulation->SetIterations(2);
  this->Simulation->SetShownIteration(2);
  this->ExpectEmpty();
  this->ExpectOneError({ "ShownIteration", "2" });
  // What was simulated is still there when it is put right.
  this->Simulation->SetShownIteration(0);
  this->Simulation->Update();
  const int runs = this->Simulation->GetNumberOfRuns();
  const std::string hash = this->Simulation->GetStateHash();
  EXPECT_FALSE(hash.empty());
  this->Simulation->SetShownIteration(2);
  this->ExpectEmpty();
  this->ExpectOneError({ "ShownIteration", "2" });
  this->Simulation->SetShownIteration(1);
  this->Simulation->Update();
  EXPECT_EQ(this->Simulation->GetNumberOfRuns(), runs);
  EXPECT_EQ(this->Simulation->GetStateHash(), hash);
  this->Simulation->SetShownIteration(0);
  this->Simulation->SetSeed(-1);
  this->ExpectEmpty();
  this->ExpectOneError({ "Seed", "-1" });
  this->Simulation->SetSeed(0);
  this->Simulation->SetFirstIteration(-1);
  this->ExpectEmpty();
  this->ExpectOneError({ "FirstIteration", "-1" });
  this->Simulation->SetFirstIteration(0);
  this->Simulation->SetTrajectoryOutput(5);
  this->ExpectEmpty();
  this->ExpectOneError({ "TrajectoryOutput", "5", "0 to 4" });
  this->Simulation->SetTrajectoryOutput(vtkRockfallSimulation::FULL);
  this->Simulation->SetRockRestitution(1.5);
  this->ExpectEmpty();
  this->ExpectOneError({ "RockRestitution", "1.5" });
  this->Simulation->SetRockRestitution(0.5);
  this->Simulation->SetRockFrictionAngle(95);
  this->ExpectEmpty();
  this->ExpectOneError({ "RockFrictionAngle", "95" });
  this->Simulation->SetRockFrictionAngle(30);
  this->Simulation->SetRockCohesion(-1);
  this->ExpectEmpty();
  this->ExpectOneError({ "RockCohesion", "-1" });
  this->Simulation->SetRockCohesion(0);
  EXPECT_EQ(this->Summary()->GetNumberOfRows(), 2); // and it recovers
}

TEST_F(TestRockfallSimulationErrors, AnUnknownRestitutionModelInAFile)
{
  this->Terrain->Update();
  vtkNew<vtkPolyData> slope;
  slope->DeepCopy(this->Terrain->GetOutput());
  vtkDataArray* material = slope->GetFieldData()->GetArray("TerrainMaterial");
  ASSERT_TRUE(material);
  ASSERT_EQ(material->GetNumberOfValues(), 10);
  this->Simulation->SetInputData(0, slope);
  for (double model : { 3.0, -1.0, 0.5, 1e30, std::nan("") })
  {
    material->SetComponent(0, 7, model);
    slope->Modified();
    this->ExpectEmpty();
    this->ExpectOneError(
      { std::isnan(model) ? "TerrainMaterial has nan" : "TerrainMaterial says RestitutionModel" });
  }
  material->SetComponent(0, 7, 2.0);
  material->SetComponent(0, 9, -1.0);
  slope->Modified();
  this->ExpectEmpty();
  this->ExpectOneError({ "RestitutionSpeed", "-1" });
}

TEST_F(TestRockfallSimulationErrors, BadPlacesAreErrorsOfTheBlock)
{
  this->Rocks->SetFirstBlockId(5);
  this->Rocks->SetCenter(-20, 50, 58);
  this->ExpectEmpty();
  this->ExpectOneError({ "block 5", "outside the slope", "-20" });
  this->Rocks->SetCenter(50, 50, 28.85); // on the surface: half of it in the ground
  this->ExpectEmpty();
  this->ExpectOneError({ "block 5", "inside the slope" });
  this->Rocks->SetCenter(50, 50, 28.85 + cubeRadius);
  EXPECT_EQ(this->Summary()->GetNumberOfRows(), 1);
}

TEST_F(TestRockfallSimulationErrors, AFailedInputIsNotAnotherError)
{
  this->Rocks->SetVolume(-1.0);
  this->ExpectEmpty();
  this->ExpectOneError({ "Volume", "-1" });
  this->ExpectEmpty(); // now the source counts as up to date
  this->RocksAt(1.0);
  EXPECT_TRUE(this->Heard->Errors.empty());
  this->Rocks->SetVolume(1.0);
  EXPECT_EQ(this->Summary()->GetNumberOfRows(), 1);
}

TEST_F(TestRockfallSimulationErrors, EmptyRocksAreAnError)
{
  vtkNew<vtkPolyData> nothing;
  this->Simulation->SetInputData(1, nothing);
  this->ExpectEmpty();
  this->ExpectOneError({ "Rocks", "no polygons" });
}

TEST_F(TestRockfallSimulationErrors, RocksOfAnotherCrs)
{
  this->Terrain->Update();
  this->Rocks->Update();
  vtkNew<vtkPolyData> slope, rocks;
  slope->ShallowCopy(this->Terrain->GetOutput());
  rocks->ShallowCopy(this->Rocks->GetOutput());
  setCrs(slope, "EPSG:32617");
  setCrs(rocks, "EPSG:32632");
  this->Simulation->SetInputData(0, slope);
  this->Simulation->SetInputData(1, rocks);
  this->ExpectEmpty();
  this->ExpectOneError({ "Rocks", "EPSG:32632", "zone 32N", "Terrain", "EPSG:32617" });
  rocks->GetFieldData()->RemoveArray("TerrainCRS"); // then it is not known
  rocks->Modified();
  EXPECT_EQ(this->Summary()->GetNumberOfRows(), 1);
}
