// A crowd's step: sweeps over its contacts until they have settled.

#include "solve/island/CrowdSolver.h"

#include "base/abort.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Bounces for one thread at a time.
constexpr std::size_t kBounceGrain = 32;

} // namespace

double CrowdSolver::visit(int strip)
{
  if (goingFurther_)
  {
    this->extrapolate(strip);
  }
  crowd::Pass pass;
  pass.backwards = sweep_ % 2 != 0;
  pass.movers = movers_.data();
  pass.changed = changed_.data();
  pass.number = sweep_;
  pass.quiet = quiet_;
  double most = 0.0;
  for (const bool slope : { pass.backwards, !pass.backwards })
  {
    const std::size_t key = std::size_t(strip * kKinds + (slope ? OnSlope : Pairs));
    pass.first = batches_.data() + starts_[key];
    pass.forces = forces_.data() + starts_[key];
    pass.count = used_[key] - starts_[key];
    pass.slope = slope;
    most = std::max(most, kernel_->sweep(pass));
  }
  return most;
}

double CrowdSolver::sweep()
{
  most_.assign(std::size_t(strips_) + 1, 0.0);
  this->forStrips(
    sweep_ % 2 != 0, [&](int strip) { most_[std::size_t(strip)] = this->visit(strip); });
  goingFurther_ = false;
  changed_.back() = kNever; // the slope of the last strip, where its contacts are among the others
  return *std::max_element(most_.begin(), most_.end());
}

bool CrowdSolver::sweepTo(double goal, int most, bool conjugate, IslandOutcome& outcome)
{
  bool reached = false, extended = false;
  for (int k = 0; k < most && !reached; ++k, ++sweep_)
  {
    if (conjugate && k > 0)
    {
      this->extrapolate();
    }
    stayWanted();
    ++outcome.iterations;
    outcome.residual = this->sweep();
    reached = outcome.residual <= goal;
    // Contacts that close in the end get some sweeps more, once.
    const bool last = reached || k + 1 == most;
    if ((last ? !extended : k % kSpeculativeEvery == 0) && this->closeSpeculative(sweep_ + 1))
    {
      reached = false;
      most = std::max(most, k + 1 + kAfterSpeculative);
      extended = last;
    }
  }
  return reached;
}

bool CrowdSolver::sweeps(int most, bool everywhere, IslandOutcome& outcome)
{
  const double noticed = kNoticed * scale_;
  const auto sweepAround = [&](double goal, double least, int count, bool conjugate)
  {
    quiet_ = std::max(kQuiet * enough_, least);
    if (conjugate)
    {
      this->begin();
    }
    return this->sweepTo(goal, count, conjugate, outcome);
  };
  // An island that goes on as one cannot be left alone here and there.
  bool settled = sweepAround(enough_, everywhere ? 0.0 : noticed, most, everywhere) && everywhere;
  if (outcome.residual > unconverged_)
  {
    // Most have settled by then: on around where it is rough.
    sweepAround(unconverged_, std::min(noticed, kUnconvergedNoticed * unconverged_),
      kUnconvergedSweeps * most, false);
    settled = false;
  }
  return settled;
}

bool CrowdSolver::holdBounces(std::vector<IslandContact>& contacts)
{
  const auto gives = [&](std::size_t b)
  {
    const std::size_t k = bouncing_[b];
    if (contacts[k].reboundSpeed <= 0.0)
    {
      return false; // held back to nothing before
    }
    const Row& row = rows_[k];
    const Vec3 force = this->forceOf(row);
    if (force[0] <= 0.0)
    {
      return false;
    }
    const auto [before, after] = this->velocities(row);
    const double held = heldBounce(contacts[k], h_, force, before, after);
    if (held >= 0.0)
    {
      contacts[k].reboundSpeed = held;
      this->askGap(contacts[k], row);
    }
    return held >= 0.0;
  };
  bool any = false;
  const auto goOn = [&](std::size_t b)
  {
    any = true;
    this->noteChange(contacts[bouncing_[b]]);
  };
  forThose(bouncing_.size(), kBounceGrain, gives_, gives, goOn);
  return any;
}

void CrowdSolver::settle(
  int most, bool everywhere, std::vector<IslandContact>& contacts, IslandOutcome& outcome)
{
  for (int k = 0; k < kHeldBounces && this->holdBounces(contacts); ++k)
  {
    outcome.settled = this->sweeps(most, everywhere, outcome);
    this->collect();
  }
}

void CrowdSolver::collect()
{
  const auto collectBody = [&](std::size_t i)
  {
    Work& w = work_[i];
    const crowd::Mover& m = movers_[w.mover];
    const Eigen::Map<const Vec3> spun(m.turn);
    this->goTo(w, Eigen::Map<const Vec3>(m.displacement));
    if (w.spun != spun)
    {
      w.moved = w.moved || !this->isNear(w.spun, spun);
      this->turnAs(w, w.spun = spun);
    }
  };
  forEach(work_.size(), kBodyGrain, collectBody);
}

void CrowdSolver::noteDetection()
{
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    seen_[i].displacement = work_[i].displacement;
    seen_[i].spun = work_[i].spun;
  }
}

bool CrowdSolver::needsRecheck() const
{
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    const Seen& seen = seen_[i];
    const double on = (work_[i].displacement - seen.displacement).cwiseAbs().maxCoeff() +
      seen.radius * (work_[i].spun - seen.spun).cwiseAbs().maxCoeff();
    if (on > kGoneOn * seen.radius)
    {
      return true;
    }
  }
  return false;
}

void CrowdSolver::begin(
  const StepRequest& request, std::vector<IslandBody>& bodies, std::vector<IslandContact>& contacts)
{
  request_ = request;
  bodies_ = &bodies;
  contacts_ = &contacts;
  outcome_ = {};
  kernel_ = &crowd::suitedKernel();
  this->prepareBodies(request, bodies);
  if (bodies.empty())
  {
    outcome_.settled = true;
    return;
  }
  this->lineUp(bodies);
  this->arrange(contacts);
  this->startMovers(bodies);
  this->prepareRows(bodies, contacts);
  // Displacements matter in relation to how far gravity and the rocks' speed move them in the step.
  scale_ = 0.5 * request.gravity * h_ * h_;
  double curvature = 0.0; // sum of 1/r: small rocks have a say
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    scale_ = std::max(scale_, work_[i].displacement.norm());
    curvature += 1.0 / seen_[i].radius;
  }
  calm_ = true;
  bouncing_.clear();
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    calm_ = calm_ && contacts[k].reboundSpeed < 0.0;
    if (contacts[k].reboundSpeed > 0.0)
    {
      bouncing_.push_back(k);
    }
  }
  enough_ = tolerance * scale_;
  unconverged_ =
    std::min(kUnconverged * enough_, kUnconvergedDisplacement * double(work_.size()) / curvature);
  sweep_ = checked_ = 0;
  sweepsAllowed_ = calm_ ? kCalmSweeps * maxSweeps : maxSweeps;
  this->sweepAndCorrect(true);
}

void CrowdSolver::sweepAndCorrect(bool everywhere)
{
  outcome_.settled = this->sweeps(sweepsAllowed_, everywhere, outcome_);
  if (this->correctTurns(*bodies_, *contacts_))
  {
    outcome_.settled = this->sweeps(sweepsAllowed_, calm_, outcome_);
  }
  this->collect();
  this->settle(sweepsAllowed_, calm_, *contacts_, outcome_);
}

void CrowdSolver::solve()
{
  this->sweepAndCorrect(calm_);
}

IslandOutcome CrowdSolver::finish(Accept accept, bool deep)
{
  if (work_.empty())
  {
    outcome_.accepted = true;
    return outcome_;
  }
  const bool finite = std::all_of(work_.begin(), work_.end(),
    [](const Work& w) { return w.displacement.allFinite() && w.spun.allFinite(); });
  const bool near = outcome_.settled || outcome_.residual <= unconverged_;
  outcome_.unconverged = !near || deep;
  const bool fair = accept == Accept::Converging ? !outcome_.unconverged : outcome_.settled;
  outcome_.accepted = finite && (fair || accept == Accept::Any);
  if (outcome_.accepted)
  {
    this->write();
  }
  return outcome_;
}

} // namespace rockfall
