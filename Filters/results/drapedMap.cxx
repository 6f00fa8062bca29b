#include "results/drapedMap.h"

#include "shared/slopeReference.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <array>
#include <vector>

namespace rockfall::filters
{

namespace
{

/// Over the slope, as a share of a cell and at most in m: enough for the depth buffer, and under
/// the paths of rocks that roll.
constexpr double kLift = 0.05;
constexpr double kMostLift = 0.1;

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
  const CellDiagonal rule = readDiagonal(map->GetFieldData());
  const double lift = heights ? std::min(kLift * map->GetSpacing()[0], kMostLift) : 0.0;

  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  // Of the corners in the row at hand and the next one: an image has far more than are drawn.
  std::array<std::vector<vtkIdType>, 2> pointOf;
  pointOf.fill(std::vector<vtkIdType>(std::size_t(columns) + 1, -1));
  vtkIdType row = 0;
  const auto point = [&](vtkIdType node)
  {
    const vtkIdType nodeRow = node / (columns + 1);
    vtkIdType& id = pointOf[std::size_t(nodeRow % 2)][std::size_t(node % (columns + 1))];
    if (id < 0)
    {
      double place[3];
      map->GetPoint(node, place);
      place[2] = lift + (heights ? heights->GetTuple1(node) : 0.0);
      id = points->InsertNextPoint(place);
    }
    return id;
  };
  vtkNew<vtkCellArray> cells;
  vtkCellData* data = output->GetCellData();
  // Room for the cells that something passed: without a size, for all of a map that may be mostly
  // empty.
  vtkIdType passed = 0;
  for (vtkIdType cell = 0; cell < map->GetNumberOfCells(); ++cell)
  {
    passed += passages->GetTuple1(cell) > 0.0 ? 1 : 0;
  }
  data->CopyAllOn();
  data->CopyAllocate(map->GetCellData(), std::max<vtkIdType>(2 * passed, 1));
  for (vtkIdType cell = 0; cell < map->GetNumberOfCells(); ++cell)
  {
    if (!(passages->GetTuple1(cell) > 0.0))
    {
      continue;
    }
    for (; row < cell / columns; ++row)
    {
      std::fill(pointOf[std::size_t(row % 2)].begin(), pointOf[std::size_t(row % 2)].end(), -1);
    }
    const vtkIdType south = cell + row, north = south + columns + 1;
    // Cut as the slope's cells are: a viewer would cut a quadrilateral along the shorter diagonal,
    // metres above or below the slope.
    const vtkIdType ends[4] = { point(north), point(south), point(south + 1), point(north + 1) };
    const auto height = [&](vtkIdType node) { return heights ? heights->GetTuple1(node) : 0.0; };
    const int rising =
      isCutRising(rule, height(north), height(north + 1), height(south), height(south + 1));
    for (const std::array<int, 3>& corners :
      { std::array{ rising, rising + 1, rising + 2 }, std::array{ 0, 2 - rising, 3 } })
    {
      const vtkIdType triangle[3] = { ends[corners[0]], ends[corners[1]], ends[corners[2]] };
      data->CopyData(map->GetCellData(), cell, cells->InsertNextCell(3, triangle));
    }
  }
  data->Squeeze();
  points->Squeeze();
  cells->Squeeze();
  output->SetPoints(points);
  output->SetPolys(cells);
  data->SetActiveScalars("ReachProbability");
  output->GetFieldData()->PassData(map->GetFieldData());
  // The mark of what can be written as a raster, and the rule that these triangles follow.
  output->GetFieldData()->RemoveArray("HazardMap");
  output->GetFieldData()->RemoveArray("TerrainCellDiagonal");
}

} // namespace rockfall::filters
