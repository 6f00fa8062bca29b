#pragma once

/// @file
/// Many rocks, many iterations, all threads: the one call that a filter makes.

#include "geometry/Polyhedron.h"
#include "simulation/parameters.h"
#include "simulation/release.h"
#include "simulation/results.h"
#include "terrain/Terrain.h"

#include <functional>
#include <span>

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
  ReleaseUncertainty uncertainty;      ///< What is drawn in each iteration.

  void validate() const; ///< Throws ParameterError naming block, field and value.
};

/// Receives finished trajectories. `consume` is called once per rock and iteration, from one thread
/// at a time but in any order.
class TrajectorySink
{
public:
  virtual ~TrajectorySink() = default;
  virtual void consume(Trajectory&& trajectory) = 0;
};

/// Keeps everything, in the order (iteration, rock).
class TrajectoryStore : public TrajectorySink
{
public:
  TrajectoryStore(int rocks, int iterations);
  void consume(Trajectory&& trajectory) override;
  const std::vector<Trajectory>& trajectories() const { return trajectories_; }

private:
  int rocks_;
  std::vector<Trajectory> trajectories_;
};

/// Called now and then from the calling thread with the share done, 0 … 1; returning false aborts.
using Progress = std::function<bool(double)>;

/// Simulates every rock in every iteration. Results do not depend on the number of threads.
/// Throws ParameterError, GeometryError or PlacementError before anything is simulated.
/// Returns false if `progress` aborted the run; the sink then holds a part, to be thrown away.
bool runEnsemble(const Terrain& terrain, std::span<const Rock> rocks,
  const SimulationParameters& parameters, TrajectorySink& sink, const Progress& progress = {});

} // namespace rockfall
