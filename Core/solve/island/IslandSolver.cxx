#include "solve/island/IslandSolver.h"

#include "law/settings.h"

namespace rockfall
{

void IslandSolver::begin(const StepRequest& request, Accept accept, std::vector<IslandBody>& bodies,
  std::vector<IslandContact>& contacts)
{
  accept_ = accept;
  seen_ = {};
  look_ = 0;
  looking_ = true;
  if (method == IslandMethod::Crowd)
  {
    crowd_.tolerance = tolerance;
    crowd_.maxSweeps = maxSweeps;
    crowd_.stiffness = stiffness;
    system_ = &crowd_;
  }
  else
  {
    soft_.stiffness = stiffness;
    system_ = &soft_;
  }
  system_->begin(request, bodies, contacts);
}

bool IslandSolver::asksForALook() const
{
  return looking_ && system_->hasSolution() &&
    (seen_.asksFor(look_) || (look_ <= kMostMissLooks && system_->needsRecheck()));
}

void IslandSolver::goOn(const EndDetectionOutcome& seen)
{
  seen_ = seen;
  system_->noteDetection();
  // Rows of what is found at the end are those of a straight way back.
  const bool cut = accept_ != Accept::Any && seen.missed > kCutMiss;
  looking_ = seen.any() && !cut;
  if (looking_)
  {
    system_->append();
    looking_ = !seen.onlyTells(look_);
    if (looking_)
    {
      system_->solve();
    }
  }
  ++look_;
}

IslandOutcome IslandSolver::finish()
{
  return system_->finish(accept_, seen_.isDeep());
}

} // namespace rockfall
