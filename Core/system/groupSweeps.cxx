// Open–close iteration of a large group: Gauss–Seidel over the contacts.

#include "system/GroupSolver.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace rockfall
{

namespace
{

/// Gauss–Seidel: how often levers and gyroscopic moments are brought up to date in a step.
constexpr int kLeverUpdates = 2;
/// … unless no rock has turned otherwise than guessed by more than this, rad: gaps are then right
/// to the square of it.
constexpr double kTurnGuessed = 0.02;
/// Where nothing bounces forces are to be exact, and few contacts still change: so many times more
/// sweeps.
constexpr int kCalmSweeps = 10;
/// Changes below this share of the tolerance are no reason to visit a contact again.
constexpr double kQuiet = 0.3;
/// Gauss–Seidel: rocks of a part of the group, and parts at most.
constexpr int kPart = 64;
constexpr int kMostParts = 64;

} // namespace

void GroupSolver::arrange()
{
  const int bodies = int(work_.size());
  parts_ = std::clamp(bodies / kPart, 1, kMostParts);
  order_.resize(rows_.size());
  partOf_.assign(work_.size(), 0);
  if (parts_ == 1)
  {
    std::iota(order_.begin(), order_.end(), 0);
    starts_ = { 0, rows_.size(), rows_.size() };
    return;
  }
  Vec3 low = work_.front().position, high = low;
  for (const Work& w : work_)
  {
    low = low.cwiseMin(w.position);
    high = high.cwiseMax(w.position);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  byPlace_.resize(work_.size());
  std::iota(byPlace_.begin(), byPlace_.end(), 0);
  std::sort(byPlace_.begin(), byPlace_.end(),
    [&](int a, int b)
    {
      const double x = work_[std::size_t(a)].position[axis];
      const double y = work_[std::size_t(b)].position[axis];
      return x != y ? x < y : a < b;
    });
  for (int k = 0; k < bodies; ++k)
  {
    partOf_[std::size_t(byPlace_[std::size_t(k)])] =
      int(std::int64_t(k) * std::int64_t(parts_) / std::int64_t(bodies));
  }
  const auto partOf = [&](const Row& row)
  {
    const int a = partOf_[std::size_t(row.sides[0].body)];
    const int b = row.sides[1].body < 0 ? a : partOf_[std::size_t(row.sides[1].body)];
    return std::abs(a - b) <= 1 ? std::min(a, b) : parts_;
  };
  starts_.assign(std::size_t(parts_) + 2, 0);
  for (const Row& row : rows_)
  {
    ++starts_[std::size_t(partOf(row)) + 1];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  std::vector<std::size_t>& next = nextInPart_;
  next.assign(starts_.begin(), starts_.end());
  for (std::size_t k = 0; k < rows_.size(); ++k)
  {
    order_[next[std::size_t(partOf(rows_[k]))]++] = int(k);
  }
}

void GroupSolver::gather()
{
  movers_.resize(work_.size() + std::size_t(parts_) + 1);
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    const Work& w = work_[i];
    movers_[i] = { w.free.head<3>(), w.free.tail<3>(), w.inverseMass, w.inverseInertia, 0 };
  }
  for (std::size_t i = work_.size(); i < movers_.size(); ++i)
  {
    movers_[i] = { Vec3::Zero(), Vec3::Zero(), 0.0, Mat3::Zero(), kNever };
  }
  points_.resize(rows_.size());
  pointOf_.resize(rows_.size());
  const auto gatherRow = [&](std::size_t k)
  {
    const std::size_t row = std::size_t(order_[k]);
    pointOf_[row] = int(k);
    this->gatherPoint(rows_[row], points_[k]);
  };
  forEach(points_.size(), kRowGrain, gatherRow);
  for (const Point& p : points_)
  {
    if (p.force[0] == 0.0)
    {
      continue;
    }
    const Vec3 force =
      p.force[0] * p.directions[0] + p.force[1] * p.directions[1] + p.force[2] * p.directions[2];
    for (int i = 0; i < 2; ++i)
    {
      Mover& m = movers_[p.body[i]];
      const double sign = i == 0 ? 1.0 : -1.0;
      m.way += (sign * m.inverseMass) * force;
      m.turn += sign * (m.inverseInertia * p.lever[i].cross(force));
    }
  }
}

void GroupSolver::gatherPoint(const Row& row, Point& p) const
{
  const int slope = int(work_.size());
  const ContactLaw& law = row.law;
  const Mat3 w = this->mobility(row);
  const Vec3 moved = w * row.directions[0];
  Eigen::Matrix2d across;
  for (int i = 0; i < 2; ++i)
  {
    // Contacts with the slope are in the part of their rock.
    p.body[i] =
      row.sides[i].body < 0 ? slope + partOf_[std::size_t(row.sides[0].body)] : row.sides[i].body;
    p.lever[i] = row.sides[i].lever;
    p.coupling[i] = row.directions[i + 1].dot(moved);
    p.slip[i] = law.slip0[i];
    for (int j = 0; j < 2; ++j)
    {
      across(i, j) = row.directions[i + 1].dot(w * row.directions[j + 1]);
    }
  }
  p.directions = row.directions;
  p.w = row.directions[0].dot(moved);
  p.gap = law.gap0;
  p.stiffness = law.penalty / (1.0 + law.penalty * p.w);
  const double mobile = std::max(across(0, 0), across(1, 1)) + std::abs(across(0, 1));
  p.shear = 1.0 / law.shearPenalty;
  p.gain = law.shearPenalty / (1.0 + law.shearPenalty * mobile);
  p.friction = law.friction;
  p.cohesion = law.cohesion;
  for (int i = 0; i < 3; ++i)
  {
    p.force[i] = row.force[i];
  }
}

double GroupSolver::relax(Point& p)
{
  Mover &a = movers_[p.body[0]], &b = movers_[p.body[1]];
  const Vec3 way = a.way - b.way + a.turn.cross(p.lever[0]) - b.turn.cross(p.lever[1]);
  const double* before = p.force;
  // The gap that the others leave, and the spring that closes it.
  const double open = p.gap + p.directions[0].dot(way) - p.w * before[0];
  const double normal = open < 0.0 ? -p.stiffness * open : 0.0;
  if (normal == 0.0 && before[0] == 0.0)
  {
    return 0.0;
  }
  const double push = normal - before[0];
  double s = 0.0, t = 0.0;
  if (normal > 0.0)
  {
    // One step towards the locked spring, then back onto the Coulomb cone.
    s = p.slip[0] + p.directions[1].dot(way) + p.coupling[0] * push;
    t = p.slip[1] + p.directions[2].dot(way) + p.coupling[1] * push;
    s = before[1] - p.gain * (s + before[1] * p.shear);
    t = before[2] - p.gain * (t + before[2] * p.shear);
    const double limit = p.friction * normal + p.cohesion, square = s * s + t * t;
    if (square > limit * limit)
    {
      const double back = limit / std::sqrt(square);
      s *= back;
      t *= back;
    }
  }
  const double slide[2] = { s - before[1], t - before[2] };
  const Vec3 change =
    push * p.directions[0] + slide[0] * p.directions[1] + slide[1] * p.directions[2];
  p.force[0] = normal;
  p.force[1] = s;
  p.force[2] = t;
  a.way += a.inverseMass * change;
  b.way -= b.inverseMass * change;
  a.turn += a.inverseInertia * p.lever[0].cross(change);
  b.turn -= b.inverseInertia * p.lever[1].cross(change);
  return p.w * (std::abs(push) + std::abs(slide[0]) + std::abs(slide[1]));
}

double GroupSolver::visit(int part, int number, double enough)
{
  double most = 0.0;
  const auto visitPoint = [&](Point& p)
  {
    Mover &a = movers_[p.body[0]], &b = movers_[p.body[1]];
    // Where nothing has changed since the last visit there is nothing to do.
    if (std::max(a.changed, b.changed) < number - 1)
    {
      return;
    }
    const double change = this->relax(p);
    if (change > kQuiet * enough)
    {
      a.changed = number;
      b.changed = b.inverseMass > 0.0 ? number : kNever; // the slope does not move
      most = std::max(most, change);
    }
  };
  const auto begin = points_.begin() + std::ptrdiff_t(starts_[std::size_t(part)]);
  const auto end = points_.begin() + std::ptrdiff_t(starts_[std::size_t(part) + 1]);
  if (number % 2 == 0)
  {
    std::for_each(begin, end, visitPoint);
  }
  else
  {
    std::for_each(std::make_reverse_iterator(end), std::make_reverse_iterator(begin), visitPoint);
  }
  return most;
}

double GroupSolver::sweep(int number, double enough)
{
  // Every second part, the others, and what reaches further; backwards in every second sweep.
  most_.assign(std::size_t(parts_) + 1, 0.0);
  const auto visitParts = [&](int first)
  {
    forEach(std::size_t(parts_ - first + 1) / 2, 1,
      [&](std::size_t k)
      {
        const int part = first + 2 * int(k);
        most_[std::size_t(part)] = this->visit(part, number, enough);
      });
  };
  const auto visitRest = [&] { most_.back() = this->visit(parts_, number, enough); };
  if (number % 2 == 0)
  {
    visitParts(0);
    visitParts(1);
    visitRest();
  }
  else
  {
    visitRest();
    visitParts(1);
    visitParts(0);
  }
  return *std::max_element(most_.begin(), most_.end());
}

bool GroupSolver::sweeps(int most, GroupOutcome& outcome)
{
  bool settled = false;
  for (int k = 0; k < most && !settled; ++k)
  {
    ++outcome.iterations;
    outcome.residual = this->sweep(sweep_++, enough_);
    settled = outcome.residual <= enough_;
  }
  return settled;
}

void GroupSolver::collect()
{
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    work_[i].d << movers_[i].way, movers_[i].turn;
  }
  for (std::size_t k = 0; k < rows_.size(); ++k)
  {
    rows_[std::size_t(order_[k])].force = Eigen::Map<const Vec3>(points_[k].force);
  }
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
  enough_ = tolerance * scale;
  const bool calm = std::none_of(
    rows_.begin(), rows_.end(), [](const Row& row) { return row.gap0 != row.law.gap0; });
  const int most = calm ? kCalmSweeps * maxSweeps : maxSweeps;
  bool settled = false;
  this->arrange();
  for (int update = 0; update < kLeverUpdates; ++update)
  {
    if (update > 0)
    {
      this->levers();
    }
    this->loads(request, bodies);
    this->gather();
    sweep_ = looked_ = 0;
    settled = this->sweeps(most, outcome);
    double turned = 0.0;
    for (std::size_t i = 0; i < work_.size(); ++i)
    {
      turned = std::max(turned, (movers_[i].turn - work_[i].d.tail<3>()).squaredNorm());
    }
    this->collect();
    if (turned <= kTurnGuessed * kTurnGuessed)
    {
      break;
    }
  }
  this->turn();
  sweeping_ = true;
  return settled;
}

bool GroupSolver::resume(GroupOutcome& outcome)
{
  looked_ = sweep_;
  for (std::size_t k = points_.size(); k < rows_.size(); ++k)
  {
    // With what reaches further than to the next part.
    order_.push_back(int(k));
    pointOf_.push_back(int(k));
    ++starts_.back();
    points_.emplace_back();
    this->gatherPoint(rows_[k], points_.back());
    for (const int body : points_.back().body)
    {
      movers_[std::size_t(body)].changed = sweep_;
    }
  }
  const bool settled = this->sweeps(maxSweeps, outcome);
  this->collect();
  this->turn();
  return settled;
}

void GroupSolver::finishSweeps(const StepRequest& request)
{
  // The forces that the rocks were moved with are the ones that are booked.
  this->evaluate(request.duration, true);
  for (Row& row : rows_)
  {
    row.law.force = row.force[0];
    row.law.shearForce = row.force.tail<2>();
  }
}

} // namespace rockfall
