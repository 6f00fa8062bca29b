#include "sources/shapeInput.h"

#include "base/errors.h"
#include "mesh/MeshBuilder.h"
#include "mesh/meshFile.h"
#include "shared/cells.h"
#include "shared/inputs.h"

#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <cstdint>
#include <vector>

namespace rockfall::filters
{

Mesh meshOf(vtkPolyData* surface)
{
  MeshBuilder mesh(kShapeInput);
  for (vtkIdType k = 0; k < surface->GetNumberOfPoints(); ++k)
  {
    mesh.addPoint(Vec3(surface->GetPoint(k)));
  }
  using Numbers = std::vector<std::int64_t>;
  forEachCell(surface->GetPolys(), 0,
    [&](vtkIdType, auto ids) { mesh.addFace(Numbers(ids.begin(), ids.end())); });
  forEachCell(surface->GetStrips(), 0,
    [&](vtkIdType, auto ids) { mesh.addStrip(Numbers(ids.begin(), ids.end())); });
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
