#pragma once

/// @file
/// Trajectories made by hand, with all arrays that Rockfall Simulation gives them.

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <array>

class HandMadeTrajectories
{
public:
  HandMadeTrajectories()
  {
    this->Points->SetDataTypeToDouble();
    this->Data->SetPoints(this->Points);
    this->Data->SetLines(this->Lines);
    for (const char* name : { "Time", "KineticEnergy", "HeightOverGround" })
    {
      this->Add<vtkDoubleArray>(this->Data->GetPointData(), name, 1);
    }
    for (const char* name : { "Velocity", "RotationRate" })
    {
      this->Add<vtkDoubleArray>(this->Data->GetPointData(), name, 3);
    }
    this->Add<vtkIdTypeArray>(this->Data->GetCellData(), "BlockId", 1);
    for (const char* name : { "RockId", "Iteration", "Fate" })
    {
      this->Add<vtkIntArray>(this->Data->GetCellData(), name, 1);
    }
    for (const char* name : { "Mass", "Width" })
    {
      this->Add<vtkDoubleArray>(this->Data->GetCellData(), name, 1);
    }
    vtkNew<vtkStringArray> crs;
    crs->SetName("TerrainCRS");
    crs->InsertNextValue("EPSG:32632");
    this->Data->GetFieldData()->AddArray(crs);
  }

  /// Straight and level along x, at `speed` m/s from (x, y, z) to x + length, points of 1000 kg.
  void AddLevel(int iteration, int rock, std::array<double, 3> from, double length, double speed,
    double height = 2.0, int fate = 1)
  {
    this->Lines->InsertNextCell(2);
    vtkPointData* points = this->Data->GetPointData();
    for (int k = 0; k < 2; ++k)
    {
      this->Lines->InsertCellPoint(
        this->Points->InsertNextPoint(from[0] + k * length, from[1], from[2]));
      points->GetArray("Time")->InsertNextTuple1(k * length / speed);
      points->GetArray("KineticEnergy")->InsertNextTuple1(500.0 * speed * speed + 100.0);
      points->GetArray("HeightOverGround")->InsertNextTuple1(height);
      points->GetArray("Velocity")->InsertNextTuple3(speed, 0.0, 0.0);
      points->GetArray("RotationRate")->InsertNextTuple3(0.0, 3.0, 4.0);
    }
    vtkCellData* cells = this->Data->GetCellData();
    cells->GetArray("BlockId")->InsertNextTuple1(100 + rock);
    cells->GetArray("RockId")->InsertNextTuple1(rock);
    cells->GetArray("Iteration")->InsertNextTuple1(iteration);
    cells->GetArray("Fate")->InsertNextTuple1(fate);
    cells->GetArray("Mass")->InsertNextTuple1(1000.0);
    cells->GetArray("Width")->InsertNextTuple1(0.0);
    this->Lines->Modified();
    this->Data->Modified();
  }

  vtkNew<vtkPolyData> Data;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Lines;

private:
  template <typename Array>
  void Add(vtkFieldData* data, const char* name, int components)
  {
    vtkNew<Array> array;
    array->SetName(name);
    array->SetNumberOfComponents(components);
    data->AddArray(array);
  }
};
