// The rows of an island: their order, where they stand in the middle of the step, what they weigh.

#include "base/parallel.h"
#include "law/settings.h"
#include "solve/island/softSweep.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

/// Where a vector of a rock is after a small turn, to second order.
Vec3 turned(const Vec3& x, const Vec3& by)
{
  return x + by.cross(x) + 0.5 * by.cross(by.cross(x));
}

} // namespace

void SoftSolver::findStrips()
{
  strips_ = 1;
  const std::size_t count = movers_.size();
  stripOfBody_.assign(count, 0);
  if (count < 2 * std::size_t(kRocksOfStrip))
  {
    return;
  }
  Vec3 low = movers_.front().start, high = low;
  for (const Mover& m : movers_)
  {
    low = low.cwiseMin(m.start);
    high = high.cwiseMax(m.start);
  }
  int axis = 0;
  const double length = (high - low).maxCoeff(&axis);
  double width = length * kRocksOfStrip / double(count);
  for (const IslandContact& c : *contacts_)
  {
    width = c.second < 0 ? width
                         : std::max(width,
                             std::abs(movers_[std::size_t(c.first)].start[axis] -
                               movers_[std::size_t(c.second)].start[axis]));
  }
  strips_ = std::max(1, int(length / width));
  width = length / strips_;
  for (std::size_t i = 0; i < count; ++i)
  {
    stripOfBody_[i] = std::clamp(int((movers_[i].start[axis] - low[axis]) / width), 0, strips_ - 1);
  }
}

int SoftSolver::stripOf(const IslandContact& c) const
{
  const int first = stripOfBody_[std::size_t(c.first)];
  if (c.second < 0)
  {
    return first;
  }
  const int second = stripOfBody_[std::size_t(c.second)];
  return std::min(first, second);
}

void SoftSolver::arrange()
{
  const std::vector<IslandContact>& contacts = *contacts_;
  struct Key
  {
    int strip, slope, first, second;
    std::size_t contact;
    auto operator<=>(const Key&) const = default;
  };
  static thread_local std::vector<Key> keys;
  keys.resize(contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    const IslandContact& c = contacts[k];
    keys[k] = { this->stripOf(c), c.second < 0, c.first, c.second, k };
  }
  std::sort(keys.begin(), keys.end());
  rows_.resize(contacts.size());
  starts_.resize(contacts.size());
  results_.resize(contacts.size());
  rowOf_.resize(contacts.size());
  manifolds_.clear();
  firstOfStrip_.assign(std::size_t(strips_) + 1, 0);
  for (std::size_t k = 0; k < keys.size(); ++k)
  {
    const Key& now = keys[k];
    rowOf_[now.contact] = k;
    results_[k].contact = now.contact;
    const bool same = k > 0 && keys[k - 1].first == now.first && keys[k - 1].second == now.second;
    if (same)
    {
      manifolds_.back().end = k + 1;
    }
    else
    {
      manifolds_.push_back({ now.first, now.second, k, k + 1, 0, false, false });
      firstOfStrip_[std::size_t(now.strip) + 1] = manifolds_.size();
    }
  }
  for (std::size_t s = 1; s < firstOfStrip_.size(); ++s)
  {
    firstOfStrip_[s] = std::max(firstOfStrip_[s], firstOfStrip_[s - 1]);
  }
  forEach(rows_.size(), kRowGrain,
    [&](std::size_t k) { this->prepareRow(results_[k].contact, rows_[k], starts_[k]); });
  pivots_.resize(manifolds_.size());
  impactRounds_.resize(std::size_t(strips_));
  busyOf_.resize(std::size_t(strips_));
  stampOfStrip_.assign(std::size_t(strips_), -1);
  linked_ = false;
}

void SoftSolver::prepareRow(std::size_t k, ContactRow& row, ContactRowCold& start) const
{
  const IslandContact& asked = (*contacts_)[k];
  const Contact& c = *asked.contact;
  start.flipped = c.kind == ContactKind::FaceVertex && asked.second >= 0;
  row.a = start.flipped ? asked.second : asked.first;
  row.b = start.flipped ? asked.first : asked.second;
  const double half = 0.5 * duration_;
  const BlockState& stateA = *(*bodies_)[std::size_t(row.a)].state;
  const Vec3 spinA = stateA.angularVelocity();
  const Vec3 n = start.flipped ? Vec3(-c.normal) : c.normal;
  const Vec3 arm = c.point - stateA.position;
  const bool still = c.kind == ContactKind::FaceVertex && row.b < 0; // a node of the slope
  row.lever = still ? Vec3(arm - half * stateA.velocity) : turned(arm, half * spinA);
  Vec3 turning =
    row.b < 0 ? Vec3(Vec3::Zero()) : (*bodies_)[std::size_t(row.b)].state->angularVelocity();
  if (c.kind == ContactKind::EdgeEdge)
  {
    turning = 0.5 * (spinA + turning);
  }
  else if (still)
  {
    turning = spinA;
  }
  row.normal = turned(n, half * turning).normalized();
  start.gap0 = row.gap = asked.absent ? kAbsent : gap0_[k];
  const double radius = std::min(movers_[std::size_t(row.a)].block->radius(),
    movers_[std::size_t(row.b < 0 ? row.a : row.b)].block->radius());
  row.slide2 = kWeighedTurn * kWeighedTurn * radius * radius;
  row.friction = asked.friction;
  row.cohesion = h_ * asked.cohesion;
  row.resting = std::max(asked.resting, 2.0 * h_ * gravity_);
  start.spring = c.stiffness > 0.0 ? c.stiffness : stiffness.normalPenalty;
}

void SoftSolver::weigh(std::size_t k)
{
  ContactRow& row = rows_[k];
  double mobility = 0.0, across = 0.0;
  const auto add = [&](int i, const Vec3& lever)
  {
    const Motion& motion = motions_[std::size_t(i)];
    const Mat3& inverseInertia = movers_[std::size_t(i)].inverseInertia;
    const Vec3 moment = lever.cross(row.normal);
    mobility += motion.inverseMass + moment.dot(inverseInertia * moment);
    across += motion.inverseMass + this->mobility(i) * lever.squaredNorm();
  };
  add(row.a, row.lever);
  if (row.b >= 0)
  {
    add(row.b, row.leverB);
  }
  row.mass = 1.0 / mobility;
  row.shearMass = 1.0 / across;
  // Overlap beyond what the force explains goes no faster than sweeps can follow; what the force
  // explains is that of the spring, however light the rocks.
  const double spring = starts_[k].spring;
  const double frequency =
    std::min(h_ * std::sqrt(spring / row.mass), 2.0 * std::numbers::pi * kSoftFrequency);
  row.rate = frequency / (h_ * (2.0 * kSoftDamping + frequency));
  row.softness = row.mass * row.rate / (h_ * spring);
}

void SoftSolver::prepareImpulses(std::size_t k, const IslandContact& asked)
{
  const Contact& c = *asked.contact;
  ContactRow& row = rows_[k];
  ContactRowCold& start = starts_[k];
  row.P = 0.0;
  row.T.setZero();
  row.stops = row.loaded = false;
  start.before = 0.0;
  start.pending =
    c.closed() && !asked.absent && asked.reboundSpeed >= 0.0 ? asked.reboundSpeed : -1.0;
  if (c.closed() && start.pending < 0.0 && !asked.absent)
  {
    row.P = h_ * c.stiffness * std::max(0.0, -c.gap());
    row.T = (start.flipped ? h_ : -h_) * c.shearStiffness * c.slip;
    row.T -= row.normal * row.normal.dot(row.T);
    limitTo(row.T, row.friction * row.P + row.cohesion);
  }
}

} // namespace rockfall
