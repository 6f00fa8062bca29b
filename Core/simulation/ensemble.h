#pragma once

/// @file
/// Many rocks, many iterations, all threads: the one call that a filter makes.

#include "geometry/Polyhedron.h"
#include "simulation/parameters.h"
#include "simulation/release.h"
#include "simulation/results.h"
#include "terrain/Terrain.h"

#include <functional>
#include <limits>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace rockfall
{

/// A rock as it is released.
struct Rock
{
  std::int64_t blockId = 0;
  Polyhedron shape;             ///< Centroid at the origin, body axes = world axes at release
                                ///< when `orientation` is the identity, m.
  Vec3 position = Vec3::Zero(); ///< Centroid in the terrain's local frame, m.
  Quat orientation = Quat::Identity(); ///< Body to world.
  Vec3 velocity = Vec3::Zero();        ///< m/s
  Vec3 angularVelocity = Vec3::Zero(); ///< World axes, rad/s.
  double density = 2500.0;             ///< kg/m³, > 0.
  double youngModulus = 1e10;          ///< Pa, > 0.
  double poissonRatio = 0.1;           ///< Dimensionless, 0 … 0.49.
  std::string material;                ///< Its name, for contacts of rocks; empty: none.
  ReleaseUncertainty uncertainty;      ///< What is drawn in each iteration.

  /// Throws ParameterError naming block, field and value, also for values beyond any rock's: more
  /// than 1000 m/s or 10,000 rad/s.
  void validate() const;
};

/// Sets a rock onto the slope that starts in it by no more than the rounding of a grid of single
/// precision (1e-5 m at 50 m, 1 mm at 4000 m), or by no more than `most` (m): one that a simulation
/// left in contact presses the springs. Any other is left as it is.
void setOntoSlope(const Terrain& terrain, Rock& rock, double most = 0.0);

/// What pushing rocks apart before they fall has done: the most of any iteration.
struct PushedApart
{
  std::int64_t rocks = 0; ///< How many were moved.
  double farthest = 0.0;  ///< The longest way of one, m.
  int passes = 0;
  std::int64_t iterations = 0; ///< In how many any were moved.

  void add(const PushedApart& others); ///< Of other iterations.
};

/// Receives finished trajectories.
class TrajectorySink
{
public:
  virtual ~TrajectorySink() = default;
  /// Drops what is not kept, as soon as the trajectory is finished and before it waits for its
  /// turn. Called by the thread that simulated it, so by several at a time.
  virtual void trim(Trajectory&) const {}
  /// Called once per rock and iteration, in the order (iteration, rock), by one thread at a time.
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
  std::int64_t trajectoriesPerUnit() const ///< In the order of the rocks.
  {
    return parameters_.rockRockContact ? std::int64_t(rocks_.size()) : 1;
  }
  EnsembleShare whole() const { return { 0, this->size(), 1 }; }
  const SimulationParameters& parameters() const { return parameters_; }
  /// What pushing rocks apart has done in the iterations simulated so far; where nothing of their
  /// release is drawn, what it does in all, known from the start.
  PushedApart pushed() const;
  /// Whether they are pushed anew in each iteration.
  bool pushesAnew() const { return parameters_.pushRocksApart && start_.empty(); }

  /// Simulates one trajectory of a rock that hits no other; `enough` as in RockSimulator::run.
  Trajectory simulate(
    std::int64_t number, double enough = std::numeric_limits<double>::infinity()) const;

  /// Simulates a share on all threads and hands it to `sink` in order. What comes out does not
  /// depend on the number of threads. Returns false if `progress` aborted; the sink then has a
  /// part, to be thrown away. A trajectory waits for its turn only as long as the slowest of those
  /// before it takes.
  bool run(const EnsembleShare& share, TrajectorySink& sink, const Progress& progress = {},
    double enough = std::numeric_limits<double>::infinity()) const;

private:
  /// Of a fall of many rocks, goOn(share of its time that is over) as it goes on.
  std::vector<Trajectory> simulateUnit(
    std::int64_t unit, double enough, const std::function<bool(double)>& goOn) const;

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

/// Simulates every rock in every iteration: `Ensemble::run` of the whole.
bool runEnsemble(const Terrain& terrain, std::span<const Rock> rocks,
  const SimulationParameters& parameters, TrajectorySink& sink, const Progress& progress = {});

} // namespace rockfall
