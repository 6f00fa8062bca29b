#include "simulation/runSink.h"

#include "run/packing.h"
#include "shared/arrays.h"
#include "shared/inputContent.h"
#include "shared/rockPaths.h"
#include "simulation/motion.h"
#include "simulation/runNotes.h"

#include <algorithm>

namespace rockfall::filters
{

Kept KeptParts::of(int iteration) const
{
  return { iteration == this->wholeIteration ? Retention::Full : this->retention, this->impacts };
}

void BrokenRocks::add(const TrajectorySummary& summary)
{
  const bool whole = summary.piece == 0;
  this->released += whole ? 1 : 0;
  this->pieces += summary.pieces;
  this->fines += summary.finesMass;
  if (whole && summary.fate == Fate::Broken)
  {
    ++this->broken;
    this->mass += summary.mass;
  }
}

void CountedRocks::add(bool whole, bool holds)
{
  const bool counted = this->last && !whole;
  this->last = counted || holds;
  this->rocks += this->last && !counted ? 1 : 0;
}

void UnclosedBooks::add(const TrajectorySummary& summary, double gravity)
{
  const bool whole = summary.piece == 0;
  this->rocks += whole ? 1 : 0;
  this->gained.add(whole, gainFromNowhere(summary, gravity) > kTold);
  this->lost.add(whole, lossToNowhere(summary, gravity) > kTold);
}

void PassedBarriers::add(const TrajectorySummary& summary, std::span<const StructureEvent> events)
{
  const bool whole = summary.piece == 0;
  const auto any = [events](StructureOutcome outcome)
  {
    return std::any_of(events.begin(), events.end(),
      [outcome](const StructureEvent& event) {
        return event.outcome == outcome && event.usefulHeight > 0.0;
      }); // one that records has none
  };
  this->rocks += whole ? 1 : 0;
  this->passed.add(whole, any(StructureOutcome::BarrierPassed));
  this->struck.add(whole, any(StructureOutcome::BarrierStruck));
}

RunSink::RunSink(const RunFrame& frame, const KeptParts& kept)
  : kept_(kept)
  , lines_(frame, kept.retention == Retention::Full)
  , impacts_(frame)
  , structures_(frame)
  , rows_(frame)
  , gravity_(frame.gravity)
{
}

void RunSink::consume(Trajectory&& trajectory)
{
  hash_.add(trajectory.summary.hash);
  broken_.add(trajectory.summary);
  unclosed_.add(trajectory.summary, gravity_);
  passedBarriers_.add(trajectory.summary, trajectory.structures);
  rows_.append(trajectory.summary);
  impacts_.append(trajectory.summary, trajectory.impacts);
  structures_.append(trajectory.summary, trajectory.structures);
  if (trajectory.summary.iteration == kept_.wholeIteration)
  {
    trajectory.impacts = {};
    whole_.push_back(trajectory);
    thin(trajectory, kept_.retention);
  }
  lines_.append(trajectory);
}

void RunSink::copy(RunData& output) const
{
  structures_.copy(output.structures);
  lines_.copy(output.trajectories);
  writeRetention(kept_.retention, output.trajectories->GetFieldData());
  impacts_.copy(output.impacts);
  rows_.copy(output.summary);
}

void RunSink::finish(RunData& output)
{
  structures_.finish(output.structures);
  lines_.finish(output.trajectories);
  writeRetention(kept_.retention, output.trajectories->GetFieldData());
  addTexts(output.trajectories->GetFieldData(), kRunDoubts, unclosedNotes(unclosed_));
  impacts_.finish(output.impacts);
  rows_.finish(output.summary);
}

void PackingSink::consume(Trajectory&& trajectory)
{
  pack(trajectory, bytes_);
}

void MomentSink::show(const Trajectory& trajectory)
{
  const TrajectorySummary& summary = trajectory.summary;
  Polyhedron shape;
  if (summary.piece > 0 || summary.fate == Fate::Broken)
  {
    shape = shapes_.next(summary, released_[std::size_t(summary.rock)]);
  }
  const bool gone = summary.fate == Fate::Broken && time_ >= trajectory.samples.back().time;
  const bool later = summary.piece > 0 && time_ < trajectory.samples.front().time;
  if (!gone && !later)
  {
    rocks_.push_back(momentOf(trajectory, time_));
    rocks_.back().shape = shape;
  }
}

} // namespace rockfall::filters
