#pragma once

/// @file
/// The run that a filter's outputs show: one that is over and kept, or one that goes on while a
/// window watches it.

#include "simulation/keptRun.h"
#include "simulation/liveRun.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

class vtkAlgorithm;

namespace rockfall::filters
{

class CurrentRun
{
public:
  /// Tells `filter` of progress, and that it is out of date when a run that was watched is over.
  explicit CurrentRun(vtkAlgorithm* filter)
    : filter_(filter)
  {
  }

  /// Simulates `wanted`, which has its properties, unless the current run is that one: with all
  /// samples of its `wholeIteration` where they fit. Watched by a window it may go on. Collective.
  /// False if aborted. Throws Error on all ranks.
  bool make(std::unique_ptr<KeptRun> wanted, vtkPolyData* terrain, vtkPolyData* rocks,
    const Ranks& ranks, bool printProgress);
  /// Null if there is none.
  KeptRun* get() { return live_ ? &live_->run() : kept_.get(); }
  bool goesOn() const { return live_ != nullptr; }
  bool isOver() const { return kept_ != nullptr; }
  void forget();
  /// Ends one that goes on, soon.
  void stop();

  /// Whether a window should look again. Who asks watches: the next run goes on in its own threads.
  bool hasNews();
  /// The window begins to take the outputs: what this costs it decides when there is news again.
  void beginLook() { asked_ = std::chrono::steady_clock::now(); }
  /// "running: 12,300 of 100,000 trajectories (12 %), about 3 min 20 s left".
  const std::string& status();
  /// Of the run that is kept; empty if none is.
  const char* stateHash() const { return kept_ ? kept_->stateHash.c_str() : ""; }
  int count() const { return count_; } ///< Of runs made.

private:
  /// Looks at the run that goes on, and keeps it when it is over.
  void follow();

  vtkAlgorithm* filter_;
  std::unique_ptr<KeptRun> kept_;
  std::unique_ptr<LiveRun> live_; ///< A run that goes on. Then none is kept.
  std::string status_;
  int count_ = 0;
  bool watched_ = false;    ///< Whether somebody asks for news.
  std::int64_t looked_ = 0; ///< Trajectories at the last look.
  std::chrono::steady_clock::time_point asked_, drawn_;
};

} // namespace rockfall::filters
