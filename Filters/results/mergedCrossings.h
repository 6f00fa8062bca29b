#pragma once

/// @file
/// The crossings of several collectors as those of one.

#include "results/collectorOutputs.h"
#include "results/rockWeights.h"
#include "statistics/crossings.h"

#include <span>
#include <vector>

class vtkPolyData;

namespace rockfall::filters
{

struct MergedCrossings
{
  std::vector<CollectorLine> lines; ///< Name, barrier and offset only.
  ReleasedRocks released;
  RockReleases releases;           ///< Of these, with their frequencies.
  std::vector<Crossing> crossings; ///< As summarizeLine needs them.
  std::vector<std::string> notes;  ///< On inputs of other runs, and on runs that are there twice.
};

/// Fills `output` with the points of all `inputs`, crossings of Trajectory Collector, in the order
/// of iteration, rock, line and passing. Throws DataError if one is no crossings, has other lines,
/// barriers, CRS or arrays than the first, alone has frequencies or has none, or if a crossing is
/// there twice.
MergedCrossings mergeCrossings(std::span<vtkPolyData* const> inputs, vtkPolyData* output);

} // namespace rockfall::filters
