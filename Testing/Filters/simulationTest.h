#pragma once

/// @file
/// The fixture of the simulation's tests: the default slope and rock, 3 s of it.

#include "helpers.h"

#include "vtkDEMToCFESource.h"
#include "vtkDataObject.h"
#include "vtkPolyData.h"
#include "vtkRockBlockSource.h"
#include "vtkRockfallSimulation.h"
#include "vtkTable.h"

class SimulationTest : public FilterTest
{
protected:
  void SetUp() override
  {
    this->FilterTest::SetUp();
    this->Simulation->SetInputConnection(0, this->Terrain->GetOutputPort());
    this->Simulation->SetInputConnection(1, this->Rocks->GetOutputPort());
    this->Simulation->SetEndTime(3.0);
  }

  vtkPolyData* RocksAt(double time)
  {
    this->Simulation->UpdateTimeStep(time);
    return vtkPolyData::SafeDownCast(this->Simulation->GetOutputDataObject(0));
  }
  vtkPolyData* Output(int port)
  {
    this->Simulation->Update();
    return vtkPolyData::SafeDownCast(this->Simulation->GetOutputDataObject(port));
  }
  vtkTable* Summary()
  {
    this->Simulation->Update();
    return vtkTable::SafeDownCast(this->Simulation->GetOutputDataObject(3));
  }
  void ExpectEmpty()
  {
    this->Simulation->Update();
    for (int port = 0; port < 4; ++port)
    {
      vtkDataObject* output = this->Simulation->GetOutputDataObject(port);
      EXPECT_EQ(output->GetNumberOfElements(vtkDataObject::POINT), 0) << port;
      EXPECT_EQ(output->GetNumberOfElements(vtkDataObject::ROW), 0) << port;
    }
  }

  vtkNew<vtkDEMToCFESource> Terrain;
  vtkNew<vtkRockBlockSource> Rocks;
  vtkNew<vtkRockfallSimulation> Simulation;
};
