#pragma once

/// @file
/// A run in threads of its own, so that a window can look at it and stop it.

#include "simulation/keptRun.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

namespace rockfall::filters
{

class LiveRun
{
public:
  /// Begins to simulate a prepared run.
  explicit LiveRun(std::unique_ptr<KeptRun> run);
  /// Stops and waits for the trajectories under way.
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  const KeptRun& run() const { return *run_; }
  KeptRun& run() { return *run_; }
  void stop() { stop_ = true; } ///< Soon.
  bool stopped() const { return stop_; }
  /// Whether nothing is simulated any more.
  bool over() const { return over_; }
  /// Waits until it is over, s at most.
  void wait(double seconds) const;
  double share() const { return share_; } ///< Done, 0 … 1.
  double elapsed() const;                 ///< s
  /// Trajectories that are made, and those that the next look shows: no more of them come when there
  /// are very many.
  std::int64_t trajectories() const;
  std::int64_t shown() const;

  /// Writes the trajectories made so far, and the blocks as they are released, into the run's
  /// outputs: the first ones, when there are very many.
  void look();
  /// The run with all that was made. To be called once, when it is over. Throws Error if it failed.
  std::unique_ptr<KeptRun> take();

private:
  class Sink;

  std::unique_ptr<KeptRun> run_;
  std::unique_ptr<Sink> sink_;
  std::atomic<bool> stop_{ false }, over_{ false };
  std::atomic<double> share_{ 0.0 };
  std::string failure_; ///< To be read when it is over.
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  std::thread thread_; ///< The last one: it has all the others.
};

} // namespace rockfall::filters
