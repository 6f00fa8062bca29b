#include "simulation/currentRun.h"

#include "shared/arrays.h"
#include "shared/errorReport.h"
#include "shared/inputContent.h"
#include "simulation/progressText.h"
#include "simulation/runNotes.h"
#include "simulation/sharedRun.h"

#include "vtkAlgorithm.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace rockfall::filters
{

namespace
{

/// A run that is watched shows what it has after so long, s: a short one is then over.
constexpr double kAtOnce = 0.3;
/// Looks at a run take a fifth of the window's time, and come once a second at most.
constexpr double kLookInterval = 1.0, kLookShare = 4.0;

} // namespace

bool CurrentRun::make(std::unique_ptr<KeptRun> run, vtkPolyData* terrain, vtkPolyData* rocks,
  const Ranks& ranks, bool printProgress)
{
  const std::string noMemory = run->noMemory();
  bool same = false;
  ranks.together([&] { same = kept_ && kept_->takesOver(*run, terrain, rocks, ranks); }, noMemory);
  const std::vector<int> kept = ranks.gather(same ? 1 : 0);
  if (std::find(kept.begin(), kept.end(), 0) == kept.end())
  {
    return true;
  }
  if (live_ && live_->run().isLike(*run))
  {
    this->follow();
    return true;
  }
  this->forget();
  const int threads = ranks.threads();
  run->parameters.threads = run->parameters.threads > 0 ? run->parameters.threads : threads;
  run->prepare(terrain, rocks, ranks);
  const bool first = ranks.rank() == 0;
  // Rocks that are the same in all iterations are known before they run.
  const bool anew = run->ensemble->pushesAnew();
  if (first)
  {
    if (run->printNotes)
    {
      std::ranges::for_each(run->idle, showNote);
    }
    run->tell(std::exchange(run->notes, {})); // on the inputs
    run->tell(notesBefore(run->slope, run->frame.rocks, run->frame.frequencies, run->parameters));
    run->tell(
      anew ? std::vector<std::string>() : pushedNotes(*run->ensemble, run->ensemble->pushed()));
  }
  ++count_;
  if (watched_ && ranks.count() == 1)
  {
    live_ = std::make_unique<LiveRun>(std::move(run));
    live_->wait(kAtOnce);
    this->follow();
    return true;
  }
  RunSink sink(run->frame, run->parts);
  ProgressReport report(filter_, run->ensemble->size(),
    run->parameters.rockRockContact ? "iterations" : "trajectories", first, printProgress);
  if (!runShared(*run->ensemble, run->parts, &sink, ranks, std::ref(report), noMemory))
  {
    return false;
  }
  const PushedApart pushed = anew ? pushedOnAll(*run->ensemble, ranks) : PushedApart();
  if (first)
  {
    run->tell(pushedNotes(*run->ensemble, pushed));
    run->takeResults(sink);
  }
  else
  {
    run->dropInputs(); // only the first rank shows anything
  }
  ranks.share(run->stateHash);
  report.finish();
  kept_ = std::move(run);
  return true;
}

void CurrentRun::follow()
{
  if (!live_->over())
  {
    live_->look();
    looked_ = live_->shown();
    return;
  }
  // Filters that took a part of the run, in the same pass of a view perhaps, are out of date.
  filter_->Modified();
  const std::unique_ptr<LiveRun> live = std::move(live_);
  const std::string how = statusOf(*live);
  const std::int64_t made = live->trajectories();
  kept_ = live->take();
  status_ = how;
  if (kept_->ensemble->pushesAnew())
  {
    kept_->tell(pushedNotes(*kept_->ensemble, kept_->ensemble->pushed()));
  }
  if (made < kept_->ensemble->size() * kept_->ensemble->trajectoriesPerUnit())
  {
    const std::string note = "Rockfall Simulation was " + how;
    showNote(note);
    kept_->notes.push_back(note);
    // Rocks are made one after the other: those of whole sources may be missing.
    addTexts(kept_->trajectories->GetFieldData(), kRunDoubts,
      std::vector<std::string>{ note + ": shares and frequencies are of these alone" });
  }
  kept_->writeNotes();
}

void CurrentRun::forget()
{
  live_.reset();
  kept_.reset();
}

void CurrentRun::stop()
{
  if (live_)
  {
    live_->stop();
  }
}

bool CurrentRun::hasNews()
{
  using Clock = std::chrono::steady_clock;
  watched_ = true;
  if (!live_)
  {
    return false;
  }
  const Clock::time_point now = Clock::now();
  if (drawn_ < asked_)
  {
    drawn_ = now; // the first time that the window is free again
  }
  const std::chrono::duration<double> cost = drawn_ - asked_, since = now - drawn_;
  // A stopped run ends soon, and is looked at then.
  const bool news = !live_->stopped() &&
    since.count() > std::max(kLookInterval, kLookShare * cost.count()) && live_->shown() > looked_;
  return news || live_->over();
}

const std::string& CurrentRun::status()
{
  if (live_)
  {
    status_ = statusOf(*live_);
  }
  return status_;
}

} // namespace rockfall::filters
