#pragma once

#include "base/errors.h"
#include "base/text/numberText.h"

#include <string_view>

namespace rockfall
{

/// Throws ParameterError "TimeStep is 0 s, it must be above 0" unless `good`; `unit` with the blank
/// before it.
inline void require(
  bool good, std::string_view field, double value, std::string_view unit, std::string_view wanted)
{
  if (!good)
  {
    throw ParameterError(std::string(field) + " is " + numberText(value) + std::string(unit) +
      ", it must be " + std::string(wanted));
  }
}

} // namespace rockfall
