// Composite data as one polydata.

#include "base/errors.h"
#include "shared/arrays.h"
#include "shared/inputContent.h"
#include "shared/inputs.h"
#include "shared/slopeReference.h"

#include "vtkAbstractArray.h"
#include "vtkAppendPolyData.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVariant.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

namespace rockfall::filters
{

namespace
{

constexpr char errorOfPart[] = "Error";

struct Part
{
  vtkSmartPointer<vtkPolyData> data;
  int number; ///< Among all parts, from 1.
};

std::string partName(const std::string& name, const Part& part)
{
  return name + " is composite, its part " + std::to_string(part.number);
}

/// Parts that are not empty, and parts that say why they are.
std::vector<Part> partsOf(vtkCompositeDataSet* composite, const std::string& name)
{
  std::vector<Part> parts;
  int number = 0;
  for (vtkDataObject* object : leavesOf(composite))
  {
    ++number;
    vtkSmartPointer<vtkPolyData> data = vtkPolyData::SafeDownCast(object);
    if (auto* grid = vtkUnstructuredGrid::SafeDownCast(object))
    {
      data = polyDataOf(grid, partName(name, { nullptr, number }));
    }
    if (!data)
    {
      throw DataError(partName(name, { nullptr, number }) + " a " + object->GetClassName() +
        ": polygonal data are needed in all of them (Extract Surface makes such)");
    }
    if (data->GetNumberOfPoints() > 0 || data->GetNumberOfCells() > 0 ||
      data->GetFieldData()->GetNumberOfArrays() > 0)
    {
      parts.push_back({ data, number });
    }
  }
  return parts;
}

/// Throws unless the cells of both have the same arrays: appended, a block of one part would have
/// the values that it has, one of the other part the defaults, without a word.
void checkAlike(const Part& first, const Part& other, const std::string& name)
{
  const auto within = [&](const Part& a, const Part& b)
  {
    vtkFieldData* arrays = a.data->GetCellData();
    for (int k = 0; k < arrays->GetNumberOfArrays(); ++k)
    {
      vtkAbstractArray* array = arrays->GetAbstractArray(k);
      vtkAbstractArray* like =
        array->GetName() ? b.data->GetCellData()->GetAbstractArray(array->GetName()) : array;
      if (!like || like->GetNumberOfComponents() != array->GetNumberOfComponents() ||
        like->IsNumeric() != array->IsNumeric())
      {
        throw DataError(partName(name, b) + " has no cell array " + array->GetName() + " as part " +
          std::to_string(a.number) + " has it: what is taken as one must be alike");
      }
    }
  };
  within(first, other);
  within(other, first);
}

bool sameArray(vtkAbstractArray* a, vtkAbstractArray* b)
{
  bool equal = a->GetNumberOfValues() == b->GetNumberOfValues();
  for (vtkIdType k = 0; equal && k < a->GetNumberOfValues(); ++k)
  {
    equal = a->GetVariantValue(k) == b->GetVariantValue(k);
  }
  return equal;
}

/// The field data of the first part that has an array. Where the parts stand, and what is kept of
/// trajectories, must be one for all.
void mergeFields(const std::vector<Part>& parts, const std::string& name, vtkFieldData* output)
{
  for (const Part& part : parts)
  {
    vtkFieldData* fields = part.data->GetFieldData();
    for (int k = 0; k < fields->GetNumberOfArrays(); ++k)
    {
      vtkAbstractArray* array = fields->GetAbstractArray(k);
      if (array->GetName() && !output->GetAbstractArray(array->GetName()))
      {
        output->AddArray(array);
      }
    }
    addTiles(fields, output);
    for (const char* common : { "TerrainCRS", "TerrainGrid", "TrajectoryOutput" })
    {
      vtkAbstractArray* array = fields->GetAbstractArray(common);
      if (array && !sameArray(array, output->GetAbstractArray(common)))
      {
        throw DataError(partName(name, part) + " has another " + common +
          " than those before: what is taken as one must be of one slope and one kind");
      }
    }
  }
}

/// What differs between the runs of these parts goes into the field data with what each says of its
/// own, and how many rocks the first one had out of it.
void askAfterParts(const std::vector<Part>& parts, vtkFieldData* output)
{
  const auto nameOf = [&](std::size_t k)
  { return "part " + std::to_string(parts[k].number) + " of the Input"; };
  std::vector<RunOrigin> runs;
  std::vector<std::string> ofTheirOwn;
  for (std::size_t k = 0; k < parts.size(); ++k)
  {
    runs.push_back(runOf(parts[k].data));
    for (const std::string& doubt : doubtsOfRun(parts[k].data->GetFieldData()))
    {
      ofTheirOwn.push_back(nameOf(k) + ": " + doubt);
    }
  }
  std::vector<std::string> notes = askAfterRuns(runs, nameOf);
  std::ranges::move(ofTheirOwn, std::back_inserter(notes));
  output->RemoveArray(kRocksReleased);
  output->RemoveArray(kRunDoubts);
  addTexts(output, kRunDoubts, notes);
}

/// The one part that is a slope; null if none is.
vtkPolyData* slopeOf(const std::vector<Part>& parts, const std::string& name)
{
  vtkPolyData* slope = nullptr;
  for (const Part& part : parts)
  {
    if (part.data->GetFieldData()->GetAbstractArray(kHeightsArray))
    {
      if (slope)
      {
        throw DataError(partName(name, part) +
          " is a second slope; rocks fall on one: give one of them, or make one DEM of both");
      }
      slope = part.data;
    }
  }
  return slope;
}

} // namespace

std::vector<vtkDataObject*> leavesOf(vtkDataObject* data)
{
  auto* composite = vtkCompositeDataSet::SafeDownCast(data);
  if (!composite)
  {
    return data ? std::vector<vtkDataObject*>{ data } : std::vector<vtkDataObject*>();
  }
  std::vector<vtkDataObject*> leaves;
  auto iterator = vtk::TakeSmartPointer(composite->NewIterator());
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    leaves.push_back(iterator->GetCurrentDataObject());
  }
  return leaves;
}

vtkImageData* oneImage(vtkDataObject* data, const std::string& name)
{
  vtkImageData* image = nullptr;
  for (vtkDataObject* leaf : leavesOf(data))
  {
    auto* one = vtkImageData::SafeDownCast(leaf);
    if (!one || image)
    {
      throw DataError(name + " is composite, with " +
        (one ? "several images in it" : std::string("a ") + leaf->GetClassName() + " in it") +
        ": one hazard map is needed");
    }
    image = one;
  }
  return image;
}

vtkSmartPointer<vtkPolyData> onePolyData(
  vtkDataObject* data, InputKind kind, const std::string& name)
{
  if (auto* whole = vtkPolyData::SafeDownCast(data))
  {
    return whole;
  }
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    return polyDataOf(grid, name);
  }
  auto* composite = vtkCompositeDataSet::SafeDownCast(data);
  if (!composite)
  {
    throw DataError(name + " is a " + data->GetClassName() + ", polygonal data are needed");
  }
  const std::vector<Part> parts = partsOf(composite, name);
  for (const Part& part : parts)
  {
    if (part.data->GetFieldData()->GetAbstractArray(errorOfPart))
    {
      return part.data; // has failed before
    }
  }
  if (kind == InputKind::Terrain)
  {
    if (vtkPolyData* slope = slopeOf(parts, name))
    {
      return slope;
    }
  }
  std::vector<Part> filled;
  for (const Part& part : parts)
  {
    if (part.data->GetNumberOfPoints() > 0)
    {
      filled.push_back(part);
    }
  }
  if (parts.size() == 1)
  {
    return parts.front().data;
  }
  if (kind == InputKind::Rocks && filled.size() > 1)
  {
    throw DataError(name + " is composite, of " + std::to_string(filled.size()) +
      " parts: rocks of one run are one polydata. Take Append Geometry in the place of Group "
      "Datasets, or Merge Blocks with the output Polygonal Mesh");
  }
  auto one = vtkSmartPointer<vtkPolyData>::New();
  if (!filled.empty())
  {
    vtkNew<vtkAppendPolyData> append;
    for (const Part& part : filled)
    {
      checkAlike(filled.front(), part, name);
      checkPolyData(part.data, kind, partName(name, part));
      append->AddInputData(part.data);
    }
    append->Update();
    one->ShallowCopy(append->GetOutput());
  }
  one->GetFieldData()->Initialize();
  mergeFields(parts, name, one->GetFieldData());
  if (kind == InputKind::Trajectories && filled.size() > 1)
  {
    askAfterParts(filled, one->GetFieldData());
  }
  return one;
}

} // namespace rockfall::filters
