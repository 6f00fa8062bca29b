#pragma once

/// @file
/// Arrays of results, made and attached in one line.

#include "vtkFieldData.h"
#include "vtkSmartPointer.h"

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

} // namespace rockfall::filters
