#pragma once

/// @file
/// Points that a user draws or types, as they come from a property.

#include "base/errors.h"

#include <array>
#include <string>
#include <vector>

namespace rockfall::filters
{

/// The points of a list of coordinates: ParaView would hand on whole threes only, without a word of
/// what is left over. Throws ParameterError where it is.
inline std::vector<std::array<double, 3>> drawnPoints(const std::vector<double>& coordinates)
{
  if (coordinates.size() % 3 != 0)
  {
    throw ParameterError("Points has " + std::to_string(coordinates.size()) +
      " numbers, each point needs three: x, y, z");
  }
  std::vector<std::array<double, 3>> points;
  for (std::size_t k = 0; k < coordinates.size(); k += 3)
  {
    points.push_back({ coordinates[k], coordinates[k + 1], coordinates[k + 2] });
  }
  return points;
}

} // namespace rockfall::filters
