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
  rows_.begin(request, stiffness, bodies, contacts);
}

void IslandSolver::goOn(const EndDetectionOutcome& seen)
{
  seen_ = seen;
  rows_.noteDetection();
  // Rows of what is found at the end are those of a straight way back.
  const bool cut = accept_ != Accept::Any && seen.missed > kCutMiss;
  looking_ = seen.any() && !cut;
  if (looking_)
  {
    rows_.append();
    looking_ = !seen.onlyTells(look_);
    if (looking_)
    {
      rows_.solve();
    }
  }
  ++look_;
}

} // namespace rockfall
