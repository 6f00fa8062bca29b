#pragma once

/// @file
/// Lines beside a line: where along a slope a barrier has the least to hold.

#include "statistics/crossings.h"

#include <vector>

namespace rockfall
{

/// Puts `count` parallels behind each of the lines, `spacing` (m) apart: to its left if that is
/// positive, else to its right. They have its barrier, and its name with the distance. Throws
/// ParameterError that names ParallelLines or ParallelSpacing if there are too many or they cannot
/// be drawn: a line that turns back, or a piece shorter than the shift of its bends.
void addParallels(std::vector<CollectorLine>& lines, int count, double spacing);

} // namespace rockfall
