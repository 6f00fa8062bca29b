#include "system/IslandSolver.h"

#include "law/settings.h"

namespace rockfall
{

bool IslandSolver::isSwept(StepKind kind, std::size_t bodies) const
{
  return kind == StepKind::Lasting &&
    (method == IslandMethod::Iterative ||
      (method == IslandMethod::Suited && bodies > std::size_t(kDirectIsland)));
}

void IslandSolver::begin(const StepRequest& request, Accept accept, std::vector<IslandBody>& bodies,
  std::vector<IslandContact>& contacts)
{
  request_ = request;
  accept_ = accept;
  bodies_ = &bodies;
  contacts_ = &contacts;
  unsettled_ = false;
  if (this->isSwept(request.kind, bodies.size()))
  {
    this->sweep();
    return;
  }
  system_ = &newton_;
  seen_ = {};
  look_ = 0;
  looking_ = true;
  newton_.begin(request, bodies, contacts);
  this->sweepIfUnsettled();
}

void IslandSolver::sweep()
{
  system_ = &crowd_;
  crowd_.tolerance = tolerance;
  crowd_.maxSweeps = maxSweeps;
  crowd_.stiffness = stiffness;
  seen_ = {};
  look_ = 0;
  looking_ = true;
  crowd_.begin(request_, *bodies_, *contacts_);
}

void IslandSolver::sweepIfUnsettled()
{
  if (unsettled_ || system_ != &newton_ || accept_ != Accept::Any || this->asksForALook() ||
    newton_.isSettled(seen_.isDeep()))
  {
    return;
  }
  // Newton that has not settled may be anywhere; Gauss–Seidel comes nearer with every sweep, and a
  // lasting step makes no energy.
  for (IslandBody& body : *bodies_)
  {
    body.acceleration.setZero();
    body.spinAcceleration.setZero();
  }
  unsettled_ = true;
  iterations_ = newton_.iterations();
  this->sweep();
}

bool IslandSolver::asksForALook() const
{
  return looking_ && system_->isWorthALook() &&
    (seen_.asksFor(look_) || (look_ <= kMostMissLooks && system_->haveGoneOn()));
}

void IslandSolver::goOn(const LookOutcome& seen)
{
  seen_ = seen;
  system_->noteLook();
  looking_ = seen.any();
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
  this->sweepIfUnsettled();
}

IslandOutcome IslandSolver::finish()
{
  IslandOutcome outcome = system_->finish(accept_, seen_.isDeep());
  if (unsettled_)
  {
    outcome.iterations += iterations_;
    outcome.settled = false;
    outcome.unconverged = true;
  }
  return outcome;
}

} // namespace rockfall
