// The step of a group: open–close iteration as Newton with a direct solver, and what comes of it.

#include "system/GroupSolver.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Largest group that is solved directly.
constexpr std::size_t kDirect = 60;
/// How often missed contacts are looked for in a step.
constexpr int kLooks = 2;
/// Where nothing bounces forces are to be exact, and few contacts still change: so many times more
/// sweeps.
constexpr int kCalmSweeps = 25;
/// As in the step of a single rock.
constexpr double kGapTolerance = 1e-7;
/// The gyroscopic moment converges linearly: to this share of a turn it keeps angular momentum to
/// 1e-12.
constexpr double kTurnTolerance = 1e-9;

} // namespace

bool GroupSolver::newton(
  const StepRequest& request, const std::vector<GroupBody>& bodies, GroupOutcome& outcome)
{
  const bool lasting = request.kind == StepKind::Lasting;
  this->evaluate(request.duration, lasting);
  Eigen::VectorXd next;
  double share = 1.0; // of the correction that is taken
  for (int iteration = 0; iteration < request.maxOpenClose; ++iteration)
  {
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
      const double way = this->travel(row)[0];
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

GroupOutcome GroupSolver::step(const StepRequest& request, std::vector<GroupBody>& bodies,
  std::vector<GroupContact>& contacts, bool takeAnyway, const std::function<bool()>& lookAgain)
{
  const bool lasting = request.kind == StepKind::Lasting;
  const bool iterate =
    method == GroupMethod::Iterative || (method == GroupMethod::Suited && bodies.size() > kDirect);
  const auto sweep = [&]
  {
    sweeping_ = true;
    crowd_.tolerance = tolerance;
    crowd_.maxSweeps = maxSweeps;
    crowd_.maxCalmSweeps = kCalmSweeps * maxSweeps;
    return crowd_.step(request, bodies, contacts, takeAnyway, lookAgain);
  };
  if (iterate && lasting)
  {
    return sweep();
  }
  GroupOutcome outcome;
  sweeping_ = false;
  this->prepare(request, bodies, contacts);
  outcome.settled = this->newton(request, bodies, outcome);
  for (int look = 0; look < kLooks && outcome.settled && lookAgain && lookAgain(); ++look)
  {
    this->append(request, bodies, contacts);
    outcome.settled = this->newton(request, bodies, outcome);
  }
  if (!outcome.settled && takeAnyway)
  {
    // Newton that has not settled may be anywhere; Gauss–Seidel comes nearer with every sweep, and
    // a lasting step makes no energy.
    for (GroupBody& body : bodies)
    {
      body.acceleration.setZero();
      body.spinAcceleration.setZero();
    }
    const int iterations = outcome.iterations;
    outcome = sweep();
    outcome.iterations += iterations;
    outcome.settled = false;
    return outcome;
  }
  bool finite = true;
  for (const Work& w : work_)
  {
    finite = finite && w.d.allFinite();
  }
  if (finite && outcome.settled)
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
  const auto writeContact = [&](std::size_t k)
  {
    Row& row = rows_[k];
    const ContactLaw& law = row.law;
    Contact& c = *contacts[k].contact;
    const Vec3 way = this->travel(row);
    const Eigen::Vector2d travel = way.tail<2>();
    const double gap1 = row.gap0 + way[0];
    c.normalForce = law.force;
    c.shearForce = law.shearForce.norm();
    c.distance = gap1 + c.offset;
    const bool bounced = contacts[k].bounce >= 0.0;
    row.closed = !bounced && law.gap1 < 0.0;
    row.frictionWork = bounced ? -law.shearForce.dot(travel) : law.frictionWork(travel);
    row.dampedWork = bounced ? -law.force * (gap1 - row.gap0) : law.dampedWork();
    if (row.sides[1].body >= 0)
    {
      const Vec3 force = law.force * row.directions[0] + law.shearForce[0] * row.directions[1] +
        law.shearForce[1] * row.directions[2];
      for (int side = 0; side < 2; ++side)
      {
        const Vec6& d = work_[row.sides[side].body].d;
        const double sign = side == 0 ? 1.0 : -1.0;
        row.done[side] = sign * force.dot(d.head<3>() + d.tail<3>().cross(row.sides[side].lever));
      }
      contacts[k].work = -row.done[0] - row.done[1];
    }
    if (row.closed)
    {
      c.state = law.state == ContactState::Open ? ContactState::Sliding : law.state;
      c.slip = row.directions[1] * law.slip1[0] + row.directions[2] * law.slip1[1];
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
      c.point = w.position + w.d.head<3>() + w.turned * row.sides[carrier].place;
    }
  };
  forEach(contacts.size(), kRowGrain, writeContact);
  for (const Row& row : rows_)
  {
    GroupBody& first = bodies[row.sides[0].body];
    if (row.sides[1].body < 0)
    {
      first.frictionWork += row.frictionWork;
      first.dampedWork += row.dampedWork;
      if (row.closed)
      {
        first.normalEnergy += row.law.normalEnergy();
        first.springEnergy += row.law.normalEnergy() + row.law.shearEnergy();
      }
    }
    else
    {
      outcome.frictionWork += row.frictionWork;
      outcome.dampedWork += row.dampedWork;
      first.given -= row.done[0];
      bodies[row.sides[1].body].given -= row.done[1];
    }
  }
  const auto writeBody = [&](std::size_t i)
  {
    const Work& w = work_[i];
    BlockState& state = *bodies[i].state;
    const Vec6 velocity = rate_ * w.d + w.offset;
    state.time += request.duration;
    state.position += w.d.head<3>();
    state.velocity = velocity.head<3>();
    state.orientation = (w.turn * state.orientation).normalized();
    state.spin = w.rotation.transpose() * velocity.tail<3>();
  };
  forEach(bodies.size(), kBodyGrain, writeBody);
}

} // namespace rockfall
