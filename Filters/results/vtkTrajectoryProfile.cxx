#include "vtkTrajectoryProfile.h"

#include "base/errors.h"
#include "results/trajectoriesInput.h"
#include "shared/arrays.h"
#include "shared/inputs.h"
#include "shared/rockPaths.h"

#include "vtkCellArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <string>

vtkStandardNewMacro(vtkTrajectoryProfile);

namespace
{

using rockfall::filters::addArray;

void writeProfile(const rockfall::RockPath& path, vtkTable* table)
{
  vtkFieldData* rows = table->GetRowData();
  const auto time = addArray<vtkDoubleArray>(rows, "Time");
  const auto distance = addArray<vtkDoubleArray>(rows, "Distance");
  const auto elevation = addArray<vtkDoubleArray>(rows, "Elevation");
  const auto speed = addArray<vtkDoubleArray>(rows, "Speed");
  const auto energy = addArray<vtkDoubleArray>(rows, "EnergyInKilojoules");
  const auto height = addArray<vtkDoubleArray>(rows, "HeightOverGround");
  double way = 0.0;
  const rockfall::PathPoint* before = nullptr;
  for (const rockfall::PathPoint& point : path.points)
  {
    way += before ? (point.position - before->position).head<2>().norm() : 0.0;
    before = &point;
    time->InsertNextValue(point.time);
    distance->InsertNextValue(way);
    elevation->InsertNextValue(point.position.z());
    speed->InsertNextValue(point.velocity.norm());
    energy->InsertNextValue(1e-3 * point.kineticEnergy);
    height->InsertNextValue(point.heightOverGround);
  }
  vtkFieldData* field = table->GetFieldData();
  addArray<vtkIdTypeArray>(field, "BlockId")->InsertNextValue(path.blockId);
  addArray<vtkIntArray>(field, "RockId")->InsertNextValue(path.rock);
  addArray<vtkIntArray>(field, "Iteration")->InsertNextValue(path.iteration);
}

void writeLine(const rockfall::RockPath& path, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(int(path.points.size()));
  for (const rockfall::PathPoint& point : path.points)
  {
    lines->InsertCellPoint(points->InsertNextPoint(point.position.data()));
  }
  output->SetPoints(points);
  output->SetLines(lines);
}

} // namespace

//------------------------------------------------------------------------------
vtkTrajectoryProfile::vtkTrajectoryProfile()
{
  this->SetNumberOfInputPorts(1);
  this->SetNumberOfOutputPorts(2);
}

//------------------------------------------------------------------------------
vtkTrajectoryProfile::~vtkTrajectoryProfile() = default;

//------------------------------------------------------------------------------
int vtkTrajectoryProfile::FillInputPortInformation(int, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  return 1;
}

//------------------------------------------------------------------------------
int vtkTrajectoryProfile::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkTable" : "vtkPolyData");
  return 1;
}

//------------------------------------------------------------------------------
int vtkTrajectoryProfile::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return rockfall::filters::attemptTrajectories(this, inputVector[0], outputVector,
    "The trajectory's profile does not fit in memory",
    [&](vtkPolyData* input)
    {
      const vtkIdType lines = input->GetNumberOfLines();
      if (this->Trajectory >= lines && rockfall::filters::isRunning(input->GetFieldData()))
      {
        return 1; // it is still to come
      }
      if (this->Trajectory < 0 || (lines > 0 && this->Trajectory >= lines))
      {
        throw rockfall::ParameterError("Trajectory is " + std::to_string(this->Trajectory) +
          ", it must be 0 to " + std::to_string(lines - 1) + ", the last of the Input");
      }
      vtkTable* table = vtkTable::GetData(outputVector, 0);
      vtkPolyData* line = vtkPolyData::GetData(outputVector, 1);
      rockfall::filters::forPath(input, this->Trajectory,
        [table, line](const rockfall::RockPath& path)
        {
          writeProfile(path, table);
          writeLine(path, line);
        });
      return 1;
    });
}

//------------------------------------------------------------------------------
void vtkTrajectoryProfile::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Trajectory: " << this->Trajectory << "\n";
}
