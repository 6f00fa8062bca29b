#include "shared/inputContent.h"

#include "shared/slopeReference.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string>

namespace rockfall::filters
{

namespace
{

/// Over bytes, eight at a time; two contents have one number by chance only, 2⁻⁶⁴.
class Content
{
public:
  void add(std::uint64_t word)
  {
    value_ = (value_ ^ word) * 0x9e3779b97f4a7c15u;
    value_ ^= value_ >> 32;
  }

  void add(const void* data, std::size_t size)
  {
    this->add(size);
    const char* bytes = static_cast<const char*>(data);
    for (; size >= sizeof(std::uint64_t); size -= sizeof(std::uint64_t))
    {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes, sizeof(word));
      this->add(word);
      bytes += sizeof(word);
    }
    std::uint64_t rest = 0;
    std::memcpy(&rest, bytes, size);
    this->add(rest);
  }

  void add(std::string_view text) { this->add(text.data(), text.size()); }

  void add(vtkAbstractArray* array)
  {
    this->add(std::string_view(array->GetName() ? array->GetName() : ""));
    this->add(std::uint64_t(array->GetNumberOfComponents()));
    if (auto* texts = vtkStringArray::SafeDownCast(array))
    {
      for (vtkIdType k = 0; k < texts->GetNumberOfValues(); ++k)
      {
        this->add(std::string_view(texts->GetValue(k)));
      }
    }
    else if (auto* numbers = vtkDataArray::SafeDownCast(array))
    {
      this->add(std::uint64_t(numbers->GetDataType()));
      this->add(numbers->GetVoidPointer(0),
        std::size_t(numbers->GetNumberOfValues()) * std::size_t(numbers->GetDataTypeSize()));
    }
  }

  std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_ = 0x243f6a8885a308d3u;
};

/// In the order of their names: filters change that in which they stand.
template <typename Wanted>
void addArrays(vtkFieldData* data, Content& content, Wanted&& wanted)
{
  std::map<std::string, vtkAbstractArray*> arrays;
  for (int k = 0; k < data->GetNumberOfArrays(); ++k)
  {
    vtkAbstractArray* array = data->GetAbstractArray(k);
    if (array->GetName() && wanted(std::string_view(array->GetName())))
    {
      arrays.emplace(array->GetName(), array);
    }
  }
  for (const auto& [name, array] : arrays)
  {
    content.add(array);
  }
}

} // namespace

std::uint64_t terrainContent(vtkFieldData* terrain)
{
  if (!terrain->GetAbstractArray(kHeightsArray))
  {
    return slopeKey(terrain).value_or(0);
  }
  Content content;
  addArrays(terrain, content,
    [](std::string_view name) {
      return isOfSlope(std::string(name).c_str()) && name != kGridArray && !name.ends_with("Names");
    });
  // The last number of the grid is the stride of what is shown.
  if (vtkDataArray* grid = terrain->GetArray(kGridArray))
  {
    for (vtkIdType k = 0; k + 1 < grid->GetNumberOfValues(); ++k)
    {
      const double number = grid->GetComponent(
        k / grid->GetNumberOfComponents(), int(k % grid->GetNumberOfComponents()));
      content.add(&number, sizeof(number));
    }
  }
  return content.value();
}

std::uint64_t rocksContent(vtkPolyData* rocks, std::initializer_list<std::string_view> names)
{
  Content content;
  if (rocks->GetPoints())
  {
    content.add(rocks->GetPoints()->GetData());
  }
  for (vtkCellArray* cells :
    { rocks->GetVerts(), rocks->GetLines(), rocks->GetPolys(), rocks->GetStrips() })
  {
    content.add(cells->GetOffsetsArray());
    content.add(cells->GetConnectivityArray());
  }
  const auto left = [&](std::string_view name)
  { return std::find(names.begin(), names.end(), name) != names.end(); };
  addArrays(rocks->GetCellData(), content, [&](std::string_view name) { return !left(name); });
  // Names of blocks stand here or there.
  addArrays(rocks->GetFieldData(), content,
    [&](std::string_view name)
    {
      return name == "TerrainCRS" || name == "LocalOrigin" || name == "NamedBlock" ||
        ((name == "Material" || name == "SourceName") && !left(name));
    });
  return content.value();
}

std::vector<std::string> doubtsOfRun(vtkFieldData* fields)
{
  std::vector<std::string> doubts;
  auto* texts = vtkStringArray::SafeDownCast(fields->GetAbstractArray(kRunDoubts));
  for (vtkIdType k = 0; texts && k < texts->GetNumberOfValues(); ++k)
  {
    doubts.push_back(texts->GetValue(k));
  }
  return doubts;
}

RunOrigin runOf(vtkPolyData* trajectories)
{
  vtkFieldData* data = trajectories->GetFieldData();
  auto* properties = vtkStringArray::SafeDownCast(data->GetAbstractArray(kRunProperties));
  return { terrainContent(data),
    properties && properties->GetNumberOfValues() == 1 ? std::string(properties->GetValue(0))
                                                       : std::string() };
}

std::string otherSlope(vtkPolyData* trajectories, vtkPolyData* mesh)
{
  const std::uint64_t of = mesh ? terrainContent(mesh->GetFieldData()) : 0;
  const std::uint64_t under = trajectories ? terrainContent(trajectories->GetFieldData()) : 0;
  return of != 0 && under != 0 && of != under
    ? "The trajectories fell on another slope than the Terrain: heights, ground or structures "
      "differ. Connect the slope of their run"
    : "";
}

} // namespace rockfall::filters
