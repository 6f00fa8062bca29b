#pragma once

/// @file
/// A finished run as VTK data: rocks at a time, trajectories, impacts, and a table of summaries.

#include "rockFieldData.h"
#include "simulation/results.h"

#include <span>
#include <vector>

class vtkPolyData;
class vtkTable;

namespace rockfall::filters
{

/// What was released and what came of it; positions are local, `origin` leads to the world's.
struct FinishedRun
{
  std::vector<ReleasedRock> rocks;
  std::span<const Trajectory> trajectories; ///< In the order (iteration, rock).
  Vec3 origin = Vec3::Zero();
  double gravity = 0.0; ///< m/s²
};

/// The blocks of one iteration as they stand at `time` (s).
void writeRocksAt(const FinishedRun& run, int iteration, double time, vtkPolyData* output);

/// One polyline of centroids per rock and iteration. Potential energy is m g z, z the elevation of
/// the centroid.
void writeTrajectories(const FinishedRun& run, vtkPolyData* output);

/// One vertex per impact.
void writeImpacts(const FinishedRun& run, vtkPolyData* output);

/// One row per rock and iteration.
void writeSummaries(const FinishedRun& run, vtkTable* output);

} // namespace rockfall::filters
