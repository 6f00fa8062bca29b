#include "simulation/ensemble.h"

#include "base/errors.h"
#include "geometry/shell.h"
#include "simulation/RockSimulator.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <memory>
#include <mutex>
#include <thread>

namespace rockfall
{

namespace
{

/// Shallower overlaps at the start are rounding: a rock laid on the slope by computed coordinates.
constexpr double kLaidDown = 1e-6; // of the radius

std::string where(const Vec3& world)
{
  return "(" + std::to_string(world.x()) + ", " + std::to_string(world.y()) + ", " +
    std::to_string(world.z()) + ")";
}

void checkPlacement(const Terrain& terrain, const Rock& rock, const Block& block)
{
  const std::string name = "block " + std::to_string(rock.blockId) + " at " +
    where(rock.position + terrain.geometry().origin());
  if (terrain.cfeAt(rock.position.x(), rock.position.y()) == 0)
  {
    const GridGeometry& g = terrain.geometry();
    throw PlacementError(name +
      " is outside the slope: there is no CFE under it (the slope spans x " +
      std::to_string(g.xOrigin) + " to " + std::to_string(g.xOrigin + terrain.width()) + ", y " +
      std::to_string(g.yOrigin) + " to " + std::to_string(g.yOrigin + terrain.height()) + ")");
  }
  if (rock.uncertainty.horizontalDeviation > std::hypot(terrain.width(), terrain.height()))
  {
    throw ParameterError(name + ": HorizontalDeviation is " +
      numberText(rock.uncertainty.horizontalDeviation) + " m, more than the slope is wide");
  }
  BlockState state;
  state.position = rock.position;
  state.orientation = rock.orientation.normalized();
  PlacedBlock placed;
  placed.place(block, state);
  SurfacePatch patch;
  // The check is on the slope as surveyed: roughness belongs to an iteration.
  gatherPatch(Surface::asSurveyed(terrain), placed.lower().x(), placed.upper().x(),
    placed.lower().y(), placed.upper().y(), patch);
  const double depth = penetration(placed, patch);
  if (depth > kLaidDown * block.radius())
  {
    throw PlacementError(
      name + " starts inside the slope, by " + std::to_string(depth) + " m; raise its centre");
  }
}

} // namespace

void SimulationParameters::validate() const
{
  const auto positive = [](double value, const char* field, const char* unit)
  {
    if (!(value > 0.0) || !std::isfinite(value))
    {
      throw ParameterError(std::string(field) + " is " + std::to_string(value) +
        ", it must be a positive, finite number of " + unit);
    }
  };
  const auto atLeast = [](auto value, auto least, const char* field)
  {
    if (!(value >= least))
    {
      throw ParameterError(std::string(field) + " is " + std::to_string(value) +
        ", it must be at least " + std::to_string(least));
    }
  };
  positive(this->timeStep, "TimeStep", "seconds");
  positive(this->endTime, "EndTime", "seconds");
  positive(this->outputInterval, "OutputInterval", "seconds");
  positive(this->normalPenalty, "NormalPenalty", "N/m");
  positive(this->shearRatio, "ShearPenaltyRatio", "(no unit)");
  if (!(this->gravity >= 0.0) || !std::isfinite(this->gravity))
  {
    throw ParameterError(
      "Gravity is " + std::to_string(this->gravity) + " m/s², it must be finite and not negative");
  }
  if (this->endTime / this->outputInterval > 1e7)
  {
    throw ParameterError("OutputInterval is " + std::to_string(this->outputInterval) +
      " s, which makes more than 10,000,000 samples in EndTime " + std::to_string(this->endTime) +
      " s");
  }
  atLeast(this->iterations, 1, "Iterations");
  atLeast(this->threads, 0, "NumberOfThreads");
  atLeast(this->maxOpenClose, 2, "MaximumOpenClose");
  atLeast(this->maxCuts, 0, "MaximumCuts");
}

void Rock::validate() const
{
  const std::string name = "block " + std::to_string(this->blockId) + ": ";
  const auto positive = [&](double value, const char* field, const char* unit)
  {
    if (!(value > 0.0) || !std::isfinite(value))
    {
      throw ParameterError(name + field + " is " + std::to_string(value) +
        ", it must be a positive, finite number of " + unit);
    }
  };
  positive(this->density, "Density", "kg/m³");
  positive(this->youngModulus, "YoungModulus", "Pa");
  if (!(this->poissonRatio >= 0.0 && this->poissonRatio <= 0.49))
  {
    throw ParameterError(
      name + "PoissonRatio is " + std::to_string(this->poissonRatio) + ", it must be 0 to 0.49");
  }
  positive(this->shape.integrals().volume, "Volume", "m³");
  const auto finite = [&](const Vec3& value, const char* field)
  {
    if (!value.allFinite())
    {
      throw ParameterError(name + field + " is " + where(value) + ", it must be finite");
    }
  };
  finite(this->position, "Center");
  finite(this->velocity, "Velocity");
  finite(this->angularVelocity, "AngularVelocity");
  if (!this->orientation.coeffs().allFinite() || this->orientation.norm() < 1e-6)
  {
    throw ParameterError(name + "Orientation is not a rotation");
  }
  try
  {
    this->uncertainty.validate();
  }
  catch (const ParameterError& error)
  {
    throw ParameterError(name + error.what());
  }
}

TrajectoryStore::TrajectoryStore(int rocks, int iterations)
  : rocks_(rocks)
  , trajectories_(std::size_t(rocks) * iterations)
{
}

void TrajectoryStore::consume(Trajectory&& trajectory)
{
  const TrajectorySummary& s = trajectory.summary;
  trajectories_[std::size_t(s.iteration) * rocks_ + s.rock] = std::move(trajectory);
}

bool runEnsemble(const Terrain& terrain, std::span<const Rock> rocks,
  const SimulationParameters& parameters, TrajectorySink& sink, const Progress& progress)
{
  parameters.validate();
  if (rocks.empty())
  {
    throw ParameterError("there are no rock blocks to simulate");
  }
  std::vector<Block> blocks;
  blocks.reserve(rocks.size());
  for (const Rock& rock : rocks)
  {
    rock.validate();
    blocks.emplace_back(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio);
    checkPlacement(terrain, rock, blocks.back());
  }

  const std::int64_t total = std::int64_t(rocks.size()) * parameters.iterations;
  std::atomic<std::int64_t> finished{ 0 };
  std::atomic<bool> stop{ false };
  std::mutex sinkMutex;
  std::exception_ptr failure;
  const auto release = [&](const Surface& surface, int rock, int iteration)
  {
    if (!rocks[rock].uncertainty.any())
    {
      return RockSimulator(surface, rocks[rock], blocks[rock], parameters).run();
    }
    const Rock drawn =
      realise(terrain, rocks[rock], parameters.seed, iteration, std::uint64_t(rock));
    const Block block(drawn.shape, drawn.density, drawn.youngModulus, drawn.poissonRatio);
    return RockSimulator(surface, drawn, block, parameters).run();
  };
  const auto simulate = [&](std::int64_t index)
  {
    if (stop)
    {
      return;
    }
    const int iteration = int(index / std::int64_t(rocks.size()));
    const int rock = int(index % std::int64_t(rocks.size()));
    try
    {
      const Surface surface(terrain, parameters.seed, iteration);
      Trajectory trajectory = release(surface, rock, iteration);
      trajectory.summary.rock = rock;
      trajectory.summary.iteration = iteration;
      const std::lock_guard<std::mutex> lock(sinkMutex);
      sink.consume(std::move(trajectory));
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(sinkMutex);
      failure = failure ? failure : std::current_exception();
      stop = true;
    }
    ++finished;
  };

  // The caller's thread only reports: a GUI must not be called from any other one.
  std::atomic<bool> done{ false };
  std::mutex wakeMutex;
  std::condition_variable wake;
  std::thread worker(
    [&]
    {
      tbb::task_arena arena(
        parameters.threads > 0 ? parameters.threads : tbb::task_arena::automatic, 1);
      arena.execute(
        [&] { tbb::parallel_for(std::int64_t(0), total, simulate, tbb::simple_partitioner()); });
      const std::lock_guard<std::mutex> lock(wakeMutex);
      done = true;
      wake.notify_all();
    });
  bool aborted = false;
  {
    std::unique_lock<std::mutex> lock(wakeMutex);
    while (!done)
    {
      wake.wait_for(lock, std::chrono::milliseconds(50));
      if (progress && !done && !aborted)
      {
        lock.unlock();
        if (!progress(double(finished) / double(total)))
        {
          aborted = true;
          stop = true;
        }
        lock.lock();
      }
    }
  }
  worker.join();
  if (failure)
  {
    std::rethrow_exception(failure);
  }
  return !aborted;
}

} // namespace rockfall
