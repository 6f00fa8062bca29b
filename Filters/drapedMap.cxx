#include "drapedMap.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <vector>

namespace rockfall::filters
{

namespace
{

/// Over the slope, as a share of a cell: enough for the depth buffer, too little to be seen.
constexpr double kLift = 0.05;

} // namespace

void drapeMap(vtkImageData* map, vtkPolyData* output)
{
  vtkDataArray* passages = map->GetCellData()->GetArray("Passages");
  if (!passages)
  {
    return;
  }
  vtkDataArray* heights = map->GetPointData()->GetArray("Elevation");
  const int columns = map->GetDimensions()[0] - 1;
  const double lift = heights ? kLift * map->GetSpacing()[0] : 0.0;

  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  std::vector<int> pointOf(std::size_t(map->GetNumberOfPoints()), -1);
  const auto point = [&](vtkIdType node)
  {
    int& id = pointOf[std::size_t(node)];
    if (id < 0)
    {
      double place[3];
      map->GetPoint(node, place);
      place[2] = lift + (heights ? heights->GetTuple1(node) : 0.0);
      id = int(points->InsertNextPoint(place));
    }
    return vtkIdType(id);
  };
  vtkNew<vtkCellArray> cells;
  vtkCellData* data = output->GetCellData();
  data->CopyAllOn();
  data->CopyAllocate(map->GetCellData());
  for (vtkIdType cell = 0; cell < map->GetNumberOfCells(); ++cell)
  {
    if (!(passages->GetTuple1(cell) > 0.0))
    {
      continue;
    }
    const vtkIdType south = cell + cell / columns, north = south + columns + 1;
    // From the north-west: viewers cut a quadrilateral there, as the slope's cells are cut.
    const vtkIdType corners[4] = { point(north), point(south), point(south + 1), point(north + 1) };
    const vtkIdType made = cells->InsertNextCell(4, corners);
    data->CopyData(map->GetCellData(), cell, made);
  }
  data->Squeeze();
  points->Squeeze();
  cells->Squeeze();
  output->SetPoints(points);
  output->SetPolys(cells);
  data->SetActiveScalars("ReachProbability");
  output->GetFieldData()->PassData(map->GetFieldData());
  output->GetFieldData()->RemoveArray("HazardMap"); // the mark of what can be written as a raster
}

} // namespace rockfall::filters
