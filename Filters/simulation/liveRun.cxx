#include "simulation/liveRun.h"

#include "base/errors.h"
#include "shared/rockPaths.h"
#include "shared/withAbort.h"

#include <utility>

namespace rockfall::filters
{

namespace
{

/// Points of trajectories that are copied to be looked at: 200 MB or so, a third of a second.
constexpr std::int64_t kMostPoints = 1'000'000;

} // namespace

/// A single thread at a time writes or reads.
class LiveRun::Sink : public TrajectorySink
{
public:
  explicit Sink(const KeptRun& run)
    : results(run.frame, run.parts)
  {
  }
  void trim(Trajectory& trajectory) const override { this->results.trim(trajectory); }
  void consume(Trajectory&& trajectory) override
  {
    const std::lock_guard<std::mutex> lock(this->mutex);
    this->points += std::int64_t(trajectory.samples.size());
    ++this->count;
    this->results.consume(std::move(trajectory));
  }

  std::mutex mutex;
  RunSink results;
  std::int64_t points = 0, count = 0;
};

LiveRun::LiveRun(std::unique_ptr<KeptRun> run)
  : run_(std::move(run))
  , sink_(std::make_unique<Sink>(*run_))
  , thread_(
      [this]
      {
        try
        {
          run_->ensemble->run(run_->ensemble->whole(), *sink_,
            [this](double share)
            {
              share_ = share;
              return !stop_;
            });
        }
        catch (...)
        {
          failure_ = reasonOf(run_->noMemory());
        }
        over_ = true;
      })
{
}

LiveRun::~LiveRun()
{
  stop_ = true;
  if (thread_.joinable())
  {
    thread_.join();
  }
}

void LiveRun::wait(double seconds) const
{
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!over_ && std::chrono::steady_clock::now() < until)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

double LiveRun::elapsed() const
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

std::int64_t LiveRun::trajectories() const
{
  const std::lock_guard<std::mutex> lock(sink_->mutex);
  return sink_->count;
}

void LiveRun::look()
{
  const std::lock_guard<std::mutex> lock(sink_->mutex);
  if (sink_->points > kMostPoints && run_->trajectories->GetNumberOfPoints() > 0)
  {
    return;
  }
  sink_->results.copy(run_->trajectories, run_->impacts, run_->summary, run_->structures);
  run_->describe();
  markRunning(run_->trajectories->GetFieldData());
}

std::unique_ptr<KeptRun> LiveRun::take()
{
  thread_.join();
  if (!failure_.empty())
  {
    throw Error(failure_);
  }
  run_->takeResults(sink_->results);
  return std::move(run_);
}

} // namespace rockfall::filters
