#pragma once

/// @file
/// The receivers of finished trajectories.

#include "rock/results.h"

#include <utility>
#include <vector>

namespace rockfall
{

/// Receives finished trajectories.
class TrajectorySink
{
public:
  virtual ~TrajectorySink() = default;
  /// Drops what is not kept, as soon as the trajectory is finished and before it waits for its
  /// turn. Called by the thread that simulated it, so by several at a time.
  virtual void trim(Trajectory&) const {}
  /// Called once per rock and iteration and piece of a rock that broke, in the order (iteration,
  /// rock, piece), by one thread at a time.
  virtual void consume(Trajectory&& trajectory) = 0;
};

/// Keeps everything, in the order (iteration, rock).
class TrajectoryStore : public TrajectorySink
{
public:
  TrajectoryStore() = default;
  TrajectoryStore(int rocks, int iterations)
  {
    trajectories_.reserve(std::size_t(rocks) * iterations);
  }
  void consume(Trajectory&& trajectory) override { trajectories_.push_back(std::move(trajectory)); }
  const std::vector<Trajectory>& trajectories() const { return trajectories_; }
  std::vector<Trajectory> take() { return std::move(trajectories_); }

private:
  std::vector<Trajectory> trajectories_;
};

} // namespace rockfall
