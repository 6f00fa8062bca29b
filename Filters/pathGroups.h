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
};

/// In the order of the array's values. The numbers of an array "Shape" are named as the shapes are.
/// An empty `arrayName` makes one group, "all". Throws DataError if there are no lines or no such
/// array.
std::vector<PathGroup> groupPaths(vtkPolyData* input, const std::string& arrayName);

} // namespace rockfall::filters
