#pragma once

/// @file
/// What Core uses of oneTBB, over std::thread, for builds under ThreadSanitizer: the packaged
/// oneTBB is compiled without it, so that its handing over of work looks like races. Loops within
/// loops run on the thread that meets them.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace tbb
{

namespace standIn
{

/// Threads of an arena that names no number: more than most machines of a CI have, for the sake of
/// orders that are rare.
inline constexpr int kThreads = 4;

/// Where a thread works.
struct Place
{
  int threads = kThreads;
  bool inLoop = false;
};
inline thread_local Place place;

inline std::atomic<std::size_t> allowed{ std::size_t(kThreads) };

/// Sets a thread's place for as long as this lives.
struct Placed
{
  explicit Placed(const Place& now)
    : before(std::exchange(place, now))
  {
  }
  ~Placed() { place = before; }
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;

  Place before;
};

/// The first exception of several threads.
class Failure
{
public:
  template <class Work>
  void guard(Work&& work)
  {
    try
    {
      work();
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!first_)
      {
        first_ = std::current_exception();
      }
    }
  }
  void rethrow()
  {
    if (first_)
    {
      std::rethrow_exception(std::exchange(first_, nullptr));
    }
  }

private:
  std::mutex mutex_;
  std::exception_ptr first_;
};

/// part(k) of k = 0 … parts − 1, on the threads of the arena.
template <class Part>
void onThreads(std::size_t parts, const Part& part)
{
  const std::size_t threads =
    place.inLoop ? 1 : std::min({ std::size_t(place.threads), allowed.load(), parts });
  std::atomic<std::size_t> next{ 0 };
  std::atomic<bool> stop{ false };
  Failure failure;
  const Place inside{ place.threads, true };
  const auto work = [&]
  {
    const Placed here(inside);
    failure.guard(
      [&]
      {
        for (std::size_t k = next++; k < parts && !stop; k = next++)
        {
          try
          {
            part(k);
          }
          catch (...)
          {
            stop = true;
            throw;
          }
        }
      });
  };
  std::vector<std::thread> others;
  for (std::size_t k = 1; k < threads; ++k)
  {
    others.emplace_back(work);
  }
  work();
  for (std::thread& other : others)
  {
    other.join();
  }
  failure.rethrow();
}

} // namespace standIn

struct simple_partitioner
{
};

template <class Value>
class blocked_range
{
public:
  blocked_range(Value begin, Value end, std::size_t grain = 1)
    : begin_(begin)
    , end_(end)
    , grain_(std::max<std::size_t>(1, grain))
  {
  }
  Value begin() const { return begin_; }
  Value end() const { return end_; }
  std::size_t grainsize() const { return grain_; }

private:
  Value begin_, end_;
  std::size_t grain_;
};

template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body)
{
  const std::size_t grain = range.grainsize(), count = std::size_t(range.end() - range.begin());
  standIn::onThreads((count + grain - 1) / grain,
    [&](std::size_t k)
    {
      body(blocked_range<Value>(range.begin() + Value(k * grain),
        range.begin() + Value(std::min(count, (k + 1) * grain)), grain));
    });
}

template <class Body>
void parallel_for(int first, int last, const Body& body, const simple_partitioner&)
{
  standIn::onThreads(
    std::size_t(std::max(0, last - first)), [&](std::size_t k) { body(first + int(k)); });
}

template <class Iterator>
void parallel_sort(Iterator begin, Iterator end)
{
  std::sort(begin, end);
}

class task_arena
{
public:
  static constexpr int automatic = -1;

  explicit task_arena(int threads, unsigned = 1)
    : threads_(threads == automatic ? standIn::kThreads : threads)
  {
  }
  template <class Work>
  void execute(Work&& work)
  {
    const standIn::Placed here({ threads_, false });
    work();
  }

private:
  int threads_;
};

namespace this_task_arena
{

inline int max_concurrency()
{
  return standIn::place.threads;
}

template <class Work>
void isolate(Work&& work)
{
  work();
}

} // namespace this_task_arena

class global_control
{
public:
  enum parameter
  {
    max_allowed_parallelism
  };
  global_control(parameter, std::size_t value)
    : before_(standIn::allowed.exchange(value))
  {
  }
  ~global_control() { standIn::allowed = before_; }
  global_control(const global_control&) = delete;
  global_control& operator=(const global_control&) = delete;

private:
  std::size_t before_;
};

} // namespace tbb
