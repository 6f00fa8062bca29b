// Open–close iteration of a group: Newton with a direct solver, or Gauss–Seidel over the contacts.

#include "system/GroupSolver.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Largest group whose matrix is dense, and largest one that is solved directly at all.
constexpr std::size_t kDense = 12;
constexpr std::size_t kDirect = 60;
/// As in the step of a single rock.
constexpr double kGapTolerance = 1e-7;
/// The gyroscopic moment converges linearly: to this share of a turn it keeps angular momentum to
/// 1e-12.
constexpr double kTurnTolerance = 1e-9;
/// Gauss–Seidel: how often levers and gyroscopic moments are brought up to date in a step.
constexpr int kLeverUpdates = 2;

} // namespace

bool GroupSolver::newton(const StepRequest& request, const std::vector<GroupBody>& bodies,
  bool dense, GroupOutcome& outcome)
{
  const bool lasting = request.kind == StepKind::Lasting;
  this->evaluate(request.duration, lasting);
  Eigen::VectorXd next;
  double share = 1.0; // of the correction that is taken
  for (int iteration = 0; iteration < request.maxOpenClose; ++iteration)
  {
    ++outcome.iterations;
    this->loads(request, bodies);
    if (!(dense ? this->solveDense(next) : this->solveSparse(next)))
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
    share = iteration > 1 && back < -0.25 * before ? std::max(0.5 * share, 0.125)
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
      const double way = this->along(row, 0);
      change = std::max(change, std::abs(row.law.gap0 + way - row.law.gap1));
      scale = std::max(scale, std::abs(way));
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

void GroupSolver::apply(const Row& row, const Vec3& change)
{
  for (const Side& side : row.sides)
  {
    if (side.body >= 0)
    {
      work_[side.body].d +=
        side.moved[0] * change[0] + side.moved[1] * change[1] + side.moved[2] * change[2];
    }
  }
}

double GroupSolver::sweep()
{
  double most = 0.0;
  for (Row& row : rows_)
  {
    const ContactLaw& law = row.law;
    const double w = row.w(0, 0);
    // The gap that the others leave, and the spring that closes it.
    const double open = law.gap0 + this->along(row, 0) - w * row.force[0];
    const double normal = open < 0.0 ? -law.penalty * open / (1.0 + law.penalty * w) : 0.0;
    Vec3 change(normal - row.force[0], 0.0, 0.0);
    if (normal > 0.0 || row.force[0] > 0.0)
    {
      this->apply(row, change);
      Eigen::Vector2d shear = Eigen::Vector2d::Zero();
      if (normal > 0.0)
      {
        // One step towards the locked spring, then back onto the Coulomb cone.
        const Eigen::Vector2d stretch =
          law.slip0 + Eigen::Vector2d(this->along(row, 1), this->along(row, 2));
        const double mobile = std::max(row.w(1, 1), row.w(2, 2)) + std::abs(row.w(1, 2));
        const double gain = law.shearPenalty / (1.0 + law.shearPenalty * mobile);
        shear = row.force.tail<2>() - gain * (stretch + row.force.tail<2>() / law.shearPenalty);
        const double limit = law.friction * normal + law.cohesion, length = shear.norm();
        shear *= length > limit ? limit / length : 1.0;
      }
      const Vec3 slide(0.0, shear[0] - row.force[1], shear[1] - row.force[2]);
      this->apply(row, slide);
      change += slide;
      row.force += change;
    }
    most = std::max({ most, std::abs(w * change[0]), std::abs(row.w(1, 1) * change[1]),
      std::abs(row.w(2, 2) * change[2]) });
  }
  return most;
}

bool GroupSolver::gaussSeidel(
  const StepRequest& request, const std::vector<GroupBody>& bodies, GroupOutcome& outcome)
{
  // Displacements matter in relation to how far gravity and the rocks' speed move them in the step.
  double scale = 0.5 * request.gravity * request.duration * request.duration;
  for (const Work& w : work_)
  {
    scale = std::max(scale, w.d.head<3>().norm());
  }
  const double enough = tolerance * scale;
  bool settled = false;
  for (int update = 0; update < kLeverUpdates; ++update)
  {
    if (update > 0)
    {
      this->levers();
      this->mobilities();
    }
    this->loads(request, bodies);
    for (Work& w : work_)
    {
      w.last = w.d;
      w.d = w.free;
    }
    for (const Row& row : rows_)
    {
      this->apply(row, row.force);
    }
    settled = false;
    for (int k = 0; k < maxSweeps && !settled; ++k)
    {
      ++outcome.iterations;
      outcome.residual = this->sweep();
      settled = outcome.residual <= enough;
    }
    double moved = 0.0;
    for (const Work& w : work_)
    {
      moved = std::max(moved, (w.d - w.last).norm());
    }
    if (update > 0 && moved <= 10.0 * enough)
    {
      break;
    }
  }
  // The forces that the rocks were moved with are the ones that are booked.
  this->evaluate(request.duration, true);
  for (Row& row : rows_)
  {
    row.law.force = row.force[0];
    row.law.shearForce = row.force.tail<2>();
  }
  return settled;
}

GroupOutcome GroupSolver::step(const StepRequest& request, std::vector<GroupBody>& bodies,
  std::vector<GroupContact>& contacts, bool takeAnyway)
{
  GroupOutcome outcome;
  this->prepare(request, bodies, contacts);
  const bool iterate =
    method == GroupMethod::Iterative || (method == GroupMethod::Suited && bodies.size() > kDirect);
  if (iterate && request.kind == StepKind::Lasting)
  {
    outcome.settled = this->gaussSeidel(request, bodies, outcome);
  }
  else
  {
    outcome.settled = this->newton(request, bodies, bodies.size() <= kDense, outcome);
  }
  bool finite = true;
  for (const Work& w : work_)
  {
    finite = finite && w.d.allFinite();
  }
  if (finite && (outcome.settled || takeAnyway))
  {
    this->write(request, bodies, contacts, outcome);
  }
  return outcome;
}

void GroupSolver::write(const StepRequest& request, std::vector<GroupBody>& bodies,
  std::vector<GroupContact>& contacts, GroupOutcome& outcome)
{
  for (GroupBody& body : bodies)
  {
    body.given = body.frictionWork = body.dampedWork = 0.0;
    body.springEnergy = body.normalEnergy = 0.0;
  }
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    const Row& row = rows_[k];
    const ContactLaw& law = row.law;
    Contact& c = *contacts[k].contact;
    const Eigen::Vector2d travel(this->along(row, 1), this->along(row, 2));
    const double gap1 = row.gap0 + this->along(row, 0);
    c.normalForce = law.force;
    c.shearForce = law.shearForce.norm();
    c.distance = gap1 + c.offset;
    const bool bounced = contacts[k].bounce >= 0.0;
    const bool closed = !bounced && law.gap1 < 0.0;
    GroupBody& first = bodies[row.sides[0].body];
    const double friction = bounced ? -law.shearForce.dot(travel) : law.frictionWork(travel);
    const double damped = bounced ? -law.force * (gap1 - row.gap0) : law.dampedWork();
    if (row.sides[1].body < 0)
    {
      first.frictionWork += friction;
      first.dampedWork += damped;
      if (closed)
      {
        first.normalEnergy += law.normalEnergy();
        first.springEnergy += law.normalEnergy() + law.shearEnergy();
      }
    }
    else
    {
      outcome.frictionWork += friction;
      outcome.dampedWork += damped;
      contacts[k].work = 0.0;
      for (const Side& side : row.sides)
      {
        const Vec6 force = law.force * side.row[0] + law.shearForce[0] * side.row[1] +
          law.shearForce[1] * side.row[2];
        const double done = force.dot(work_[side.body].d);
        bodies[side.body].given -= done;
        contacts[k].work -= done;
      }
    }
    if (closed)
    {
      c.state = law.state == ContactState::Open ? ContactState::Sliding : law.state;
      c.slip = row.tangent[0] * law.slip1[0] + row.tangent[1] * law.slip1[1];
    }
    else
    {
      c.state = ContactState::Open;
      c.slip.setZero();
    }
    // Where its rock has carried it: by this the next step knows it again.
    const int carrier = row.kind == ContactKind::FaceVertex ? 1 : 0;
    const int i = row.sides[carrier].body;
    if (i >= 0)
    {
      const Work& w = work_[i];
      c.point = w.position + w.rotation * (w.d.head<3>() + w.turned * row.place[carrier]);
    }
  }
  for (std::size_t i = 0; i < bodies.size(); ++i)
  {
    const Work& w = work_[i];
    BlockState& state = *bodies[i].state;
    const Vec6 velocity = rate_ * w.d + w.offset;
    state.time += request.duration;
    state.position += w.rotation * w.d.head<3>();
    state.velocity = w.rotation * velocity.head<3>();
    state.orientation = (state.orientation * w.turn).normalized();
    state.spin = velocity.tail<3>();
  }
}

} // namespace rockfall
