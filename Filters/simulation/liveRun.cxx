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
  Kept kept(int iteration) const override { return this->results.kept(iteration); }
  void consume(Trajectory&& trajectory) override
  {
    const std::lock_guard<std::mutex> lock(this->mutex);
    const bool few = this->isLookedAt();
    this->points += std::int64_t(trajectory.samples.size());
    this->made += trajectory.summary.piece == 0 ? 1 : 0;
    this->shown += few ? 1 : 0;
    this->results.consume(std::move(trajectory));
    if (few && !this->isLookedAt())
    {
      this->results.copy(this->last);
    }
  }
  bool isLookedAt() const { return this->points <= kMostPoints; }

  std::mutex mutex;
  RunSink results;
  std::int64_t points = 0, made = 0;
  std::int64_t shown = 0; ///< Trajectories of the next look.
  RunData last;           ///< What is looked at when there are very many.
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
  return sink_->made;
}

std::int64_t LiveRun::shown() const
{
  const std::lock_guard<std::mutex> lock(sink_->mutex);
  return sink_->shown;
}

void LiveRun::look()
{
  const std::lock_guard<std::mutex> lock(sink_->mutex);
  if (sink_->isLookedAt())
  {
    sink_->results.copy(*run_);
  }
  else
  {
    run_->trajectories->ShallowCopy(sink_->last.trajectories);
    run_->impacts->ShallowCopy(sink_->last.impacts);
    run_->summary->ShallowCopy(sink_->last.summary);
    run_->structures->ShallowCopy(sink_->last.structures);
  }
  run_->describe();
  run_->writeNotes();
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
