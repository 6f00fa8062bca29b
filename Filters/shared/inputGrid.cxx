// Unstructured grids of points, lines and polygons as polydata: Threshold, Merge Blocks and Append
// Datasets make such of trajectories and blocks.

#include "base/errors.h"
#include "shared/inputs.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <array>
#include <vector>

namespace rockfall::filters
{

namespace
{

/// In the order in which polydata have their cells.
enum CellKind
{
  Vertices,
  Lines,
  Polygons,
  Other
};

CellKind kindOf(int cellType)
{
  switch (cellType)
  {
    case VTK_VERTEX:
    case VTK_POLY_VERTEX:
      return Vertices;
    case VTK_LINE:
    case VTK_POLY_LINE:
      return Lines;
    case VTK_TRIANGLE:
    case VTK_QUAD:
    case VTK_POLYGON:
      return Polygons;
    default:
      return Other;
  }
}

} // namespace

vtkSmartPointer<vtkPolyData> polyDataOf(vtkUnstructuredGrid* grid, const std::string& name)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->GetFieldData()->ShallowCopy(grid->GetFieldData());
  data->SetPoints(grid->GetPoints());
  data->GetPointData()->ShallowCopy(grid->GetPointData());
  std::array<vtkNew<vtkCellArray>, Other> cells;
  std::array<std::vector<vtkIdType>, Other> numbers;
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    const int type = grid->GetCellType(cell);
    const CellKind kind = kindOf(type);
    if (kind == Other)
    {
      const auto such = vtk::TakeSmartPointer(vtkGenericCell::InstantiateCell(type));
      throw DataError(name + " is an unstructured grid whose cell " + std::to_string(cell) +
        " is a " + (such ? such->GetClassName() : "cell of type " + std::to_string(type)) +
        ": points, lines and polygons can be taken");
    }
    grid->GetCells()->GetCellAtId(cell, points);
    cells[kind]->InsertNextCell(points);
    numbers[kind].push_back(cell);
  }
  data->SetVerts(cells[Vertices]);
  data->SetLines(cells[Lines]);
  data->SetPolys(cells[Polygons]);
  vtkCellData *from = grid->GetCellData(), *to = data->GetCellData();
  to->CopyAllOn();
  to->CopyAllocate(from, grid->GetNumberOfCells());
  vtkIdType number = 0;
  for (const std::vector<vtkIdType>& ofKind : numbers)
  {
    for (const vtkIdType cell : ofKind)
    {
      to->CopyData(from, cell, number++);
    }
  }
  return data;
}

} // namespace rockfall::filters
