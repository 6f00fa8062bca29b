#include "results/pathGroups.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "geometry/shapes.h"
#include "geometry/shell.h"
#include "shared/cells.h"
#include "shared/inputs.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkPolyData.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cmath>
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
    if (number >= 0 && number < kShapes)
    {
      return shapeName(Shape(number));
    }
  }
  return value.ToString();
}

/// Name of the class before the limit of this number.
std::string className(const std::vector<double>& limits, std::size_t number)
{
  if (number == 0)
  {
    return "below " + numberText(limits.front());
  }
  return number == limits.size()
    ? numberText(limits.back()) + " and above"
    : numberText(limits[number - 1]) + " to " + numberText(limits[number]);
}

void checkLimits(const std::vector<double>& limits)
{
  requireFew(limits.size(), "ClassLimits");
  for (std::size_t k = 0; k < limits.size(); ++k)
  {
    if (!std::isfinite(limits[k]) || (k > 0 && !(limits[k] > limits[k - 1])))
    {
      throw ParameterError("ClassLimits has " + numberText(limits[k]) + " as number " +
        std::to_string(k + 1) + ", its numbers must be finite and ascend");
    }
  }
}

} // namespace

std::vector<PathGroup> groupPaths(
  vtkPolyData* input, const std::string& arrayName, const std::vector<double>& limits)
{
  checkLimits(limits);
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
  vtkDataArray* piece = input->GetCellData()->GetArray("Piece");
  const bool classes = array && !limits.empty();
  if (classes && !array->IsNumeric())
  {
    throw DataError("The Input's cell array \"" + arrayName +
      "\" is not of numbers, so ClassLimits cannot divide it");
  }
  std::vector<PathGroup> groups;
  std::map<vtkVariant, std::size_t> order;
  const auto collect = [&](auto&& use)
  {
    const vtkIdType first = input->GetNumberOfVerts(); // polydata's cells begin with its vertices
    vtkVariant ofRock;
    forEachCell(input->GetLines(), first,
      [&](vtkIdType cell, std::span<const vtkIdType> ids)
      {
        const bool begins = !piece || cell == first || piece->GetComponent(cell, 0) == 0.0;
        if (!begins)
        {
          use(ofRock, false, ids);
          return;
        }
        vtkVariant value =
          array ? array->GetVariantValue(cell * array->GetNumberOfComponents()) : vtkVariant(0);
        if (value.IsNumeric() && std::isnan(value.ToDouble()))
        {
          throw DataError("The Input's cell array \"" + arrayName + "\" has nan at cell " +
            std::to_string(cell) + ", which is in no group");
        }
        if (classes)
        {
          const auto above = std::upper_bound(limits.begin(), limits.end(), value.ToDouble());
          value = vtkVariant(int(above - limits.begin()));
        }
        ofRock = value;
        use(value, true, ids);
      });
  };
  collect([&](const vtkVariant& value, bool, auto) { order.emplace(value, 0); });
  for (auto& [value, index] : order)
  {
    index = groups.size();
    groups.emplace_back().name = classes ? className(limits, std::size_t(value.ToInt()))
      : array                            ? groupName(arrayName, value)
                                         : "all";
  }
  collect(
    [&](const vtkVariant& value, bool begins, auto ids)
    {
      PathGroup& group = groups[order.at(value)];
      group.rockOf.push_back(begins ? group.paths.size() : group.rockOf.back());
      std::vector<Vec3>& path = group.paths.emplace_back();
      for (const vtkIdType id : ids)
      {
        input->GetPoint(id, path.emplace_back().data());
      }
    });
  return groups;
}

} // namespace rockfall::filters
