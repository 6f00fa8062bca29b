// The step of an island: open–close iteration as Newton with a direct solver, and what comes of it.

#include "system/NewtonSolver.h"

#include "base/abort.h"
#include "base/parallel.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

bool NewtonSolver::newton()
{
  this->evaluate();
  Eigen::VectorXd next;
  double share = 1.0; // of the correction that is taken
  for (int iteration = 0; iteration < request_.maxOpenClose; ++iteration)
  {
    stayWanted();
    ++outcome_.iterations;
    this->loads();
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
    const bool changed = this->evaluate();
    outcome_.residual = change;
    if (share == 1.0 && !changed && change <= kGapTolerance * scale + 1e-15 &&
      turned <= kTurnTolerance * turn + 1e-13)
    {
      return true;
    }
  }
  return false;
}

bool NewtonSolver::holdBounces()
{
  const double h = request_.duration;
  std::vector<IslandContact>& contacts = *contacts_;
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

void NewtonSolver::solve()
{
  outcome_.settled = this->newton();
  for (int k = 0; k < kHeldBounces && outcome_.settled && this->holdBounces(); ++k)
  {
    outcome_.settled = this->newton();
  }
}

IslandOutcome NewtonSolver::finish(Accept, bool deep)
{
  outcome_.settled = outcome_.settled && !deep;
  outcome_.unconverged = !outcome_.settled;
  const bool finite =
    std::all_of(work_.begin(), work_.end(), [](const Work& w) { return w.d.allFinite(); });
  if (finite && outcome_.settled)
  {
    this->write();
    outcome_.accepted = true;
  }
  return outcome_;
}

void NewtonSolver::write()
{
  std::vector<IslandBody>& bodies = *bodies_;
  std::vector<IslandContact>& contacts = *contacts_;
  books_.resize(contacts.size());
  const auto writeRow = [&](std::size_t k)
  {
    const Row& row = rows_[k];
    ContactMotion displacements;
    displacements.displacement = this->travel(row);
    for (int side = 0; side < 2; ++side)
    {
      const Side& of = row.sides[side];
      displacements.means[side] = of.body < 0 ? Vec3(Vec3::Zero()) : this->meanDisplacementOf(of);
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
  addBooks(contacts, books_, bodies, outcome_);
  const auto writeBody = [&](std::size_t i)
  {
    *bodies[i].state = this->end(i);
    bodies[i].state->time += request_.duration;
  };
  forEach(bodies.size(), kBodyGrain, writeBody);
}

} // namespace rockfall
