#include "solve/island/softRows.h"

#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall::soft
{

namespace
{

/// Where a vector of a rock is after a small turn, to second order.
Vec3 turned(const Vec3& x, const Vec3& by)
{
  return x + by.cross(x) + 0.5 * by.cross(by.cross(x));
}

} // namespace

void Rows::findStrips()
{
  strips = 1;
  const std::size_t count = movers_.size();
  stripOfBody_.assign(count, 0);
  if (count < 2 * std::size_t(kRocksOfStrip))
  {
    return;
  }
  Vec3 low = movers_.all.front().start, high = low;
  for (const Mover& m : movers_.all)
  {
    low = low.cwiseMin(m.start);
    high = high.cwiseMax(m.start);
  }
  int axis = 0;
  const double length = (high - low).maxCoeff(&axis);
  double width = length * kRocksOfStrip / double(count);
  for (const IslandContact& c : *step_.contacts)
  {
    width = c.second < 0
      ? width
      : std::max(width, std::abs(movers_[c.first].start[axis] - movers_[c.second].start[axis]));
  }
  strips = std::max(1, int(length / width));
  width = length / strips;
  for (std::size_t i = 0; i < count; ++i)
  {
    stripOfBody_[i] =
      std::clamp(int((movers_.all[i].start[axis] - low[axis]) / width), 0, strips - 1);
  }
}

int Rows::stripOf(const IslandContact& c) const
{
  const int first = stripOfBody_[std::size_t(c.first)];
  if (c.second < 0)
  {
    return first;
  }
  const int second = stripOfBody_[std::size_t(c.second)];
  return std::min(first, second);
}

void Rows::arrange()
{
  const std::vector<IslandContact>& contacts = *step_.contacts;
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
  rows.resize(contacts.size());
  starts.resize(contacts.size());
  results.resize(contacts.size());
  rowOf.resize(contacts.size());
  manifolds.clear();
  firstOfStrip.assign(std::size_t(strips) + 1, 0);
  for (std::size_t k = 0; k < keys.size(); ++k)
  {
    const Key& now = keys[k];
    rowOf[now.contact] = k;
    results[k].contact = now.contact;
    const bool same = k > 0 && keys[k - 1].first == now.first && keys[k - 1].second == now.second;
    if (same)
    {
      manifolds.back().end = k + 1;
    }
    else
    {
      manifolds.push_back({ now.first, now.second, k, k + 1, 0, false, false });
      firstOfStrip[std::size_t(now.strip) + 1] = manifolds.size();
    }
  }
  for (std::size_t s = 1; s < firstOfStrip.size(); ++s)
  {
    firstOfStrip[s] = std::max(firstOfStrip[s], firstOfStrip[s - 1]);
  }
  forEach(rows.size(), kRowGrain,
    [&](std::size_t k) { this->prepare(results[k].contact, rows[k], starts[k]); });
}

void Rows::prepare(std::size_t k, ContactRow& row, ContactRowCold& start) const
{
  const IslandContact& asked = (*step_.contacts)[k];
  const Contact& c = *asked.contact;
  start.flipped = c.kind == ContactKind::FaceVertex && asked.second >= 0;
  row.a = start.flipped ? asked.second : asked.first;
  row.b = start.flipped ? asked.first : asked.second;
  const double half = 0.5 * step_.duration;
  const BlockState& stateA = *(*step_.bodies)[std::size_t(row.a)].state;
  const Vec3 spinA = stateA.angularVelocity();
  const Vec3 n = start.flipped ? Vec3(-c.normal) : c.normal;
  const Vec3 arm = c.point - stateA.position;
  const bool still = c.kind == ContactKind::FaceVertex && row.b < 0; // a node of the slope
  row.lever = still ? Vec3(arm - half * stateA.velocity) : turned(arm, half * spinA);
  Vec3 turning =
    row.b < 0 ? Vec3(Vec3::Zero()) : (*step_.bodies)[std::size_t(row.b)].state->angularVelocity();
  if (c.kind == ContactKind::EdgeEdge)
  {
    turning = 0.5 * (spinA + turning);
  }
  else if (still)
  {
    turning = spinA;
  }
  row.normal = turned(n, half * turning).normalized();
  start.gap0 = row.gap = asked.absent ? kAbsent : gap0[k];
  const double radius =
    std::min(movers_[row.a].block->radius(), movers_[row.b < 0 ? row.a : row.b].block->radius());
  row.slide2 = kWeighedTurn * kWeighedTurn * radius * radius;
  start.loose = kLooseOverlap * radius;
  row.friction = asked.friction;
  row.cohesion = step_.h * asked.cohesion;
  row.resting = std::max(asked.resting, 2.0 * step_.h * step_.gravity);
  start.spring = c.stiffness > 0.0 ? c.stiffness : step_.stiffness.normalPenalty;
}

void Rows::start()
{
  const auto start = [&](std::size_t k)
  {
    this->place(rows[k]);
    this->weigh(k);
    this->prepareImpulses(k, (*step_.contacts)[results[k].contact]);
    rows[k].idle = false;
    results[k] = { results[k].contact, Vec3::Zero(), 0.0, 0.0, 0.0, 0.0, 0.0, Vec3::Zero() };
  };
  forEach(rows.size(), kRowGrain, start);
  for (Manifold& manifold : manifolds)
  {
    manifold.busy = true;
    manifold.pivots = false;
  }
}

void Rows::weigh(std::size_t k)
{
  ContactRow& row = rows[k];
  double mobility = 0.0, across = 0.0;
  const auto add = [&](int i, const Vec3& lever)
  {
    const Motion& motion = movers_.motions[std::size_t(i)];
    const Mat3& inverseInertia = movers_[i].inverseInertia;
    const Vec3 moment = lever.cross(row.normal);
    mobility += motion.inverseMass + moment.dot(inverseInertia * moment);
    across += motion.inverseMass + movers_.mobility(i) * lever.squaredNorm();
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
  const double spring = starts[k].spring;
  const double frequency =
    std::min(step_.h * std::sqrt(spring / row.mass), 2.0 * std::numbers::pi * kSoftFrequency);
  row.rate = frequency / (step_.h * (2.0 * kSoftDamping + frequency));
  row.softness = row.mass * row.rate / (step_.h * spring);
}

void Rows::prepareImpulses(std::size_t k, const IslandContact& asked)
{
  const Contact& c = *asked.contact;
  ContactRow& row = rows[k];
  ContactRowCold& start = starts[k];
  row.P = 0.0;
  row.T.setZero();
  row.stops = row.loaded = row.pressed = false;
  start.before = 0.0;
  start.pending =
    c.closed() && !asked.absent && asked.reboundSpeed >= 0.0 ? asked.reboundSpeed : -1.0;
  if (c.closed() && start.pending < 0.0 && !asked.absent)
  {
    row.P = step_.h * c.stiffness * std::max(0.0, -c.gap());
    row.T = (start.flipped ? step_.h : -step_.h) * c.shearStiffness * c.slip;
    row.T -= row.normal * row.normal.dot(row.T);
    limitTo(row.T, row.friction * row.P + row.cohesion);
  }
}

double Rows::gapOfContact(std::size_t k) const
{
  const std::size_t row = rowOf[k];
  return this->gapOf(row) - starts[row].gap0 + gap0[k] - (*step_.contacts)[k].contact->offset;
}

} // namespace rockfall::soft
