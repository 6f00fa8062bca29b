#pragma once

/// @file
/// Loops whose turns don't depend on each other, for what may itself run on one of many threads.

#include "base/abort.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <vector>

namespace rockfall
{

/// work(i) for i = 0 … count − 1, on the threads of the TBB arena, `grain` turns at a time or more;
/// in order on the calling thread if there are fewer than two times `grain`. A thread that waits for
/// the others takes up no work meanwhile but that of loops further in than its own: what a turn
/// keeps by thread is safe from turns of the same loop.
/// @throws What work throws; of several the first.
template <class Work>
void forEach(std::size_t count, std::size_t grain, Work&& work)
{
  const auto run = [&work](std::size_t begin, std::size_t end)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      work(i);
    }
  };
  if (count < 2 || count < 2 * grain || tbb::this_task_arena::max_concurrency() == 1)
  {
    run(0, count);
    return;
  }
  const AbortScope* scope = AbortScope::current();
  tbb::this_task_arena::isolate(
    [&]
    {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const tbb::blocked_range<std::size_t>& part)
        {
          const AbortScope::Borrowed borrowed(scope); // by which threads that help can give up, too
          run(part.begin(), part.end());
        });
    });
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
