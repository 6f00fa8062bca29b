#pragma once

/// @file
/// Arrays with a value of each row of a table, of each point or of each cell.

#include "base/types.h"
#include "shared/arrays.h"

#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkStringArray.h"

#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace rockfall::filters
{

template <typename Row>
class Columns
{
public:
  explicit Columns(vtkFieldData* data)
    : data_(data)
  {
  }

  /// Adds an array of `value(row)`: a number, several of them (Vec3, std::array) or a text.
  template <typename Value>
  void add(const std::string& name, Value value)
  {
    using Of = std::decay_t<std::invoke_result_t<Value, const Row&>>;
    if constexpr (std::is_arithmetic_v<Of> || std::is_convertible_v<Of, std::string>)
    {
      using Whole = std::conditional_t<std::is_same_v<Of, int>, vtkIntArray, vtkIdTypeArray>;
      using Number = std::conditional_t<std::is_same_v<Of, double>, vtkDoubleArray, Whole>;
      using Array = std::conditional_t<std::is_arithmetic_v<Of>, Number, vtkStringArray>;
      columns_.push_back([array = addArray<Array>(data_, name.c_str()), value](const Row& row)
        { array->InsertNextValue(value(row)); });
    }
    else
    {
      const int components = int(sizeof(Of) / sizeof(double));
      columns_.push_back(
        [array = addArray<vtkDoubleArray>(data_, name.c_str(), components), value](const Row& row)
        {
          const Of numbers = value(row);
          array->InsertNextTuple(numbers.data());
        });
    }
  }

  void append(const Row& row) const
  {
    for (const auto& column : columns_)
    {
      column(row);
    }
  }

private:
  vtkFieldData* data_;
  std::vector<std::function<void(const Row&)>> columns_;
};

} // namespace rockfall::filters
