#include "run/ensemble.h"

#include "base/abort.h"
#include "base/errors.h"
#include "geometry/roundBody.h"
#include "law/settings.h"
#include "run/brokenFall.h"
#include "run/releaseChecks.h"
#include "run/stateHash.h"
#include "world/World.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace rockfall
{

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
        Trajectory next = std::move(trajectory); // it is gone when the one behind it comes
        sink_.consume(std::move(next));          // if it throws nothing more is delivered
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

/// Round bodies have contacts with the slope only.
void refuseRound(const Rock& rock, const SimulationParameters& p)
{
  if (p.rockRockContact && isRound(rock.shape.layout()))
  {
    throw ParameterError("block " + std::to_string(rock.blockId) +
      " is a sphere or an ellipsoid, which must fall alone: RockRockContact must be 0, or the "
      "block another shape, as an icosahedron");
  }
}

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

} // namespace

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
  if (double(rocks.size()) * double(p.iterations) > kMostTrajectories)
  {
    throw ParameterError("Iterations is " + std::to_string(p.iterations) + ", with " +
      std::to_string(rocks.size()) +
      " rocks that makes more than 100,000,000 trajectories: run them in parts by FirstIteration");
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
          refuseRound(rocks[std::size_t(k)], p);
          if (p.fragmentation.on)
          {
            requireBreakable(rocks[std::size_t(k)], p.fragmentation);
          }
          const Block& block = blockOf(rocks[std::size_t(k)]);
          requireOnSlope(terrain, rocks[std::size_t(k)], block);
          requireStiff(rocks[std::size_t(k)], block, p);
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

std::vector<Rock> Ensemble::rocksOf(std::int64_t unit, int iteration) const
{
  if (parameters_.rockRockContact)
  {
    if (!start_.empty())
    {
      return start_;
    }
    PushedApart pushed;
    std::vector<Rock> rocks = this->released(iteration, pushed);
    const std::lock_guard<std::mutex> lock(pushing_);
    pushed_.add(pushed);
    return rocks;
  }
  const std::int64_t rock = unit % this->unitsPerIteration();
  const Rock& given = rocks_[std::size_t(rock)];
  return { given.uncertainty.any()
      ? realise(terrain_, given, parameters_.seed, iteration, std::uint64_t(rock))
      : given };
}

std::vector<Trajectory> Ensemble::simulate(
  std::int64_t unit, const std::function<bool(double)>& goOn, double enough, const Kept& kept) const
{
  const int first = parameters_.rockRockContact ? 0 : int(unit % this->unitsPerIteration());
  const int iteration = this->iterationOf(unit);
  const std::vector<Rock> rocks = this->rocksOf(unit, iteration);
  const Surface surface(terrain_, parameters_.seed, iteration);
  SimulationParameters own = parameters_;
  own.kept = kept;
  const auto identify = [&](Trajectory& trajectory, int rock)
  {
    trajectory.summary.rock = rock;
    trajectory.summary.iteration = iteration;
    if (!trajectory.summary.stop.allFinite() || !std::isfinite(trajectory.summary.endTime))
    {
      throw Error("rock " + std::to_string(rock) + " (block " +
        std::to_string(trajectory.summary.blockId) + ") of iteration " + std::to_string(iteration) +
        " is nowhere at its end: an error of the program, not of its input");
    }
    trajectory.summary.hash = motionHash(trajectory);
    thin(trajectory, own.kept.samples);
  };
  if (parameters_.fragmentation.on)
  {
    requireBreakable(rocks[0], parameters_.fragmentation);
    std::vector<Trajectory> parts =
      fallAndBreak(surface, rocks[0], own, std::uint32_t(first), enough);
    std::for_each(parts.begin(), parts.end(), [&](Trajectory& part) { identify(part, first); });
    return parts;
  }
  // Blocks are made anew: it costs less than a hundredth of what follows, and a hundred thousand of
  // them would take more memory than all their summaries.
  std::vector<Block> blocks;
  blocks.reserve(rocks.size());
  for (const Rock& rock : rocks)
  {
    blocks.push_back(blockOf(rock));
  }
  std::vector<Trajectory> trajectories =
    World(surface, rocks, blocks, own, first).run(goOn, enough);
  for (std::size_t k = 0; k < trajectories.size(); ++k)
  {
    identify(trajectories[k], first + int(k));
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
  const double end = std::min(enough, parameters_.endTime);
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
      const auto tell = [&](double time)
      {
        const std::int64_t now = std::int64_t(kWhole * std::clamp(time / end, 0.0, 1.0));
        done += now - std::exchange(told, now);
        return !stop;
      };
      try
      {
        const std::int64_t unit = share.begin + k * share.stride;
        inOrder.put(k, this->simulate(unit, tell, enough, sink.kept(this->iterationOf(unit))));
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
      tell(end);
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

} // namespace rockfall
