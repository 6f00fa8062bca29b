// The step of an island: open–close iteration as Newton with a direct solver, and what comes of it.

#include "system/IslandSolver.h"

#include "base/abort.h"
#include "base/parallel.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

bool IslandSolver::newton(
  const StepRequest& request, const std::vector<IslandBody>& bodies, IslandOutcome& outcome)
{
  const bool lasting = request.kind == StepKind::Lasting;
  this->evaluate(request.duration, lasting);
  Eigen::VectorXd next;
  double share = 1.0; // of the correction that is taken
  for (int iteration = 0; iteration < request.maxOpenClose; ++iteration)
  {
    stayWanted();
    ++outcome.iterations;
    this->loads(request, bodies);
    if (!this->solveDirect(next))
    {
      return false;
    }
    // When the correction turns back, only part of it is taken: as in the step of a single rock.
    double back = 0.0, before = 0.0;
    for (std::size_t i = 0; i < work_.size(); ++i)
    {
      Work& w = work_[i];
      const Vec6 correction = next.segment<6>(6 * Eigen::Index(i)) - w.d;
      back += correction.dot(w.last);
      before += w.last.squaredNorm();
      w.last = correction;
    }
    share = iteration > 1 && back < -kTurnsBack * before ? std::max(0.5 * share, kLeastCorrection)
                                                         : std::min(1.0, 2.0 * share);
    double turned = 0.0, turn = 0.0;
    for (Work& w : work_)
    {
      w.d += share * w.last;
      turned = std::max(turned, w.last.tail<3>().norm());
      turn = std::max(turn, w.d.tail<3>().norm());
    }
    this->levers();
    double change = 0.0, scale = 0.0;
    for (const Row& row : rows_)
    {
      const double displacement = this->travel(row)[0];
      change = std::max(change, std::abs(row.law.gap0 + displacement - row.law.gap1));
      scale = std::max(scale, std::abs(displacement));
    }
    const bool changed = this->evaluate(request.duration, lasting);
    outcome.residual = change;
    if (share == 1.0 && !changed && change <= kGapTolerance * scale + 1e-15 &&
      turned <= kTurnTolerance * turn + 1e-13)
    {
      return true;
    }
  }
  return false;
}

bool IslandSolver::holdBounces(double h, std::vector<IslandContact>& contacts)
{
  bool any = false;
  for (std::size_t k = 0; k < rows_.size(); ++k)
  {
    Row& row = rows_[k];
    if (contacts[k].bounce <= 0.0 || row.law.force <= 0.0)
    {
      continue;
    }
    Vec3 before = Vec3::Zero(), after = Vec3::Zero();
    double sign = 1.0;
    for (const Side& side : row.sides)
    {
      if (side.body >= 0)
      {
        const Work& w = work_[side.body];
        const Vec6 velocity = rate_ * w.d + w.offset;
        before += sign * (w.velocity0.head<3>() + w.velocity0.tail<3>().cross(side.lever));
        after += sign * (velocity.head<3>() + velocity.tail<3>().cross(side.lever));
      }
      sign = -1.0;
    }
    Mat3 along;
    along << row.directions[0].transpose(), row.directions[1].transpose(),
      row.directions[2].transpose();
    const Vec3 force(row.law.force, row.law.shearForce[0], row.law.shearForce[1]);
    const double held = heldBounce(contacts[k], h, force, along * before, along * after);
    if (held >= 0.0)
    {
      const double n = row.directions[0].dot(this->mobility(row) * row.directions[0]);
      contacts[k].bounce = held;
      row.law.gap0 = bounceGap(contacts[k], h, row.law.penalty * n);
      any = true;
    }
  }
  return any;
}

bool IslandSolver::settle(const StepRequest& request, const std::vector<IslandBody>& bodies,
  std::vector<IslandContact>& contacts, IslandOutcome& outcome)
{
  bool settled = this->newton(request, bodies, outcome);
  for (int k = 0; k < kHeldBounces && settled && this->holdBounces(request.duration, contacts); ++k)
  {
    settled = this->newton(request, bodies, outcome);
  }
  return settled;
}

bool IslandSolver::isSwept(StepKind kind, std::size_t bodies) const
{
  return kind == StepKind::Lasting &&
    (method == IslandMethod::Iterative ||
      (method == IslandMethod::Suited && bodies > std::size_t(kDirectIsland)));
}

IslandOutcome IslandSolver::step(const StepRequest& request, std::vector<IslandBody>& bodies,
  std::vector<IslandContact>& contacts, Accept accept,
  const std::function<LookOutcome()>& lookAgain)
{
  const auto sweep = [&]
  {
    sweeping_ = true;
    crowd_.tolerance = tolerance;
    crowd_.maxSweeps = maxSweeps;
    return crowd_.step(request, bodies, contacts, accept, lookAgain);
  };
  if (this->isSwept(request.kind, bodies.size()))
  {
    return sweep();
  }
  IslandOutcome outcome;
  sweeping_ = false;
  this->prepare(request, bodies, contacts);
  outcome.settled = this->settle(request, bodies, contacts, outcome);
  LookOutcome seen;
  for (int look = 0; lookAgain && outcome.settled && seen.asksFor(look); ++look)
  {
    seen = lookAgain();
    if (!seen.any())
    {
      break;
    }
    this->append(request, bodies, contacts);
    if (seen.onlyTells(look))
    {
      break;
    }
    outcome.settled = this->settle(request, bodies, contacts, outcome);
  }
  outcome.settled = outcome.settled && !seen.isDeep();
  if (!outcome.settled && accept == Accept::Any)
  {
    // Newton that has not settled may be anywhere; Gauss–Seidel comes nearer with every sweep, and
    // a lasting step makes no energy.
    for (IslandBody& body : bodies)
    {
      body.acceleration.setZero();
      body.spinAcceleration.setZero();
    }
    const int iterations = outcome.iterations;
    outcome = sweep();
    outcome.iterations += iterations;
    outcome.settled = false;
    outcome.unconverged = true;
    return outcome;
  }
  bool finite = true;
  for (const Work& w : work_)
  {
    finite = finite && w.d.allFinite();
  }
  outcome.unconverged = !outcome.settled;
  if (finite && outcome.settled)
  {
    this->write(request, bodies, contacts, outcome);
    outcome.accepted = true;
  }
  return outcome;
}

void IslandSolver::write(const StepRequest& request, std::vector<IslandBody>& bodies,
  std::vector<IslandContact>& contacts, IslandOutcome& outcome)
{
  books_.resize(contacts.size());
  const auto writeRow = [&](std::size_t k)
  {
    const Row& row = rows_[k];
    ContactMotion displacements;
    displacements.displacement = this->travel(row);
    for (int side = 0; side < 2; ++side)
    {
      const Side& of = row.sides[side];
      displacements.means[side] =
        of.body < 0 ? Vec3(Vec3::Zero()) : this->meanDisplacementOf(request.duration, of);
    }
    books_[k] = writeContact(row.law, row.directions, displacements, row.gap0, contacts[k]);
    // Where its rock has carried it: by this the next step knows it again.
    const Side& carrier = row.sides[row.kind == ContactKind::FaceVertex ? 1 : 0];
    if (carrier.body >= 0)
    {
      const Work& w = work_[carrier.body];
      contacts[k].contact->point = w.position + w.d.head<3>() + w.turned * carrier.place;
    }
  };
  forEach(contacts.size(), kRowGrain, writeRow);
  addBooks(contacts, books_, bodies, outcome);
  const auto writeBody = [&](std::size_t i)
  {
    *bodies[i].state = this->end(bodies, i);
    bodies[i].state->time += request.duration;
  };
  forEach(bodies.size(), kBodyGrain, writeBody);
}

} // namespace rockfall
