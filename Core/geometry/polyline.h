#pragma once

/// @file
/// Lines in the plane through two points or more.

#include "base/types.h"

#include <span>

namespace rockfall
{

double lengthOf(std::span<const Eigen::Vector2d> line); ///< m

/// From a place to the next of the line's, m.
double distanceTo(std::span<const Eigen::Vector2d> line, const Eigen::Vector2d& place);

} // namespace rockfall
