#include "sources/shapeInput.h"

#include "base/errors.h"
#include "mesh/MeshBuilder.h"
#include "mesh/meshFile.h"
#include "shared/inputs.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <cstdint>
#include <vector>

namespace rockfall::filters
{

namespace
{

template <typename Use>
void forEachCell(vtkCellArray* cells, const Use& use)
{
  std::vector<std::int64_t> ids;
  const auto walk = vtk::TakeSmartPointer(cells->NewIterator());
  for (walk->GoToFirstCell(); !walk->IsDoneWithTraversal(); walk->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* points = nullptr;
    walk->GetCurrentCell(size, points);
    ids.assign(points, points + size);
    use(ids);
  }
}

} // namespace

Mesh meshOf(vtkPolyData* surface)
{
  MeshBuilder mesh(kShapeInput);
  for (vtkIdType k = 0; k < surface->GetNumberOfPoints(); ++k)
  {
    mesh.addPoint(Vec3(surface->GetPoint(k)));
  }
  forEachCell(surface->GetPolys(), [&](const auto& ids) { mesh.addFace(ids); });
  forEachCell(surface->GetStrips(), [&](const auto& ids) { mesh.addStrip(ids); });
  const bool single = surface->GetPoints() && surface->GetPoints()->GetDataType() == VTK_FLOAT;
  Mesh made = mesh.finish(single);
  checkMesh(made, kShapeInput);
  return made;
}

void requireOneShape(const std::string& field, const std::string& fileName, bool hasInput)
{
  if (hasInput && !fileName.empty())
  {
    throw ParameterError(field + " is " + fileName +
      ", and the Shape input is connected: one of them can be the shape");
  }
}

} // namespace rockfall::filters
