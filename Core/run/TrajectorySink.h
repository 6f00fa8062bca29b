#pragma once

/// @file
/// The receivers of finished trajectories.

#include "rock/retention.h"

#include <utility>
#include <vector>

namespace rockfall
{

/// Receives finished trajectories.
class TrajectorySink
{
public:
  virtual ~TrajectorySink() = default;
  /// What is asked for of an iteration. Called by the threads that simulate, several at a time.
  virtual Kept kept(int) const { return {}; }
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
