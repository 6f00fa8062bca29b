#include "base/parallel.h"

#include "base/cache.h"

#include <tbb/global_control.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

namespace rockfall
{

namespace
{

/// Loops within loops; further down a thread goes on by itself.
constexpr int kLevels = 3;
/// Looks for something to do before other programs get their turn.
constexpr int kIdleLooks = 2000;

void pause()
{
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Threads that share out loops. Each has a seat; what is left of a loop lies before the seats, one
/// range each: a thread takes from its own range first, so that from loop to loop it sees much the
/// same things, then from the others'.
class Team
{
public:
  explicit Team(int seats)
    : seats_(seats)
  {
    for (int k = 0; k < seats * kLevels; ++k)
    {
      tables_.emplace_back(seats);
    }
  }

  int seats() const { return seats_; }
  void share(const parallel::Loop& loop);
  void help(int seat);
  void end() { over_.store(true, std::memory_order_release); }

private:
  struct alignas(kCacheLine) Range
  {
    std::atomic<std::size_t> next{ 0 };
    std::atomic<std::size_t> end{ 0 };

    bool left() const
    {
      return next.load(std::memory_order_relaxed) < end.load(std::memory_order_relaxed);
    }
  };
  /// Where a thread lays out a loop.
  struct alignas(kCacheLine) Table
  {
    explicit Table(int seats)
      : ranges(std::size_t(seats))
    {
    }

    std::atomic<bool> open{ false };
    alignas(
      kCacheLine) std::atomic<int> inside{ 0 }; ///< Threads that may be at it, besides the owner.
    parallel::Loop loop{};
    std::vector<Range> ranges;
    std::atomic<bool> failed{ false };
    std::exception_ptr failure;
  };

  Table& table(int level, int seat)
  {
    return tables_[std::size_t(level) * std::size_t(seats_) + std::size_t(seat)];
  }
  void work(Table& table, int seat, int level);
  bool helpFrom(int level, int seat);

  int seats_;
  std::deque<Table> tables_; ///< By level, then by seat.
  std::atomic<bool> over_{ false };
};

/// Where the thread sits, and how many loops it is in.
struct Place
{
  Team* team = nullptr;
  int seat = 0;
  int level = 0;
  bool alone = false; ///< No other thread may ever help.
};

thread_local Place place;

/// Changes it for as long as this lives.
struct Seated
{
  explicit Seated(const Place& now)
    : before(std::exchange(place, now))
  {
  }
  ~Seated() { place = before; }
  Seated(const Seated&) = delete;
  Seated& operator=(const Seated&) = delete;

  Place before;
};

/// Until `done`, with other work if there is some.
template <class Done, class Other>
void spin(Done&& done, Other&& other)
{
  for (int looks = 0; !done();)
  {
    if (other())
    {
      looks = 0;
    }
    else if (++looks < kIdleLooks)
    {
      pause();
    }
    else
    {
      std::this_thread::yield();
      looks = 0;
    }
  }
}

void Team::work(Table& t, int seat, int level)
{
  const int before = std::exchange(place.level, level + 1);
  const parallel::Loop& loop = t.loop;
  for (int k = 0; k < seats_; ++k)
  {
    Range& range = t.ranges[std::size_t((seat + k) % seats_)];
    while (range.left() && !t.failed.load(std::memory_order_relaxed))
    {
      const std::size_t begin = range.next.fetch_add(loop.grain, std::memory_order_relaxed);
      const std::size_t end = range.end.load(std::memory_order_relaxed);
      if (begin >= end)
      {
        break;
      }
      try
      {
        loop.run(loop.work, begin, std::min(begin + loop.grain, end));
      }
      catch (...)
      {
        if (!t.failed.exchange(true))
        {
          t.failure = std::current_exception();
        }
      }
    }
  }
  place.level = before;
}

/// Looks for a loop at this level or further in.
bool Team::helpFrom(int level, int seat)
{
  for (int l = level; l < kLevels; ++l)
  {
    for (int k = 0; k < seats_; ++k)
    {
      Table& t = this->table(l, k);
      const auto left = [](const Range& range) { return range.left(); };
      if (!t.open.load(std::memory_order_relaxed) ||
        std::none_of(t.ranges.begin(), t.ranges.end(), left))
      {
        continue;
      }
      // Either the owner sees who is inside, or that one sees that it is closed.
      t.inside.fetch_add(1, std::memory_order_seq_cst);
      const bool open = t.open.load(std::memory_order_seq_cst);
      if (open)
      {
        this->work(t, seat, l);
      }
      t.inside.fetch_sub(1, std::memory_order_release);
      if (open)
      {
        return true;
      }
    }
  }
  return false;
}

void Team::share(const parallel::Loop& loop)
{
  const int seat = place.seat, level = place.level;
  Table& t = this->table(level, seat);
  t.loop = loop;
  t.failed.store(false, std::memory_order_relaxed);
  t.failure = nullptr;
  // Ranges are whole numbers of grains.
  const std::size_t grains = (loop.count + loop.grain - 1) / loop.grain,
                    seats = std::size_t(seats_);
  for (std::size_t k = 0; k < seats; ++k)
  {
    t.ranges[k].next.store(grains * k / seats * loop.grain, std::memory_order_relaxed);
    t.ranges[k].end.store(
      std::min(grains * (k + 1) / seats * loop.grain, loop.count), std::memory_order_relaxed);
  }
  t.open.store(true, std::memory_order_seq_cst);
  this->work(t, seat, level);
  t.open.store(false, std::memory_order_seq_cst);
  spin([&] { return t.inside.load(std::memory_order_seq_cst) == 0; },
    [&] { return this->helpFrom(level + 1, seat); });
  if (t.failure)
  {
    std::rethrow_exception(std::exchange(t.failure, nullptr));
  }
}

void Team::help(int seat)
{
  const Seated here({ this, seat, 0, false });
  spin(
    [&] { return over_.load(std::memory_order_acquire); }, [&] { return this->helpFrom(0, seat); });
}

} // namespace

int parallel::threads()
{
  return place.team ? place.team->seats()
                    : (place.alone ? 1 : tbb::this_task_arena::max_concurrency());
}

bool parallel::share(const Loop& loop)
{
  if (!place.team)
  {
    return false;
  }
  if (place.level < kLevels)
  {
    place.team->share(loop);
  }
  else
  {
    loop.run(loop.work, 0, loop.count);
  }
  return true;
}

void standBy(int most, const std::function<void()>& work)
{
  const int allowed =
    int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  const int there = std::min(tbb::this_task_arena::max_concurrency(), allowed);
  const int seats = std::min(most, there);
  if (place.team)
  {
    work();
    return;
  }
  if (seats < 2)
  {
    const Seated here({ nullptr, 0, 0, there == 1 });
    work();
    return;
  }
  tbb::this_task_arena::isolate(
    [&]
    {
      Team team(seats);
      tbb::task_group others;
      struct End
      {
        Team& team;
        tbb::task_group& others;
        ~End()
        {
          team.end();
          others.wait();
        }
      } end{ team, others };
      for (int seat = 1; seat < seats; ++seat)
      {
        others.run([&team, seat] { team.help(seat); });
      }
      const Seated here({ &team, 0, 0, false });
      work();
    });
}

} // namespace rockfall
