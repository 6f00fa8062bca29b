#pragma once

/// @file
/// Loops whose turns don't depend on each other, for what may itself run on one of many threads.

#include "base/abort.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <functional>
#include <type_traits>
#include <vector>

namespace rockfall
{

namespace parallel
{

/// Turns begin … end − 1 of a loop.
struct Loop
{
  void (*run)(const void* work, std::size_t begin, std::size_t end);
  const void* work;
  std::size_t count;
  std::size_t grain;
};

/// Threads that there are for a loop.
int threads();

/// Shares a loop out among the threads that stand by (standBy); false if none does.
bool share(const Loop& loop);

} // namespace parallel

/// work(), while up to `most` − 1 further threads stand by for the loops in it (forEach). They
/// don't sleep in between: a loop of a few microseconds is worth sharing out too. Only threads that
/// have nothing else to do come, of those that the caller's TBB arena has.
void standBy(int most, const std::function<void()>& work);

/// work(i) for i = 0 … count − 1, on the threads that there are, `grain` turns at a time; in order
/// on the calling thread if there are fewer than two times `grain`. A thread that waits for the
/// others takes up no work meanwhile but that of loops further in than its own: what a turn keeps
/// by thread is safe from turns of the same loop.
/// @throws What work throws; of several the first.
template <class Work>
void forEach(std::size_t count, std::size_t grain, Work&& work)
{
  struct Shared
  {
    const std::remove_reference_t<Work>* work;
    const AbortScope* scope; ///< By which threads that share the loop can give up, too.
  };
  const auto run = [](const void* of, std::size_t begin, std::size_t end)
  {
    const auto& shared = *static_cast<const Shared*>(of);
    const AbortScope::Borrowed scope(shared.scope);
    for (std::size_t i = begin; i < end; ++i)
    {
      (*shared.work)(i);
    }
  };
  const Shared shared{ &work, AbortScope::current() };
  if (count < 2 || count < 2 * grain || parallel::threads() == 1)
  {
    run(&shared, 0, count);
  }
  else if (!parallel::share({ run, &shared, count, grain }))
  {
    tbb::this_task_arena::isolate(
      [&]
      {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
          [&](const tbb::blocked_range<std::size_t>& part)
          { run(&shared, part.begin(), part.end()); });
      });
  }
}

/// ask(i) of all i as in forEach, then act(i) of those for which it was true, in order on the
/// calling thread. `answers` is work space.
template <class Ask, class Act>
void forThose(
  std::size_t count, std::size_t grain, std::vector<char>& answers, Ask&& ask, Act&& act)
{
  answers.resize(count);
  forEach(count, grain, [&](std::size_t i) { answers[i] = ask(i); });
  for (std::size_t i = 0; i < count; ++i)
  {
    if (answers[i])
    {
      act(i);
    }
  }
}

} // namespace rockfall
