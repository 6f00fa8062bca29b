#include "system/SoftSolver.h"

#include "base/parallel.h"
#include "block/FreeRotation.h"
#include "block/cayley.h"
#include "block/flight.h"
#include "law/settings.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>

namespace rockfall
{

namespace
{

/// Where a vector of a rock is after a small turn, to second order.
Vec3 turned(const Vec3& x, const Vec3& by)
{
  return x + by.cross(x) + 0.5 * by.cross(by.cross(x));
}

void limitTo(Vec3& T, double most)
{
  const double size2 = T.squaredNorm();
  if (size2 > most * most)
  {
    T *= most / std::sqrt(size2);
  }
}

} // namespace

template <class Visit>
void SoftSolver::forStrips(Visit&& visit) const
{
  for (const int first : { 0, 1 })
  {
    forEach(std::size_t(strips_ - first + 1) / 2, 1,
      [&](std::size_t k) { visit(std::size_t(first) + 2 * k); });
  }
}

template <class Visit>
void SoftSolver::forBusy(Visit&& visit)
{
  this->forStrips(
    [&](std::size_t strip)
    {
      const std::size_t from = firstOfStrip_[strip], to = firstOfStrip_[strip + 1];
      if (from == to)
      {
        return;
      }
      for (std::size_t k = manifolds_[from][0]; k < manifolds_[to - 1][1]; ++k)
      {
        if (!rows_[k].idle)
        {
          visit(rows_[k]);
        }
      }
    });
}

void SoftSolver::begin(
  const StepRequest& request, std::vector<IslandBody>& bodies, std::vector<IslandContact>& contacts)
{
  duration_ = request.duration;
  gravity_ = request.gravity;
  origin_ = bodies.front().state->position;
  bodies_ = &bodies;
  contacts_ = &contacts;
  substeps_ = request.substeps;
  h_ = duration_ / substeps_;
  movers_.resize(bodies.size());
  this->startMovers();
  for (Mover& m : movers_)
  {
    m.seenAt.setZero();
    m.seenTurn.setZero();
    m.moved = true;
  }
  gap0_.resize(contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    gap0_[k] = contacts[k].contact->distance;
  }
  this->findStrips();
  this->arrange();
  this->solve();
}

void SoftSolver::startMover(std::size_t i)
{
  const IslandBody& body = (*bodies_)[i];
  const Block& block = *body.block;
  Mover& m = movers_[i];
  m.block = &block;
  m.orientation = body.state->orientation;
  m.velocity = body.state->velocity;
  m.start = body.state->position - origin_;
  m.displacement.setZero();
  m.turn.setZero();
  m.inverseMass = 1.0 / block.mass();
  m.isotropic = block.isotropic();
  m.inverseMoment = block.inverseInertia()(0, 0);
  const Mat3 R = m.orientation.toRotationMatrix();
  m.spin = R * body.state->spin;
  m.momentum = R * (block.inertia() * body.state->spin);
  m.inverseInertia = m.isotropic ? Mat3(m.inverseMoment * Mat3::Identity())
                                 : Mat3(R * block.inverseInertia() * R.transpose());
  // The midpoint's turn is off by its cube over 24, and a needle's spin by as much times how much
  // easier it turns about itself.
  const double slender = block.inertia().trace() * block.inverseInertia().trace() / 9.0;
  m.smallTurn = std::cbrt(24.0 * kTurnExact / slender);
  m.weighedTurn = kWeighedTurn / std::sqrt(slender);
  m.turned = false;
  m.touched = false;
  m.flies = true;
  m.noise = 0.0;
}

void SoftSolver::startMovers()
{
  forEach(movers_.size(), kBodyGrain, [&](std::size_t i) { this->startMover(i); });
}

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

void SoftSolver::prepareRow(std::size_t k, Row& row) const
{
  const IslandContact& asked = (*contacts_)[k];
  const Contact& c = *asked.contact;
  row.flipped = c.kind == ContactKind::FaceVertex && asked.second >= 0;
  row.a = row.flipped ? asked.second : asked.first;
  row.b = row.flipped ? asked.first : asked.second;
  const double half = 0.5 * duration_;
  const BlockState& stateA = *(*bodies_)[std::size_t(row.a)].state;
  const Mover* b = row.b >= 0 ? &movers_[std::size_t(row.b)] : nullptr;
  const Vec3 spinA = stateA.angularVelocity();
  const Vec3 n = row.flipped ? Vec3(-c.normal) : c.normal;
  const Vec3 arm = c.point - stateA.position;
  const bool still = c.kind == ContactKind::FaceVertex && !b; // a node of the slope
  row.lever = still ? Vec3(arm - half * stateA.velocity) : turned(arm, half * spinA);
  Vec3 turning = b ? (*bodies_)[std::size_t(row.b)].state->angularVelocity() : Vec3(Vec3::Zero());
  if (c.kind == ContactKind::EdgeEdge)
  {
    turning = 0.5 * (spinA + turning);
  }
  else if (still)
  {
    turning = spinA;
  }
  row.normal = turned(n, half * turning).normalized();
  row.gap0 = row.gap = asked.absent ? kAbsent : gap0_[k];
  row.friction = asked.friction;
  row.cohesion = h_ * asked.cohesion;
  row.resting = std::max(asked.resting, 2.0 * h_ * gravity_);
  row.spring = c.stiffness > 0.0 ? c.stiffness : stiffness.normalPenalty;
}

void SoftSolver::weigh(Row& row) const
{
  double mobility = 0.0, across = 0.0;
  const auto add = [&](const Mover& m, const Vec3& lever)
  {
    const Vec3 moment = lever.cross(row.normal);
    mobility += m.inverseMass + moment.dot(m.inverseInertia * moment);
    across += m.inverseMass +
      (m.isotropic ? m.inverseMoment : m.inverseInertia.trace()) * lever.squaredNorm();
  };
  add(movers_[std::size_t(row.a)], row.lever);
  if (row.b >= 0)
  {
    add(movers_[std::size_t(row.b)], this->leverB(row));
  }
  row.mass = 1.0 / mobility;
  row.shearMass = 1.0 / across;
  // Overlap beyond what the force explains goes no faster than sweeps can follow; what the force
  // explains is that of the spring, however light the rocks.
  const double frequency =
    std::min(h_ * std::sqrt(row.spring / row.mass), 2.0 * std::numbers::pi * kSoftFrequency);
  row.rate = frequency / (h_ * (2.0 * kSoftDamping + frequency));
  row.softness = row.mass * row.rate / (h_ * row.spring);
}

void SoftSolver::weighAnew(Row& row) const
{
  const Mover& a = movers_[std::size_t(row.a)];
  const Mover* b = row.b < 0 ? nullptr : &movers_[std::size_t(row.b)];
  const double far = b ? kWeighedTurn * std::min(a.block->radius(), b->block->radius()) : 0.0;
  if (a.turned || (b && b->turned) ||
    (b && (a.displacement - b->displacement).squaredNorm() > far * far))
  {
    this->weigh(row);
  }
}

void SoftSolver::prepareImpulses(Row& row, const IslandContact& asked) const
{
  const Contact& c = *asked.contact;
  row.P = 0.0;
  row.T.setZero();
  row.speed.setZero();
  row.stops = false;
  row.speedA.setZero();
  row.generation = 0;
  row.before = 0.0;
  row.pending = c.closed() && !asked.absent && asked.bounce >= 0.0 ? asked.bounce : -1.0;
  if (c.closed() && row.pending < 0.0 && !asked.absent)
  {
    row.P = h_ * c.stiffness * std::max(0.0, -c.gap());
    row.T = (row.flipped ? h_ : -h_) * c.shearStiffness * c.slip;
    row.T -= row.normal * row.normal.dot(row.T);
    limitTo(row.T, row.friction * row.P + row.cohesion);
  }
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
      manifolds_.back()[1] = k + 1;
    }
    else
    {
      manifolds_.push_back({ k, k + 1 });
      firstOfStrip_[std::size_t(now.strip) + 1] = manifolds_.size();
    }
  }
  for (std::size_t s = 1; s < firstOfStrip_.size(); ++s)
  {
    firstOfStrip_[s] = std::max(firstOfStrip_[s], firstOfStrip_[s - 1]);
  }
  forEach(rows_.size(), kRowGrain,
    [&](std::size_t k) { this->prepareRow(results_[k].contact, rows_[k]); });
  struckOf_.resize(std::size_t(strips_));
  linked_ = false;
}

void SoftSolver::solve()
{
  this->startMovers();
  const auto start = [&](std::size_t k)
  {
    Row& row = rows_[k];
    this->weigh(row);
    this->prepareImpulses(row, (*contacts_)[results_[k].contact]);
    results_[k] = { results_[k].contact, Vec3::Zero(), 0.0, 0.0, 0.0, 0.0, 0.0, Vec3::Zero() };
  };
  forEach(rows_.size(), kRowGrain, start);
  for (int k = 0; k < substeps_; ++k)
  {
    this->substep(k);
  }
  substep_ = substeps_;
  this->forStrips([&](std::size_t strip) { this->arrive(strip, true); });
  const auto look = [&](std::size_t i)
  {
    Mover& m = movers_[i];
    const double near = kNoMotion * m.block->radius();
    m.moved = m.moved || (m.displacement - m.seenAt).cwiseAbs().maxCoeff() > near ||
      (m.turn - m.seenTurn).cwiseAbs().maxCoeff() > kNoMotion;
  };
  forEach(movers_.size(), kBodyGrain, look);
}

Vec3 SoftSolver::leverB(const Row& r) const
{
  const Mover &a = movers_[std::size_t(r.a)], &b = movers_[std::size_t(r.b)];
  return r.lever + ((a.start - b.start) + (a.displacement - b.displacement));
}

double SoftSolver::gapOf(const Row& r) const
{
  const Mover& a = movers_[std::size_t(r.a)];
  Vec3 motion = a.displacement + a.turn.cross(r.lever);
  if (r.b >= 0)
  {
    const Mover& b = movers_[std::size_t(r.b)];
    motion -= b.displacement + b.turn.cross(r.lever + (a.start - b.start));
  }
  return r.gap0 + r.normal.dot(motion);
}

Vec3 SoftSolver::speedOfA(const Row& r) const
{
  const Mover& a = movers_[std::size_t(r.a)];
  return a.velocity + a.spin.cross(r.lever);
}

Vec3 SoftSolver::speedOf(const Row& r) const
{
  const Mover& a = movers_[std::size_t(r.a)];
  Vec3 u = a.velocity + a.spin.cross(r.lever);
  if (r.b >= 0)
  {
    const Mover& b = movers_[std::size_t(r.b)];
    u -= b.velocity + b.spin.cross(this->leverB(r));
  }
  return u;
}

void SoftSolver::push(Mover& m, const Vec3& J, const Vec3& lever)
{
  m.touched = true;
  m.flies = false;
  m.velocity += m.inverseMass * J;
  const Vec3 moment = lever.cross(J);
  if (m.isotropic)
  {
    m.spin += m.inverseMoment * moment;
  }
  else
  {
    m.momentum += moment;
    m.spin += m.inverseInertia * moment;
  }
}

void SoftSolver::push(const Row& r, const Vec3& J)
{
  if (r.b >= 0)
  {
    const Vec3 lever = this->leverB(r);
    push(movers_[std::size_t(r.b)], -J, lever);
  }
  push(movers_[std::size_t(r.a)], J, r.lever);
}

void SoftSolver::turn(Mover& m, double h)
{
  if (m.isotropic)
  {
    const Vec3 by = h * m.spin;
    m.orientation = cayley(by) * m.orientation;
    m.turn += by;
    return;
  }
  Vec3 by;
  if (h * h * m.spin.squaredNorm() < m.smallTurn * m.smallTurn)
  {
    const Quat half = cayley(0.5 * h * m.spin) * m.orientation;
    const Mat3 R = half.toRotationMatrix();
    by = h * (R * (m.block->inverseInertia() * (R.transpose() * m.momentum)));
    m.orientation = (cayley(by) * m.orientation).normalized();
  }
  else
  {
    const Quat from = m.orientation;
    const Vec3 spin = from.conjugate() * m.spin;
    m.orientation = (from * FreeRotation(*m.block, spin).after(h).turn).normalized();
    const Eigen::AngleAxisd turned(m.orientation * from.conjugate());
    by = turned.angle() * turned.axis();
  }
  const Mat3 now = m.orientation.toRotationMatrix();
  m.inverseInertia = now * m.block->inverseInertia() * now.transpose();
  m.spin = m.inverseInertia * m.momentum;
  m.turn += by;
  m.turned = m.turned || m.turn.squaredNorm() > m.weighedTurn * m.weighedTurn;
}

/// An impulse over a substep does its work along the mean of the velocities before and after.
void SoftSolver::book(const Row& r, Result& result, const Vec3& speed, const Vec3& speedA) const
{
  const double along = r.P;
  if (along == 0.0 || substep_ == 0)
  {
    return;
  }
  const Vec3 mean = 0.5 * (r.speed + speed), across = r.T;
  result.normalWork += along * r.normal.dot(mean);
  result.frictionWork -= across.dot(mean);
  const Vec3 impulse = along * r.normal + across;
  result.workOnA += 0.5 * impulse.dot(r.speedA + speedA);
  result.impulse += impulse;
}

void SoftSolver::arrive(std::size_t strip, bool last)
{
  std::vector<std::size_t>& struck = struckOf_[strip];
  struck.clear();
  for (std::size_t m = firstOfStrip_[strip]; m < firstOfStrip_[strip + 1]; ++m)
  {
    bool any = false;
    for (std::size_t k = manifolds_[m][0]; k < manifolds_[m][1]; ++k)
    {
      Row& r = rows_[k];
      const Vec3 speed = this->speedOf(r);
      const Vec3 speedA = this->speedOfA(r);
      this->book(r, results_[k], speed, speedA);
      r.speedA = speedA;
      r.gap = this->gapOf(r);
      r.speed = speed;
      r.before = speed.dot(r.normal);
      r.generation = 0;
      r.idle = r.P == 0.0 && r.gap + 2.0 * h_ * std::min(r.before, -r.resting) > 0.0;
      if (!r.idle)
      {
        this->weighAnew(r);
      }
      any = any || this->closes(r, 1.0);
    }
    if (any && !last)
    {
      this->strike(m, struck);
    }
  }
}

bool SoftSolver::closes(const Row& r, double substeps) const
{
  const double noise =
    std::max(movers_[std::size_t(r.a)].noise, r.b >= 0 ? movers_[std::size_t(r.b)].noise : 0.0);
  return r.pending >= 0.0 ||
    (-r.before > std::max(r.resting, noise) && r.gap + substeps * h_ * r.before < 0.0);
}

void SoftSolver::strike(std::size_t manifold, std::vector<std::size_t>& struck)
{
  for (std::size_t k = manifolds_[manifold][0]; k < manifolds_[manifold][1]; ++k)
  {
    const Row& r = rows_[k];
    if (this->closes(r, kSharedImpact))
    {
      struck.push_back(k);
    }
  }
}

bool SoftSolver::strikes(std::size_t manifold)
{
  bool any = false;
  for (std::size_t k = manifolds_[manifold][0]; k < manifolds_[manifold][1]; ++k)
  {
    Row& r = rows_[k];
    r.before = this->speedOf(r).dot(r.normal);
    r.gap = this->gapOf(r);
    any = any || this->closes(r, 1.0);
  }
  return any;
}

void SoftSolver::link()
{
  firstOf_.assign(movers_.size() + 2, 0);
  const auto forEnds = [&](std::size_t shift, auto&& visit)
  {
    for (std::size_t m = 0; m < manifolds_.size(); ++m)
    {
      const Row& r = rows_[manifolds_[m][0]];
      visit(std::size_t(r.a) + shift, m);
      if (r.b >= 0)
      {
        visit(std::size_t(r.b) + shift, m);
      }
    }
  };
  forEnds(2, [&](std::size_t i, std::size_t) { ++firstOf_[i]; });
  for (std::size_t i = 2; i < firstOf_.size(); ++i)
  {
    firstOf_[i] += firstOf_[i - 1];
  }
  manifoldsOf_.resize(firstOf_.back());
  forEnds(1, [&](std::size_t i, std::size_t m) { manifoldsOf_[firstOf_[i]++] = m; });
  linked_ = true;
}

double SoftSolver::leaves(const Row& r) const
{
  if (r.pending >= 0.0)
  {
    return r.pending;
  }
  const IslandContact& c = (*contacts_)[results_[std::size_t(&r - rows_.data())].contact];
  return -r.before * c.restitutionAt(-r.before);
}

void SoftSolver::strikeGenerations(double time)
{
  int tick = 0;
  stamp_.assign(movers_.size(), -1);
  struct Of
  {
    double Q;
    Vec3 S, before, beforeA;
    double leaves;
  };
  static thread_local std::vector<Of> of;
  for (int generation = 0; generation < kGenerations && !struck_.empty(); ++generation)
  {
    const int begun = tick;
    double work = 0.0, stored = 0.0;
    moving_.clear();
    of.resize(struck_.size());
    for (std::size_t j = 0; j < struck_.size(); ++j)
    {
      const Row& r = rows_[struck_[j]];
      of[j] = { 0.0, Vec3::Zero(), this->speedOf(r), this->speedOfA(r), this->leaves(r) };
      // Springs of impacts that were under way give what they hold.
      stored +=
        r.pending >= 0.0 ? (*contacts_)[results_[struck_[j]].contact].contact->springEnergy() : 0.0;
    }
    const auto noteMove = [&](int i)
    {
      if (i >= 0)
      {
        int& stamp = stamp_[std::size_t(i)];
        if (stamp < begun)
        {
          moving_.push_back(i);
        }
        stamp = tick;
      }
    };
    for (int pass = 0; pass < kImpactSweeps; ++pass, ++tick)
    {
      bool any = false;
      for (std::size_t j = 0; j < struck_.size(); ++j)
      {
        Row& r = rows_[struck_[j]];
        if (pass > 0 && stamp_[std::size_t(r.a)] < tick - 1 &&
          (r.b < 0 || stamp_[std::size_t(r.b)] < tick - 1))
        {
          continue;
        }
        Of& o = of[j];
        const Vec3 u = this->speedOf(r);
        const double v = u.dot(r.normal);
        const double Q = std::max(0.0, o.Q - r.mass * (v - o.leaves)), dQ = Q - o.Q;
        Vec3 S = o.S - r.shearMass * (u - v * r.normal);
        limitTo(S, r.friction * Q);
        const Vec3 dS = S - o.S;
        o.Q = Q;
        o.S = S;
        const double size = std::abs(dQ) + dS.norm();
        if (size == 0.0)
        {
          continue;
        }
        this->push(r, dQ * r.normal + dS);
        if (size > r.mass * std::max(kImpactExact * std::abs(r.before), kImpactQuiet * r.resting))
        {
          noteMove(r.a);
          noteMove(r.b);
          any = true;
        }
      }
      if (!any)
      {
        break;
      }
    }
    double along = 0.0;
    for (std::size_t j = 0; j < struck_.size(); ++j)
    {
      const Row& r = rows_[struck_[j]];
      const Vec3 J = of[j].Q * r.normal + of[j].S;
      along += J.dot(of[j].before);
      work += 0.5 * J.dot(of[j].before + this->speedOf(r));
    }
    double share = 1.0;
    if (work > stored)
    {
      // No more than was there: all impulses of the generation by one factor. The work of a share
      // s is along s + (work − along) s².
      const double square = work - along;
      share = std::clamp(
        (-along + std::sqrt(std::max(0.0, along * along + 4.0 * square * stored))) / (2.0 * square),
        0.0, 1.0);
    }
    for (std::size_t j = 0; j < struck_.size(); ++j)
    {
      const std::size_t k = struck_[j];
      Row& r = rows_[k];
      const Vec3 J = of[j].Q * r.normal + of[j].S;
      if (share < 1.0 && of[j].Q > 0.0)
      {
        this->push(r, (share - 1.0) * J);
      }
    }
    for (std::size_t j = 0; j < struck_.size(); ++j)
    {
      const std::size_t k = struck_[j];
      Row& r = rows_[k];
      if (of[j].Q > 0.0 && r.pending < 0.0 && -r.before > results_[k].struck)
      {
        const Mover& a = movers_[std::size_t(r.a)];
        results_[k].struck = -r.before;
        results_[k].struckAt = time;
        results_[k].struckPoint = a.start + a.displacement + r.lever;
      }
      r.pending = -1.0;
      for (const int i : { r.a, r.b })
      {
        if (i >= 0)
        {
          double& noise = movers_[std::size_t(i)].noise;
          noise = std::max(noise, 2.0 * kImpactExact * std::abs(r.before));
        }
      }
    }
    for (std::size_t j = 0; j < struck_.size(); ++j)
    {
      const Row& r = rows_[struck_[j]];
      Result& result = results_[struck_[j]];
      const Vec3 across = share * of[j].S, mean = 0.5 * (of[j].before + this->speedOf(r));
      const Vec3 impulse = share * of[j].Q * r.normal + across;
      result.normalWork += share * of[j].Q * r.normal.dot(mean);
      result.frictionWork -= across.dot(mean);
      result.workOnA += 0.5 * impulse.dot(of[j].beforeA + this->speedOfA(r));
      result.impulse += impulse;
    }
    tick += 2;
    struck_.clear();
    if (generation + 1 == kGenerations)
    {
      break;
    }
    if (!linked_)
    {
      this->link();
    }
    for (const int i : moving_)
    {
      for (std::size_t j = firstOf_[std::size_t(i)]; j < firstOf_[std::size_t(i) + 1]; ++j)
      {
        const std::size_t m = manifoldsOf_[j];
        Row& r = rows_[manifolds_[m][0]];
        if (r.generation != generation + 1)
        {
          r.generation = generation + 1;
          for (std::size_t k = manifolds_[m][0]; k < manifolds_[m][1]; ++k)
          {
            if (rows_[k].idle)
            {
              rows_[k].idle = false;
              this->weighAnew(rows_[k]);
            }
          }
          if (this->strikes(m))
          {
            this->strike(m, struck_);
          }
        }
      }
    }
    std::sort(struck_.begin(), struck_.end());
  }
}

void SoftSolver::warm(Row& r)
{
  if (r.stops)
  {
    r.P = 0.0;
    r.stops = false;
  }
  if (r.P > 0.0)
  {
    this->push(r, r.P * r.normal + r.T);
  }
  else
  {
    r.T.setZero();
  }
}

bool SoftSolver::press(Row& r)
{
  const double v = this->speedOf(r).dot(r.normal);
  r.stops = r.stops || v < -r.resting;
  double change = 0.0;
  if (r.gap > 0.0)
  {
    change = -r.mass * (v + r.gap / h_);
  }
  else
  {
    const double back = std::max(r.rate * r.gap, -(r.b >= 0 ? kOverlapGoes : kOverlapGoesOnSlope));
    change = -(r.mass * (v + back) + r.softness * r.P) / (1.0 + r.softness);
  }
  const double P = std::max(0.0, r.P + change), dP = P - r.P;
  r.P = P;
  if (dP != 0.0)
  {
    this->push(r, dP * r.normal);
  }
  return std::abs(dP) > r.mass * r.resting;
}

bool SoftSolver::relax(Row& r)
{
  if (r.P == 0.0)
  {
    return false;
  }
  const Vec3 u = this->speedOf(r);
  const double v = u.dot(r.normal), P = std::max(0.0, r.P - r.mass * v), dP = P - r.P;
  Vec3 T = r.T - r.shearMass * (u - v * r.normal);
  T -= T.dot(r.normal) * r.normal;
  limitTo(T, r.friction * P + std::min(r.cohesion, 20.0 * P));
  const Vec3 dT = T - r.T;
  r.P = P;
  r.T = T;
  this->push(r, dP * r.normal + dT);
  return std::abs(dP) > r.mass * r.resting;
}

template <class Sweep>
void SoftSolver::sweep(int least, Sweep&& row)
{
  bool again = true;
  for (int sweep = 0; sweep < least || (again && sweep < kMostSweeps); ++sweep)
  {
    std::atomic<bool> any = false;
    this->forBusy(
      [&](Row& r)
      {
        if (row(r))
        {
          any.store(true, std::memory_order_relaxed);
        }
      });
    again = any;
  }
}

void SoftSolver::substep(int k)
{
  const Vec3 gravity(0.0, 0.0, -gravity_);
  substep_ = k;
  this->forStrips([&](std::size_t strip) { this->arrive(strip, false); });
  struck_.clear();
  for (const std::vector<std::size_t>& struck : struckOf_)
  {
    struck_.insert(struck_.end(), struck.begin(), struck.end());
  }
  if (!struck_.empty())
  {
    this->strikeGenerations(k * h_);
    const auto speeds = [&](std::size_t row)
    {
      rows_[row].speed = this->speedOf(rows_[row]);
      rows_[row].speedA = this->speedOfA(rows_[row]);
    };
    forEach(rows_.size(), kRowGrain, speeds);
  }
  const auto fall = [&](std::size_t i)
  {
    movers_[i].velocity += h_ * gravity;
    movers_[i].touched = false;
  };
  forEach(movers_.size(), kBodyGrain, fall);
  this->forBusy([&](Row& r) { this->warm(r); });
  this->sweep(1, [&](Row& r) { return this->press(r); });
  const auto move = [&](std::size_t i)
  {
    Mover& m = movers_[i];
    // What nothing touches falls on its parabola.
    m.displacement += h_ * m.velocity;
    if (!m.touched)
    {
      m.displacement -= 0.5 * h_ * h_ * gravity;
    }
    turn(m, h_);
  };
  forEach(movers_.size(), kBodyGrain, move);
  this->forBusy([&](Row& r) { this->weighAnew(r); });
  this->sweep(kRelaxSweeps, [&](Row& r) { return this->relax(r); });
}

void SoftSolver::append()
{
  const std::vector<IslandContact>& contacts = *contacts_;
  const std::size_t known = gap0_.size();
  gap0_.resize(contacts.size(), 0.0);
  for (std::size_t k = known; k < contacts.size(); ++k)
  {
    // The gap at the start from which this motion leads to the one at the end.
    Row row;
    this->prepareRow(k, row);
    row.gap0 = 0.0;
    Contact& c = *contacts[k].contact;
    c.distance -= this->gapOf(row);
    c.offset = std::min(0.0, c.distance);
    gap0_[k] = c.distance;
  }
  this->arrange();
}

void SoftSolver::noteLook()
{
  for (Mover& m : movers_)
  {
    m.seenAt = m.displacement;
    m.seenTurn = m.turn;
    m.moved = false;
  }
}

BlockState SoftSolver::end(std::size_t i) const
{
  const Mover& m = movers_[i];
  BlockState state = *(*bodies_)[i].state;
  if (m.flies)
  {
    const double time = state.time;
    state = fly(*m.block, state, gravity_, duration_);
    state.time = time;
    return state;
  }
  state.position += m.displacement;
  state.velocity = m.velocity;
  state.orientation = m.orientation.normalized();
  state.spin = state.orientation.conjugate() * m.spin;
  return state;
}

double SoftSolver::gap(std::size_t k) const
{
  const Row& r = rows_[rowOf_[k]];
  return this->gapOf(r) - r.gap0 + gap0_[k] - (*contacts_)[k].contact->offset;
}

double SoftSolver::force(std::size_t k) const
{
  const std::size_t row = rowOf_[k];
  return std::max(0.0, results_[row].impulse.dot(rows_[row].normal)) / duration_;
}

bool SoftSolver::setGap(std::size_t k, double found)
{
  const double change = gapChange(gap0_[k], this->gap(k), found);
  const IslandContact& asked = (*contacts_)[k];
  if (std::abs(change) <= kNoMotion * (*bodies_)[std::size_t(asked.first)].block->radius())
  {
    return false;
  }
  gap0_[k] += change;
  rows_[rowOf_[k]].gap0 += change;
  return true;
}

void SoftSolver::setAbsent(std::size_t k)
{
  rows_[rowOf_[k]].gap0 = (*contacts_)[k].absent ? kAbsent : gap0_[k];
}

IslandOutcome SoftSolver::finish(Accept accept, bool deep)
{
  IslandOutcome outcome;
  for (std::size_t k = 0; k < rows_.size() && !deep; ++k)
  {
    const Row& r = rows_[k];
    const double a = movers_[std::size_t(r.a)].block->radius();
    const double radius = r.b < 0 ? a : std::min(a, movers_[std::size_t(r.b)].block->radius());
    deep = this->gapOf(r) < std::min(0.0, r.gap0) - kDeepStep * radius;
  }
  outcome.settled = !deep;
  outcome.unconverged = deep;
  outcome.iterations = substeps_;
  outcome.accepted = !deep || accept == Accept::Any;
  if (outcome.accepted)
  {
    this->write(outcome);
  }
  return outcome;
}

void SoftSolver::writeContact(const Row& r, const Result& result)
{
  IslandContact& asked = (*contacts_)[result.contact];
  std::vector<IslandBody>& bodies = *bodies_;
  Contact& c = *asked.contact;
  const double gap = this->gap(result.contact) + c.offset;
  const int carrier = c.kind == ContactKind::FaceVertex ? asked.second : asked.first;
  if (carrier >= 0)
  {
    const Mover& m = movers_[std::size_t(carrier)];
    const BlockState& state = *bodies[std::size_t(carrier)].state;
    const Vec3 arm = state.orientation.conjugate() * (c.point - state.position);
    c.point = state.position + m.displacement + m.orientation * arm;
  }
  asked.opening = gap - c.distance;
  asked.struck = result.struck;
  asked.struckAt = result.struckAt;
  asked.struckPoint = origin_ + result.struckPoint;
  c.distance = gap;
  const double along = result.impulse.dot(r.normal);
  c.normalForce = std::max(0.0, along) / duration_;
  c.shearForce = (result.impulse - along * r.normal).norm() / duration_;
  asked.work = asked.second >= 0 ? result.frictionWork - result.normalWork : 0.0;
  if (r.P > 0.0 && !r.stops)
  {
    if (c.stiffness <= 0.0 || asked.bare)
    {
      const IslandBody& first = bodies[std::size_t(asked.first)];
      const IslandBody* second = asked.second < 0 ? nullptr : &bodies[std::size_t(asked.second)];
      PairSprings(stiffness, asked.damping, *first.block, *first.state,
        second ? second->block : nullptr, second ? second->state : nullptr)
        .set(c);
    }
    const double limit = r.friction * r.P + std::min(r.cohesion, 20.0 * r.P);
    c.state = r.T.norm() < (1.0 - 1e-9) * limit ? ContactState::Locked : ContactState::Sliding;
    // Springs that carry what it carries.
    c.offset = c.distance + r.P / (h_ * c.stiffness);
    c.slip = (r.flipped ? 1.0 : -1.0) / (h_ * c.shearStiffness) * r.T;
  }
  else
  {
    c.state = ContactState::Open;
    c.slip.setZero();
    c.offset = std::min(0.0, c.distance);
  }
}

void SoftSolver::bookContacts(IslandOutcome& outcome)
{
  for (std::size_t k = 0; k < rows_.size(); ++k)
  {
    const Row& r = rows_[k];
    const Result& result = results_[k];
    const IslandContact& asked = (*contacts_)[result.contact];
    const double size = result.impulse.norm(), work = result.normalWork - result.frictionWork;
    for (const int i : { r.a, r.b })
    {
      if (i >= 0 && size > books_[std::size_t(i)].strongest)
      {
        books_[std::size_t(i)].strongest = size;
        books_[std::size_t(i)].by = k;
      }
    }
    if (asked.second >= 0)
    {
      books_[std::size_t(r.a)].rocks += result.workOnA;
      books_[std::size_t(r.b)].rocks += work - result.workOnA;
      outcome.frictionWork += result.frictionWork;
      outcome.dampedWork -= result.normalWork;
      continue;
    }
    const Contact& c = *asked.contact;
    IslandBody& body = (*bodies_)[std::size_t(r.a)];
    const double energy = c.springEnergy();
    books_[std::size_t(r.a)].slope += work;
    body.frictionWork += result.frictionWork;
    body.springEnergy += energy;
    body.normalEnergy +=
      energy - (c.closed() ? 0.5 * c.shearStiffness * c.slip.squaredNorm() : 0.0);
  }
}

void SoftSolver::writeBody(std::size_t i)
{
  IslandBody& body = (*bodies_)[i];
  Books& books = books_[i];
  const Block& block = *body.block;
  const BlockState end = this->end(i);
  const auto energy = [&](const BlockState& s)
  {
    return 0.5 * block.mass() * s.velocity.squaredNorm() +
      0.5 * s.spin.dot(block.inertia() * s.spin) + block.mass() * gravity_ * s.position.z();
  };
  // What the motion of the step leaves over is of the contact that did most.
  const double rest = energy(end) - energy(*body.state) - books.slope - books.rocks;
  if (books.by < rows_.size())
  {
    IslandContact& by = (*contacts_)[results_[books.by].contact];
    if (by.second >= 0)
    {
      by.work -= rest;
      books.rocks += rest;
    }
    else
    {
      books.slope += rest;
    }
  }
  body.given = -books.rocks;
  body.dampedWork = -books.slope - body.frictionWork + books.held - body.springEnergy;
  *body.state = end;
  body.state->time += duration_;
}

void SoftSolver::write(IslandOutcome& outcome)
{
  books_.assign(movers_.size(), { 0.0, 0.0, 0.0, 0.0, rows_.size() });
  for (IslandBody& body : *bodies_)
  {
    body.given = body.frictionWork = body.dampedWork = 0.0;
    body.springEnergy = body.normalEnergy = 0.0;
  }
  for (const IslandContact& asked : *contacts_)
  {
    if (asked.second < 0)
    {
      books_[std::size_t(asked.first)].held += asked.contact->springEnergy();
    }
  }
  forEach(
    rows_.size(), kRowGrain, [&](std::size_t k) { this->writeContact(rows_[k], results_[k]); });
  this->bookContacts(outcome);
  for (std::size_t i = 0; i < movers_.size(); ++i)
  {
    this->writeBody(i);
  }
}

} // namespace rockfall
