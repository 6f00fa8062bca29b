#pragma once

/// @file
/// The fixture of the simulation's tests: the default slope and rock without chance, 3 s of it.

#include "helpers.h"

#include "vtkDEMToCFESource.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRockBlockSource.h"
#include "vtkRockfallSimulation.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <cmath>
#include <vector>

constexpr double gravity = 9.81;       // m/s², the filter's default
constexpr double releaseHeight = 58.0; // m, the rock source's default

/// Middle of a mesh along an axis, m.
inline double middle(vtkPolyData* mesh, int axis)
{
  double bounds[6];
  mesh->GetBounds(bounds);
  return 0.5 * (bounds[2 * axis] + bounds[2 * axis + 1]);
}

/// All numbers of a polydata's points and arrays, to compare runs bit by bit.
inline std::vector<double> numbersOf(vtkPolyData* data)
{
  std::vector<double> numbers;
  const auto append = [&](vtkDataArray* array)
  {
    for (vtkIdType k = 0; array && k < array->GetNumberOfValues(); ++k)
    {
      const double v = array->GetVariantValue(k).ToDouble();
      numbers.push_back(std::isnan(v) ? -1e300 : v);
    }
  };
  append(data->GetPoints()->GetData());
  for (int k = 0; k < data->GetPointData()->GetNumberOfArrays(); ++k)
  {
    append(data->GetPointData()->GetArray(k));
  }
  return numbers;
}

class SimulationTest : public FilterTest
{
protected:
  void SetUp() override
  {
    this->FilterTest::SetUp();
    this->Simulation->SetInputConnection(0, this->Terrain->GetOutputPort());
    this->Simulation->SetInputConnection(1, this->Rocks->GetOutputPort());
    this->Simulation->SetEndTime(3.0);
    this->Terrain->SetRoughnessMean(0.0);
    this->Terrain->SetRoughnessDeviation(0.0);
    this->Terrain->SetRestitutionDeviation(0.0);
    this->Rocks->SetAttitudeLaw(vtkRockBlockSource::AS_GIVEN);
  }

  /// Most slopes of these tests are bare rock, which a note says.
  void ForgetBareRock()
  {
    std::erase_if(this->Heard->Notes,
      [](const std::string& note) { return note.find("bare rock") != std::string::npos; });
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
