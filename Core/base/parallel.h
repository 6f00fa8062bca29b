#pragma once

/// @file
/// Loops whose turns don't depend on each other, for what may itself run on one of many threads.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace rockfall
{

/// work(i) for i = 0 … count − 1, on the threads that there are; in order on the calling thread if
/// there are fewer than two times `grain`. A thread that waits for the others takes up no other
/// work meanwhile: what the caller keeps by thread stays its own.
template <class Work>
void forEach(std::size_t count, std::size_t grain, Work&& work)
{
  if (count < 2 * grain || tbb::this_task_arena::max_concurrency() == 1)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      work(i);
    }
    return;
  }
  tbb::this_task_arena::isolate(
    [&]
    {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const tbb::blocked_range<std::size_t>& part)
        {
          for (std::size_t i = part.begin(); i != part.end(); ++i)
          {
            work(i);
          }
        });
    });
}

} // namespace rockfall
