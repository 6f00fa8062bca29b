#include "pathGroups.h"

#include "base/errors.h"
#include "geometry/shapes.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkVariant.h"

#include <map>

namespace rockfall::filters
{

namespace
{

std::string groupName(const std::string& arrayName, const vtkVariant& value)
{
  if (arrayName == "Shape" && value.IsNumeric())
  {
    const int number = value.ToInt();
    if (number >= int(Shape::Cube) && number <= int(Shape::File))
    {
      return shapeName(Shape(number));
    }
  }
  return value.ToString();
}

} // namespace

std::vector<PathGroup> groupPaths(vtkPolyData* input, const std::string& arrayName)
{
  if (input->GetNumberOfLines() == 0)
  {
    throw DataError("The Input has no lines; the trajectories of Rockfall Simulation are wanted");
  }
  vtkAbstractArray* array = nullptr;
  if (!arrayName.empty())
  {
    array = input->GetCellData()->GetAbstractArray(arrayName.c_str());
    if (!array)
    {
      throw DataError("The Input has no cell array \"" + arrayName +
        "\" to group the trajectories by; an empty Group By takes them all together");
    }
  }
  std::vector<PathGroup> groups;
  std::map<vtkVariant, std::size_t> order;
  const auto collect = [&](auto&& use)
  {
    vtkIdType cell = input->GetNumberOfVerts(); // polydata's cells begin with its vertices
    auto lines = vtk::TakeSmartPointer(input->GetLines()->NewIterator());
    for (lines->GoToFirstCell(); !lines->IsDoneWithTraversal(); lines->GoToNextCell(), ++cell)
    {
      use(array ? array->GetVariantValue(cell * array->GetNumberOfComponents()) : vtkVariant(0),
        lines);
    }
  };
  collect([&](const vtkVariant& value, auto&) { order.emplace(value, 0); });
  for (auto& [value, index] : order)
  {
    index = groups.size();
    groups.emplace_back().name = array ? groupName(arrayName, value) : "all";
  }
  collect(
    [&](const vtkVariant& value, auto& lines)
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      lines->GetCurrentCell(size, ids);
      std::vector<Vec3>& path = groups[order.at(value)].paths.emplace_back();
      for (vtkIdType k = 0; k < size; ++k)
      {
        input->GetPoint(ids[k], path.emplace_back().data());
      }
    });
  return groups;
}

} // namespace rockfall::filters
