#pragma once

/// @file
/// Numbers of proxies' properties, whole or not. Internal to the looks.

#include "vtkSMIntVectorProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <array>

namespace rockfall::window
{

using Colour = std::array<double, 3>; ///< Red, green, blue.

/// Sets a property, unless this version or kind of proxy has none of the name.
template <typename... Values>
void set(vtkSMProxy* proxy, const char* property, Values... values)
{
  if (!proxy->GetProperty(property))
  {
    return;
  }
  vtkSMPropertyHelper helper(proxy, property);
  if (vtkSMIntVectorProperty::SafeDownCast(proxy->GetProperty(property)))
  {
    const std::array<int, sizeof...(values)> numbers = { int(values)... };
    helper.Set(numbers.data(), unsigned(numbers.size()));
    return;
  }
  const std::array<double, sizeof...(values)> numbers = { double(values)... };
  helper.Set(numbers.data(), unsigned(numbers.size()));
}

} // namespace rockfall::window
