#include "simulation/ensemble.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/numberText.h"
#include "geometry/shell.h"
#include "simulation/MassFall.h"
#include "simulation/RockSimulator.h"
#include "simulation/overlaps.h"
#include "simulation/placement.h"
#include "simulation/releasePlaces.h"
#include "simulation/stateHash.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace rockfall
{

namespace
{

/// Over the slope, m. Rocks start on the slope or a fall over it; 1000 m read as feet are 2000 m
/// too high.
constexpr double kHighest = 500.0;
/// Deeper than this share of their radius under their own weight rocks do not always come to rest,
/// and energy gets lost.
constexpr double kDeepestAtRest = 0.02;

/// What no rock has, and what would not end or not fit into numbers.
///@{
constexpr double kMostSpeed = 1000.0; ///< m/s; also of the outermost point as it turns.
constexpr double kMostSpin = 1e4;     ///< rad/s
constexpr double kMostDensity = 1e5;  ///< kg/m³; the densest metal has 2.3e4.
constexpr double kMostModulus = 1e15; ///< Pa; diamond has 1.2e12.
constexpr double kMostVolume = 1e9;   ///< m³
///@}

std::string where(const Vec3& world)
{
  std::string text = "(";
  text += numberText(world.x()) + ", " + numberText(world.y()) + ", " + numberText(world.z());
  return text + ")";
}

/// How deep the rock is in the slope as surveyed, m: roughness belongs to an iteration.
double depthOf(const Terrain& terrain, const Rock& rock, const Block& block)
{
  BlockState state;
  state.position = rock.position;
  state.orientation = rock.orientation.normalized();
  PlacedBlock placed;
  placed.place(block, state);
  SurfacePatch patch;
  gatherPatch(Surface::asSurveyed(terrain), placed.lower().x(), placed.upper().x(),
    placed.lower().y(), placed.upper().y(), patch);
  return liftOut(placed, patch);
}

void checkPlacement(const Terrain& terrain, const Rock& rock, const Block& block)
{
  const Vec3 world = rock.position + terrain.geometry().origin();
  const std::string name = "block " + std::to_string(rock.blockId) + " at " + where(world);
  if (terrain.cfeAt(rock.position.x(), rock.position.y()) == 0)
  {
    throw PlacementError(name + whyNoGround(terrain, world.x(), world.y()));
  }
  const double height = rock.position.z() - terrain.elevation(rock.position.x(), rock.position.y());
  if (height > kHighest)
  {
    throw PlacementError(name + " is " + numberText(height, 4) + " m over the slope, more than " +
      std::to_string(int(kHighest)) +
      " m: is its height in feet, or that of another reference than the slope's?");
  }
  if (rock.uncertainty.horizontalDeviation > std::hypot(terrain.width(), terrain.height()))
  {
    throw ParameterError(name + ": HorizontalDeviation is " +
      numberText(rock.uncertainty.horizontalDeviation) + " m, more than the slope is wide");
  }
  const double depth = depthOf(terrain, rock, block);
  // What is in it by rounding alone is set onto it when it is released.
  if (depth > startRounding(world.z(), block.radius()))
  {
    throw PlacementError(
      name + " starts inside the slope, by " + numberText(depth, 4) + " m; raise its centre");
  }
}

void checkPenalty(const Rock& rock, const Block& block, const SimulationParameters& p)
{
  const double weight = block.mass() * p.gravity;
  const double most = kDeepestAtRest * block.radius();
  if (weight > most * p.normalPenalty)
  {
    throw ParameterError("NormalPenalty is " + numberText(p.normalPenalty) +
      " N/m, too soft for block " + std::to_string(rock.blockId) + ": at rest its " +
      numberText(block.mass()) + " kg would lie " + numberText(weight / p.normalPenalty) +
      " m deep in the ground, more than " + numberText(100.0 * kDeepestAtRest) +
      " % of its radius; it needs " + numberText(weight / most) + " N/m or more");
  }
}

} // namespace

void Rock::validate() const
{
  const std::string name = "block " + std::to_string(this->blockId) + ": ";
  const auto positive = [&](double value, double most, const char* field, const char* unit)
  {
    if (!(value > 0.0) || !std::isfinite(value))
    {
      throw ParameterError(name + field + " is " + numberText(value) +
        ", it must be a positive, finite number of " + unit);
    }
    if (value > most)
    {
      throw ParameterError(name + field + " is " + numberText(value) + " " + unit +
        ", no rock has more than " + numberText(most));
    }
  };
  positive(this->density, kMostDensity, "Density", "kg/m³");
  positive(this->youngModulus, kMostModulus, "YoungModulus", "Pa");
  if (!(this->poissonRatio >= 0.0 && this->poissonRatio <= 0.49))
  {
    throw ParameterError(
      name + "PoissonRatio is " + numberText(this->poissonRatio) + ", it must be 0 to 0.49");
  }
  positive(this->shape.integrals().volume, kMostVolume, "Volume", "m³");
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
  const auto atMost = [&](double value, double most, const char* what, const char* unit)
  {
    if (value > most)
    {
      throw ParameterError(name + what + " is " + numberText(value) + " " + unit +
        ", no rock has more than " + numberText(most));
    }
  };
  const double spin = this->angularVelocity.stableNorm();
  atMost(this->velocity.stableNorm(), kMostSpeed, "Velocity", "m/s");
  atMost(spin, kMostSpin, "AngularVelocity", "rad/s");
  atMost(spin * this->shape.radius(), kMostSpeed,
    "AngularVelocity times the radius, the speed of its outermost point,", "m/s");
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

namespace
{

/// Hands trajectories on in the order of their numbers, whatever the order in which they come. No
/// thread waits for another one's delivery: it leaves its trajectory and goes on.
class InOrder
{
public:
  explicit InOrder(TrajectorySink& sink)
    : sink_(sink)
  {
  }

  void put(std::int64_t number, std::vector<Trajectory>&& trajectories)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    waiting_.emplace(number, std::move(trajectories));
    if (delivering_)
    {
      return;
    }
    delivering_ = true;
    for (auto turn = waiting_.find(next_); turn != waiting_.end(); turn = waiting_.find(next_))
    {
      std::vector<Trajectory> delivered = std::move(turn->second);
      waiting_.erase(turn);
      ++next_;
      lock.unlock();
      for (Trajectory& trajectory : delivered)
      {
        sink_.consume(std::move(trajectory)); // if it throws nothing more is delivered
      }
      lock.lock();
    }
    delivering_ = false;
  }

private:
  TrajectorySink& sink_;
  std::mutex mutex_;
  std::map<std::int64_t, std::vector<Trajectory>> waiting_;
  std::int64_t next_ = 0;
  bool delivering_ = false;
};

/// The exception of the lowest number among those that several threads met.
class FirstFailure
{
public:
  void note(std::int64_t number)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!failure_ || number < number_)
    {
      number_ = number;
      failure_ = std::current_exception();
    }
  }
  void rethrow() const
  {
    if (failure_)
    {
      std::rethrow_exception(failure_);
    }
  }

private:
  std::mutex mutex_;
  std::int64_t number_ = 0;
  std::exception_ptr failure_;
};

/// Calls `work` on as many threads as asked for (0: all), once each; returns when all came back.
template <typename Work>
void onThreads(int threads, const Work& work)
{
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic, 1);
  arena.execute(
    [&]
    {
      tbb::parallel_for(
        0, tbb::this_task_arena::max_concurrency(), [&](int) { work(); },
        tbb::simple_partitioner());
    });
}

Block blockOf(const Rock& rock)
{
  return Block(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio);
}

} // namespace

void setOntoSlope(const Terrain& terrain, Rock& rock, double most)
{
  if (terrain.cfeAt(rock.position.x(), rock.position.y()) == 0)
  {
    return; // the ensemble says so
  }
  // A grid of single precision is rounded; twice that much is a hair.
  const double hair = 4.0 * std::ldexp(std::max(50.0, std::abs(rock.position.z())), -24);
  const double depth = depthOf(terrain, rock, blockOf(rock));
  if (depth <= std::max(most, hair))
  {
    rock.position.z() += depth;
  }
}

Ensemble::Ensemble(
  const Terrain& terrain, std::span<const Rock> rocks, const SimulationParameters& p)
  : terrain_(terrain)
  , rocks_(rocks)
  , parameters_(p)
{
  p.validate();
  if (rocks.empty())
  {
    throw ParameterError("there are no rock blocks to simulate");
  }
  FirstFailure failure;
  std::atomic<std::int64_t> next{ 0 };
  onThreads(p.threads,
    [&]
    {
      for (std::int64_t k = next++; k < std::int64_t(rocks.size()); k = next++)
      {
        try
        {
          rocks[std::size_t(k)].validate();
          const Block& block = blockOf(rocks[std::size_t(k)]);
          checkPlacement(terrain, rocks[std::size_t(k)], block);
          checkPenalty(rocks[std::size_t(k)], block, p);
        }
        catch (...)
        {
          failure.note(k);
        }
      }
    });
  failure.rethrow();
  if (p.rockRockContact)
  {
    if (std::none_of(rocks.begin(), rocks.end(), [](const Rock& r) { return r.uncertainty.any(); }))
    {
      requireEachOnce(rocks, terrain.geometry().origin());
      start_ = this->released(p.firstIteration, pushed_);
      pushed_.iterations *= p.iterations;
    }
    else
    {
      PushedApart first;
      this->released(p.firstIteration, first); // throws what would stop the run at once
    }
  }
}

PushedApart Ensemble::pushed() const
{
  const std::lock_guard<std::mutex> lock(pushing_);
  return pushed_;
}

std::vector<Rock> Ensemble::released(int iteration, PushedApart& pushed) const
{
  std::vector<Rock> rocks(rocks_.begin(), rocks_.end());
  bool drawn = false;
  for (std::size_t k = 0; k < rocks.size(); ++k)
  {
    if (rocks[k].uncertainty.any())
    {
      rocks[k] = realise(terrain_, rocks_[k], parameters_.seed, iteration, std::uint64_t(k));
      drawn = true;
    }
  }
  if (parameters_.pushRocksApart)
  {
    pushed = pushApart(terrain_, rocks);
  }
  else
  {
    requireNoOverlap(rocks, terrain_.geometry().origin(),
      drawn ? " in iteration " + std::to_string(iteration) : std::string());
  }
  return rocks;
}

Trajectory Ensemble::simulate(std::int64_t number, double enough) const
{
  const int rock = int(number % std::int64_t(rocks_.size()));
  const int iteration = parameters_.firstIteration + int(number / std::int64_t(rocks_.size()));
  // The block is made anew: it costs less than a hundredth of what follows, and a hundred thousand
  // of them would take more memory than all their summaries.
  const Rock& given = rocks_[std::size_t(rock)];
  const Surface surface(terrain_, parameters_.seed, iteration);
  const auto release = [&](const Rock& released)
  {
    const Block block = blockOf(released);
    return RockSimulator(surface, released, block, parameters_, std::uint32_t(rock)).run(enough);
  };
  Trajectory trajectory = given.uncertainty.any()
    ? release(realise(terrain_, given, parameters_.seed, iteration, std::uint64_t(rock)))
    : release(given);
  trajectory.summary.rock = rock;
  trajectory.summary.iteration = iteration;
  trajectory.summary.hash = motionHash(trajectory);
  return trajectory;
}

std::vector<Trajectory> Ensemble::simulateUnit(
  std::int64_t unit, double enough, const std::function<bool(double)>& goOn) const
{
  std::vector<Trajectory> trajectories;
  if (!parameters_.rockRockContact)
  {
    trajectories.push_back(this->simulate(unit, enough));
    return trajectories;
  }
  const int iteration = parameters_.firstIteration + int(unit);
  PushedApart pushed;
  const std::vector<Rock> rocks = start_.empty() ? this->released(iteration, pushed) : start_;
  {
    const std::lock_guard<std::mutex> lock(pushing_);
    pushed_.add(pushed);
  }
  std::vector<Block> blocks;
  blocks.reserve(rocks.size());
  for (const Rock& rock : rocks)
  {
    blocks.push_back(blockOf(rock));
  }
  const Surface surface(terrain_, parameters_.seed, iteration);
  MassFall fall(surface, rocks, blocks, parameters_);
  const double end = std::min(enough, parameters_.endTime);
  trajectories = fall.run([&](double time) { return goOn(time / end) && time < enough; });
  for (std::size_t rock = 0; rock < trajectories.size(); ++rock)
  {
    TrajectorySummary& summary = trajectories[rock].summary;
    summary.rock = int(rock);
    summary.iteration = iteration;
    summary.hash = motionHash(trajectories[rock]);
  }
  return trajectories;
}

bool Ensemble::run(
  const EnsembleShare& share, TrajectorySink& sink, const Progress& progress, double enough) const
{
  const std::int64_t total = share.count();
  if (total == 0)
  {
    return true;
  }
  constexpr double kWhole = 1e6; // of a unit: falls of many rocks tell how far they have come
  std::atomic<std::int64_t> next{ 0 }, done{ 0 };
  std::atomic<bool> stop{ false };
  FirstFailure failure;
  InOrder inOrder(sink);
  // In order, too, are they begun: so few wait for their turn.
  const auto simulateNext = [&]
  {
    const AbortScope scope(stop);
    for (std::int64_t k = next++; k < total && !stop; k = next++)
    {
      std::int64_t told = 0;
      const auto tell = [&](double over)
      {
        const std::int64_t now = std::int64_t(kWhole * std::clamp(over, 0.0, 1.0));
        done += now - std::exchange(told, now);
        return !stop;
      };
      try
      {
        std::vector<Trajectory> unit =
          this->simulateUnit(share.begin + k * share.stride, enough, tell);
        for (Trajectory& trajectory : unit)
        {
          sink.trim(trajectory);
        }
        inOrder.put(k, std::move(unit));
      }
      catch (const Aborted&)
      {
        return; // of all
      }
      catch (...)
      {
        failure.note(k);
        stop = true;
      }
      tell(1.0);
    }
  };

  // The caller's thread only reports: a GUI must not be called from any other one.
  std::atomic<bool> ended{ false };
  std::mutex wakeMutex;
  std::condition_variable wake;
  std::thread worker(
    [&]
    {
      onThreads(parameters_.threads, simulateNext);
      const std::lock_guard<std::mutex> lock(wakeMutex);
      ended = true;
      wake.notify_all();
    });
  bool aborted = false;
  {
    std::unique_lock<std::mutex> lock(wakeMutex);
    while (!ended)
    {
      wake.wait_for(lock, std::chrono::milliseconds(50));
      if (progress && !ended && !aborted)
      {
        lock.unlock();
        if (!progress(double(done) / (kWhole * double(total))))
        {
          aborted = true;
          stop = true;
        }
        lock.lock();
      }
    }
  }
  worker.join();
  failure.rethrow();
  return !aborted && (!progress || progress(1.0));
}

bool runEnsemble(const Terrain& terrain, std::span<const Rock> rocks,
  const SimulationParameters& parameters, TrajectorySink& sink, const Progress& progress)
{
  try
  {
    const AbortScope scope([&] { return !progress || progress(0.0); });
    const Ensemble ensemble(terrain, rocks, parameters);
    return ensemble.run(ensemble.whole(), sink, progress);
  }
  catch (const Aborted&)
  {
    return false; // rocks were still being checked or pushed apart
  }
}

} // namespace rockfall
