#pragma once

/// @file
/// The polylines of a polydata, in groups of one value of a cell array.

#include "base/types.h"

#include <string>
#include <vector>

class vtkPolyData;

namespace rockfall::filters
{

struct PathGroup
{
  std::string name;
  std::vector<std::vector<Vec3>> paths;
  std::vector<std::size_t> rockOf; ///< Of each path that which its rock began with.
};

/// In the order of the array's values; with `limits`, which ascend, in classes of them: below the
/// first, from the first up to the second, and so on; only those that have a path. Pieces (cell array
/// Piece) are in the group of their rock, behind which they stand. The numbers of
/// an array "Shape" are named as the shapes are. An empty `arrayName` makes one group, "all".
/// Throws DataError if there are no lines, no such array or, for classes, none of numbers,
/// ParameterError if the limits do not ascend.
std::vector<PathGroup> groupPaths(
  vtkPolyData* input, const std::string& arrayName, const std::vector<double>& limits = {});

} // namespace rockfall::filters
