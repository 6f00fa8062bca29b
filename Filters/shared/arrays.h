#pragma once

/// @file
/// Arrays of results: made and attached in one line, handed on with their ranges.

#include "vtkAOSDataArrayTemplate.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationInformationVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace rockfall::filters
{

/// A new, empty array of this name, already part of `data`.
template <typename Array>
vtkSmartPointer<Array> addArray(vtkFieldData* data, const char* name, int components = 1)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  data->AddArray(array);
  return array;
}

/// The same of so many tuples of one component that have this value.
template <typename Array, typename Value>
vtkSmartPointer<Array> addFilledArray(
  vtkFieldData* data, const std::string& name, vtkIdType tuples, Value value)
{
  auto array = addArray<Array>(data, name.c_str());
  array->SetNumberOfTuples(tuples);
  array->FillValue(value);
  return array;
}

/// Adds texts to the array of this name, which is made for the first of them.
inline void addTexts(vtkFieldData* data, const char* name, std::span<const std::string> texts)
{
  vtkSmartPointer<vtkStringArray> array =
    vtkStringArray::SafeDownCast(data->GetAbstractArray(name));
  if (!array && !texts.empty())
  {
    array = addArray<vtkStringArray>(data, name);
  }
  for (const std::string& text : texts)
  {
    array->InsertNextValue(text);
  }
}

/// Keeps the ranges of an array of these values with it, as VTK does when it is asked for them.
/// Arrays with a value that is not finite are left to VTK.
template <typename Value>
void rememberRanges(vtkAOSDataArrayTemplate<Value>* array)
{
  const int components = array->GetNumberOfComponents();
  const vtkIdType tuples = array->GetNumberOfTuples();
  if (tuples == 0 || components == 0)
  {
    return;
  }
  const Value* value = array->GetPointer(0);
  std::vector<Value> low(value, value + components), high = low;
  double least = 0.0, most = 0.0; // squares of norms
  for (vtkIdType tuple = 0; tuple < tuples; ++tuple)
  {
    double square = 0.0;
    for (std::size_t k = 0; k < low.size(); ++k, ++value)
    {
      low[k] = std::min(low[k], *value);
      high[k] = std::max(high[k], *value);
      square += double(*value) * double(*value);
    }
    if (!std::isfinite(square))
    {
      return;
    }
    least = tuple == 0 ? square : std::min(least, square);
    most = std::max(most, square);
  }
  vtkNew<vtkInformationVector> all, finite;
  for (vtkInformationVector* of : { all.Get(), finite.Get() })
  {
    of->SetNumberOfInformationObjects(components);
    for (std::size_t k = 0; k < low.size(); ++k)
    {
      const std::array range = { double(low[k]), double(high[k]) };
      of->GetInformationObject(int(k))->Set(vtkDataArray::COMPONENT_RANGE(), range.data(), 2);
    }
  }
  vtkInformation* info = array->GetInformation();
  info->Set(vtkAbstractArray::PER_COMPONENT(), all);
  info->Set(vtkAbstractArray::PER_FINITE_COMPONENT(), finite);
  const std::array norms = { std::sqrt(least), std::sqrt(most) };
  info->Set(vtkDataArray::L2_NORM_RANGE(), norms.data(), 2);
  info->Set(vtkDataArray::L2_NORM_FINITE_RANGE(), norms.data(), 2);
}

template <typename... Value>
void rememberRangesOfAny(vtkAbstractArray* array)
{
  const auto remember = [](auto* typed)
  {
    if (typed)
    {
      rememberRanges(typed);
    }
  };
  (remember(vtkAOSDataArrayTemplate<Value>::FastDownCast(array)), ...);
}

/// The same of all arrays of a result that is done. ParaView asks for these ranges before it draws
/// anything that is behind a filter, a chart of a few numbers too, and VTK takes a second for some
/// million values.
inline void rememberRanges(vtkFieldData* data)
{
  for (int k = 0; k < data->GetNumberOfArrays(); ++k)
  {
    rememberRangesOfAny<double, int, vtkIdType, unsigned char>(data->GetAbstractArray(k));
  }
}

/// The same of points, their places too, and of cells.
inline void rememberRanges(vtkPointSet* result)
{
  if (result->GetPoints())
  {
    rememberRangesOfAny<double>(result->GetPoints()->GetData());
  }
  rememberRanges(result->GetPointData());
  rememberRanges(result->GetCellData());
}

} // namespace rockfall::filters
