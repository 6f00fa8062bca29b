#pragma once

/// @file
/// Content of an input that decides a run, as one number: an input that was made again, or that
/// looks otherwise, is the same if its number is.

#include "statistics/runOrigin.h"

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

class vtkFieldData;
class vtkPolyData;

namespace rockfall::filters
{

/// Of a slope, or of the one that is referred to: its field data but for notes, names of classes, and
/// how many of its nodes are shown.
std::uint64_t terrainContent(vtkFieldData* terrain);

/// Of rocks: faces and cell data, and the CRS. `names`: cell arrays that decide nothing.
std::uint64_t rocksContent(vtkPolyData* rocks, std::initializer_list<std::string_view> names);

/// Field array of trajectories: statementOf the parameters of their run.
inline constexpr char kRunProperties[] = "RunProperties";

/// Field array of trajectories: rocks times iterations of their run.
inline constexpr char kRocksReleased[] = "RocksReleased";

/// Field array of trajectories: notes on books of their run that do not close, and of several runs on
/// what differs between these.
inline constexpr char kRunDoubts[] = "RunDoubts";

/// The texts of that array.
std::vector<std::string> doubtsOfRun(vtkFieldData* fields);

/// What trajectories fell on, and by which properties, as far as they tell.
RunOrigin runOf(vtkPolyData* trajectories);

/// A note if the trajectories fell on another slope than that of `mesh`; empty if not, or if either
/// is not known or null.
std::string otherSlope(vtkPolyData* trajectories, vtkPolyData* mesh);

} // namespace rockfall::filters
