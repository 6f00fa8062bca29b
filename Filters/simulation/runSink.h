#pragma once

/// @file
/// Where finished trajectories go: into the outputs as they come, so that none is kept twice.

#include "run/TrajectorySink.h"
#include "run/retention.h"
#include "run/stateHash.h"
#include "simulation/runOutputs.h"

#include <vector>

namespace rockfall::filters
{

/// Parts of each trajectory that are kept.
struct KeptParts
{
  Retention retention = Retention::Full;
  int wholeIteration = -1; ///< All samples of this one go on to the sink, −1: of none.

  void trim(Trajectory& trajectory) const;
};

/// Writes trajectories into VTK arrays.
class RunSink : public TrajectorySink
{
public:
  RunSink(const RunFrame& frame, const KeptParts& kept);

  void trim(Trajectory& trajectory) const override { kept_.trim(trajectory); }
  void consume(Trajectory&& trajectory) override;

  /// Trajectories that were consumed so far.
  void copy(vtkPolyData* trajectories, vtkPolyData* impacts, vtkTable* summary,
    vtkPolyData* structures) const;
  /// Nothing is consumed after it.
  void finish(vtkPolyData* trajectories, vtkPolyData* impacts, vtkTable* summary,
    vtkPolyData* structures = nullptr);

  std::string stateHash() const { return hash_.text(); }
  /// Trajectories of `wholeIteration`, with all samples.
  std::vector<Trajectory>& whole() { return whole_; }

private:
  KeptParts kept_;
  TrajectoryLines lines_;
  ImpactPoints impacts_;
  StructurePoints structures_;
  SummaryRows rows_;
  StateHash hash_;
  std::vector<Trajectory> whole_;
};

/// Packs trajectories for the way to another process.
class PackingSink : public TrajectorySink
{
public:
  explicit PackingSink(const KeptParts& kept)
    : kept_(kept)
  {
  }
  void trim(Trajectory& trajectory) const override { kept_.trim(trajectory); }
  void consume(Trajectory&& trajectory) override;
  std::vector<char>& bytes() { return bytes_; }

private:
  KeptParts kept_;
  std::vector<char> bytes_;
};

/// Where each rock is at one time: keeps one sample of each trajectory.
class MomentSink : public TrajectorySink
{
public:
  explicit MomentSink(double time)
    : time_(time)
  {
  }
  void consume(Trajectory&& trajectory) override { this->show(trajectory); }
  void show(const Trajectory& trajectory);
  const std::vector<ShownRock>& rocks() const { return rocks_; }

private:
  double time_;
  std::vector<ShownRock> rocks_;
};

} // namespace rockfall::filters
