#include "base/detachedCall.h"

#include <atomic>
#include <list>
#include <mutex>
#include <thread>

namespace rockfall::detached
{

namespace
{

/// Threads of work that its caller may leave. Joined at the end of the program at the latest: what
/// they use of libraries must still be there.
class Aside
{
public:
  ~Aside()
  {
    for (Worker& worker : workers_)
    {
      worker.thread.join();
    }
  }

  void start(std::function<void()> work)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    workers_.remove_if(
      [](Worker& worker)
      {
        const bool over = worker.over;
        if (over)
        {
          worker.thread.join();
        }
        return over;
      });
    Worker& worker = workers_.emplace_back();
    try
    {
      worker.thread = std::thread(
        [&worker, work = std::move(work)]() mutable
        {
          work();
          work = nullptr; // with what it owns
          worker.over = true;
        });
    }
    catch (...)
    {
      workers_.pop_back();
      throw;
    }
  }

private:
  struct Worker
  {
    std::thread thread;
    std::atomic<bool> over = false;
  };

  std::mutex mutex_;
  std::list<Worker> workers_;
};

} // namespace

void startAside(std::function<void()> work)
{
  static Aside aside;
  aside.start(std::move(work));
}

} // namespace rockfall::detached
