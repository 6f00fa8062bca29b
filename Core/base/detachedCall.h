#pragma once

/// @file
/// Calls of libraries that cannot be told to stop, given up all the same (base/abort.h).

#include "base/abort.h"

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <type_traits>
#include <utility>

namespace rockfall
{

namespace detached
{

/// How often a wait asks whether it is still wanted.
inline constexpr std::chrono::milliseconds kLook(20);

/// Starts work on a thread of its own. The end of the program waits for it.
void startAside(std::function<void()> work);

} // namespace detached

/// work(), on a thread of its own where somebody can give it up, on this one elsewhere. Throws
/// Aborted as soon as it is no longer wanted; the other thread then goes on to the work's end, so
/// `work` owns all that it uses.
/// @throws What work throws.
template <class Work>
std::invoke_result_t<Work&> detachedCall(Work work)
{
  using Result = std::invoke_result_t<Work&>;
  if (!AbortScope::current())
  {
    return work();
  }
  auto task = std::make_shared<std::packaged_task<Result()>>(std::move(work));
  std::future<Result> result = task->get_future();
  detached::startAside([task = std::move(task)] { (*task)(); });
  while (result.wait_for(detached::kLook) != std::future_status::ready)
  {
    stayWanted();
  }
  return result.get();
}

} // namespace rockfall
