#pragma once

/// @file
/// A run as VTK data, written as its trajectories come: rocks at a time, trajectories, impacts, and
/// a table of summaries. Positions are local, `RunFrame::origin` leads to the world's.

#include "rock/results.h"
#include "shared/rockFieldData.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

class vtkPolyData;
class vtkTable;

namespace rockfall
{
class Terrain;
struct SimulationParameters;
} // namespace rockfall

namespace rockfall::filters
{

/// Rocks that were released, and where.
struct RunFrame
{
  std::vector<Rock> rocks;
  std::vector<Shape> shapes;            ///< Of the rocks.
  std::vector<std::int64_t> sourceIds;  ///< Of the rocks.
  std::vector<std::string> sourceNames; ///< Of the rocks.
  std::vector<double> frequencies;      ///< Of the rocks, 1/a; empty: not known.
  Vec3 origin = Vec3::Zero();
  double gravity = 0.0;                             ///< m/s²
  bool breaking = false;                            ///< Rocks may break into pieces.
  const Terrain* slope = nullptr;                   ///< Where rocks may break; so are the
  const SimulationParameters* parameters = nullptr; ///< numbers of the run.
};

/// One polyline of centroids per rock and iteration, or a vertex where only the last sample is
/// kept. Potential energy is m g z, z the elevation of the centroid. Trajectories without samples
/// leave nothing.
class TrajectoryLines
{
public:
  /// `withLosses`: every point with the energy audit.
  TrajectoryLines(const RunFrame& frame, bool withLosses);
  ~TrajectoryLines();
  void append(const Trajectory& trajectory);
  void copy(vtkPolyData* output) const; ///< All that was appended so far.
  void finish(vtkPolyData* output);     ///< Nothing can be appended after it.

private:
  struct Arrays;
  const RunFrame& frame_;
  std::unique_ptr<Arrays> arrays_;
};

/// One vertex per event.
template <typename Event>
class EventPoints
{
public:
  explicit EventPoints(const RunFrame& frame);
  ~EventPoints();
  void append(const TrajectorySummary& summary, const std::vector<Event>& events);
  void copy(vtkPolyData* output) const;
  void finish(vtkPolyData* output);

private:
  struct Arrays;
  const RunFrame& frame_;
  std::unique_ptr<Arrays> arrays_;
};
using ImpactPoints = EventPoints<ImpactEvent>;
/// Meetings with barriers and with trees that broke.
using StructurePoints = EventPoints<StructureEvent>;

/// One row per rock and iteration.
class SummaryRows
{
public:
  explicit SummaryRows(const RunFrame& frame);
  ~SummaryRows();
  void append(const TrajectorySummary& summary);
  void copy(vtkTable* output) const;
  void finish(vtkTable* output);

private:
  struct Arrays;
  std::unique_ptr<Arrays> arrays_;
};

/// Puts the names that the sources of `frame` have now into a table of summaries.
void renameSources(const RunFrame& frame, vtkTable* summary);

/// A rock at a time.
struct ShownRock
{
  int rock = 0;
  int iteration = 0;
  double volume = 0.0; ///< m³
  Sample sample;
  int state = 0; ///< MotionState
  int piece = 0;
  Polyhedron shape; ///< Of a piece.
};

/// The blocks as they stand.
void writeRocks(const RunFrame& frame, std::span<const ShownRock> rocks, vtkPolyData* output);

} // namespace rockfall::filters
