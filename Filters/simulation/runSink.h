#pragma once

/// @file
/// Where finished trajectories go: into the outputs as they come, so that none is kept twice.

#include "rock/retention.h"
#include "run/TrajectorySink.h"
#include "run/brokenFall.h"
#include "run/stateHash.h"
#include "simulation/runOutputs.h"

#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <span>
#include <vector>

namespace rockfall::filters
{

/// Outputs of a run that do not depend on time.
struct RunData
{
  vtkNew<vtkPolyData> trajectories, impacts, structures;
  vtkNew<vtkTable> summary;
};

/// Parts of each trajectory that are kept.
struct KeptParts
{
  Retention retention = Retention::Full;
  bool impacts = true;
  int wholeIteration = -1; ///< All samples of this one go on to the sink, −1: of none.

  Kept of(int iteration) const;
};

/// What became of the rocks that broke, over all iterations.
struct BrokenRocks
{
  std::int64_t released = 0, broken = 0, pieces = 0; ///< Rocks; those that broke; all pieces.
  double mass = 0.0, fines = 0.0; ///< Of the rocks that broke, and of it what is not followed, kg.

  void add(const TrajectorySummary& summary);
};

/// Rocks of which something holds, for themselves or for one of their pieces, over all iterations.
struct CountedRocks
{
  std::int64_t rocks = 0;
  bool last = false; ///< The rock that was added last is one of them.

  /// A rock (`whole`), or a piece of the last one.
  void add(bool whole, bool holds);
};

/// Rocks whose energy came from nowhere or went there, over all iterations.
struct UnclosedBooks
{
  static constexpr double kTold = 0.05; ///< Share of what one had: 2.5 % of its speed.
  std::int64_t rocks = 0;               ///< All of them.
  CountedRocks gained, lost;            ///< Those that gained or lost more.

  /// Summary of a rock, or of a piece of the last one. `gravity`: m/s².
  void add(const TrajectorySummary& summary, double gravity);
};

/// Rocks that a barrier which stands let go on, over it or with a part against it, over all iterations.
struct PassedBarriers
{
  std::int64_t rocks = 0; ///< All of them.
  CountedRocks passed, struck;

  void add(const TrajectorySummary& summary, std::span<const StructureEvent> events);
};

/// Writes trajectories into VTK arrays.
class RunSink : public TrajectorySink
{
public:
  RunSink(const RunFrame& frame, const KeptParts& kept);

  Kept kept(int iteration) const override { return kept_.of(iteration); }
  void consume(Trajectory&& trajectory) override;

  /// Trajectories that were consumed so far.
  void copy(RunData& output) const;
  /// Nothing is consumed after it.
  void finish(RunData& output);

  std::string stateHash() const { return hash_.text(); }
  /// Trajectories of `wholeIteration`, with all samples.
  std::vector<Trajectory>& whole() { return whole_; }
  const BrokenRocks& broken() const { return broken_; }
  const UnclosedBooks& unclosed() const { return unclosed_; }
  const PassedBarriers& passedBarriers() const { return passedBarriers_; }

private:
  KeptParts kept_;
  TrajectoryLines lines_;
  ImpactPoints impacts_;
  StructurePoints structures_;
  SummaryRows rows_;
  StateHash hash_;
  std::vector<Trajectory> whole_;
  BrokenRocks broken_;
  UnclosedBooks unclosed_;
  PassedBarriers passedBarriers_;
  double gravity_; ///< m/s²
};

/// Packs trajectories for the way to another process.
class PackingSink : public TrajectorySink
{
public:
  explicit PackingSink(const KeptParts& kept)
    : kept_(kept)
  {
  }
  Kept kept(int iteration) const override { return kept_.of(iteration); }
  void consume(Trajectory&& trajectory) override;
  std::vector<char>& bytes() { return bytes_; }

private:
  KeptParts kept_;
  std::vector<char> bytes_;
};

/// Where each rock is at one time: keeps one sample of each trajectory. Of rocks that break it
/// shows what is there at the time, the rock or its pieces.
class MomentSink : public TrajectorySink
{
public:
  MomentSink(double time, const Terrain& slope, const SimulationParameters& parameters,
    std::span<const Rock> rocks)
    : time_(time)
    , released_(rocks)
    , shapes_(slope, parameters)
  {
  }
  Kept kept(int) const override { return { Retention::Full, false }; }
  void consume(Trajectory&& trajectory) override { this->show(trajectory); }
  void show(const Trajectory& trajectory);
  const std::vector<ShownRock>& rocks() const { return rocks_; }

private:
  double time_;
  std::span<const Rock> released_;
  PieceShapes shapes_;
  std::vector<ShownRock> rocks_;
};

} // namespace rockfall::filters
