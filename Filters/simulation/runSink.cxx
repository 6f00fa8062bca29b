#include "simulation/runSink.h"

#include "run/packing.h"
#include "shared/rockPaths.h"
#include "simulation/motion.h"

#include "vtkPolyData.h"

namespace rockfall::filters
{

void KeptParts::trim(Trajectory& trajectory) const
{
  if (trajectory.summary.iteration != this->wholeIteration)
  {
    thin(trajectory, this->retention);
  }
}

RunSink::RunSink(const RunFrame& frame, const KeptParts& kept)
  : kept_(kept)
  , lines_(frame, kept.retention == Retention::Full)
  , impacts_(frame)
  , structures_(frame)
  , rows_(frame)
{
}

void RunSink::consume(Trajectory&& trajectory)
{
  hash_.add(trajectory.summary.hash);
  rows_.append(trajectory.summary);
  impacts_.append(trajectory);
  structures_.append(trajectory);
  if (trajectory.summary.iteration == kept_.wholeIteration)
  {
    trajectory.impacts = {};
    whole_.push_back(trajectory);
    thin(trajectory, kept_.retention);
  }
  lines_.append(trajectory);
}

void RunSink::copy(
  vtkPolyData* trajectories, vtkPolyData* impacts, vtkTable* summary, vtkPolyData* structures) const
{
  structures_.copy(structures);
  lines_.copy(trajectories);
  writeRetention(kept_.retention, trajectories->GetFieldData());
  impacts_.copy(impacts);
  rows_.copy(summary);
}

void RunSink::finish(
  vtkPolyData* trajectories, vtkPolyData* impacts, vtkTable* summary, vtkPolyData* structures)
{
  if (structures)
  {
    structures_.finish(structures);
  }
  lines_.finish(trajectories);
  writeRetention(kept_.retention, trajectories->GetFieldData());
  impacts_.finish(impacts);
  rows_.finish(summary);
}

void PackingSink::consume(Trajectory&& trajectory)
{
  pack(trajectory, bytes_);
}

void MomentSink::show(const Trajectory& trajectory)
{
  rocks_.push_back(momentOf(trajectory, time_));
}

} // namespace rockfall::filters
