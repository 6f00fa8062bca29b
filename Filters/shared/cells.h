#pragma once

/// @file
/// Cells of polydata, one after the other.

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <span>

namespace rockfall::filters
{

/// Calls `use(cell, points)` for each cell: its number, of which the first one has `first`, and
/// those of its points.
template <typename Use>
void forEachCell(vtkCellArray* cells, vtkIdType first, Use&& use)
{
  auto walk = vtk::TakeSmartPointer(cells->NewIterator());
  for (walk->GoToFirstCell(); !walk->IsDoneWithTraversal(); walk->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* points = nullptr;
    walk->GetCurrentCell(size, points);
    use(first++, std::span(points, std::size_t(size)));
  }
}

/// The same of lines; polydata's cells begin with its vertices.
template <typename Use>
void forEachLine(vtkPolyData* data, Use&& use)
{
  forEachCell(data->GetLines(), data->GetNumberOfVerts(), use);
}

} // namespace rockfall::filters
