#pragma once

/// @file
/// Many rocks, many iterations, all threads: the call that a filter makes.

#include "rock/Rock.h"
#include "rock/parameters.h"
#include "run/TrajectorySink.h"
#include "run/overlaps.h"
#include "terrain/Terrain.h"

#include <functional>
#include <limits>
#include <mutex>
#include <span>
#include <vector>

namespace rockfall
{

/// Called now and then, and at the end, from the calling thread with the share done, 0 … 1;
/// returning false aborts.
using Progress = std::function<bool(double)>;

/// A part of an ensemble: the units begin, begin + stride, … below end.
struct EnsembleShare
{
  std::int64_t begin = 0, end = 0, stride = 1;
  std::int64_t count() const { return end > begin ? (end - begin + stride - 1) / stride : 0; }
};

/// Every rock in every iteration, checked and ready to be simulated, in whole or in parts. Its
/// units are what is simulated at once: number n is rock n mod rocks in iteration firstIteration +
/// n / rocks, or, if rocks hit each other, all of iteration firstIteration + n.
class Ensemble
{
public:
  /// Keeps references to the terrain and the rocks. Throws ParameterError, GeometryError or
  /// PlacementError, of the first rock that has one.
  Ensemble(const Terrain& terrain, std::span<const Rock> rocks, const SimulationParameters& p);

  std::int64_t size() const ///< Units.
  {
    return parameters_.iterations * this->unitsPerIteration();
  }
  std::int64_t unitsPerIteration() const
  {
    return parameters_.rockRockContact ? 1 : std::int64_t(rocks_.size());
  }
  int iterationOf(std::int64_t unit) const
  {
    return parameters_.firstIteration + int(unit / this->unitsPerIteration());
  }
  /// In the order of the rocks; those of the pieces of rocks that broke come beside them.
  std::int64_t trajectoriesPerUnit() const
  {
    return parameters_.rockRockContact ? std::int64_t(rocks_.size()) : 1;
  }
  EnsembleShare whole() const { return { 0, this->size(), 1 }; }
  const SimulationParameters& parameters() const { return parameters_; }
  /// Result of pushing rocks apart in the iterations simulated so far; where nothing of their
  /// release is drawn, what it does in all, known from the start.
  PushedApart pushed() const;
  /// Whether rocks are pushed anew in each iteration.
  bool pushesAnew() const { return parameters_.pushRocksApart && start_.empty(); }

  /// The trajectories of a unit, in the order of its rocks, each with its pieces behind it, and of
  /// them what is `kept`; `goOn` and `enough` as in World::run.
  std::vector<Trajectory> simulate(std::int64_t unit, const std::function<bool(double)>& goOn = {},
    double enough = std::numeric_limits<double>::infinity(), const Kept& kept = {}) const;

  /// Simulates a share on all threads and hands it to `sink` in order. What comes out does not
  /// depend on the number of threads. Returns false if `progress` aborted; the sink then has a
  /// part, to be thrown away. A trajectory waits for its turn only as long as the slowest of those
  /// before it takes.
  bool run(const EnsembleShare& share, TrajectorySink& sink, const Progress& progress = {},
    double enough = std::numeric_limits<double>::infinity()) const;

private:
  std::vector<Rock> rocksOf(std::int64_t unit, int iteration) const; ///< As they are released.
  /// The rocks of an iteration that fall together, as they are released. Throws PlacementError if
  /// they overlap and are not to be pushed apart.
  std::vector<Rock> released(int iteration, PushedApart& pushed) const;

  const Terrain& terrain_;
  std::span<const Rock> rocks_;
  SimulationParameters parameters_;
  std::vector<Rock> start_; ///< Rocks that fall together, if they are the same in all iterations.
  mutable std::mutex pushing_;
  mutable PushedApart pushed_; ///< Most and sums: the order does not count.
};

} // namespace rockfall
