#include "system/SoftSolver.h"

#include "base/parallel.h"
#include "block/FreeRotation.h"
#include "block/cayley.h"
#include "block/flight.h"
#include "law/settings.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace rockfall
{

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
  this->run();
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

void SoftSolver::solve()
{
  this->startMovers();
  this->run();
}

void SoftSolver::run()
{
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
  Vec3 u = this->speedOfA(r);
  if (r.b >= 0)
  {
    const Mover& b = movers_[std::size_t(r.b)];
    u -= b.velocity + b.spin.cross(this->leverB(r));
  }
  return u;
}

void SoftSolver::limitTo(Vec3& T, double most)
{
  const double size2 = T.squaredNorm();
  if (size2 > most * most)
  {
    T *= most / std::sqrt(size2);
  }
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

void SoftSolver::book(const Row& r, double along, const Vec3& across, const Vec3& mean,
  const Vec3& meanA, Result& result)
{
  result.normalWork += along * r.normal.dot(mean);
  result.frictionWork -= across.dot(mean);
  const Vec3 impulse = along * r.normal + across;
  result.workOnA += impulse.dot(meanA);
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
      if (r.P != 0.0 && substep_ > 0)
      {
        book(r, r.P, r.T, 0.5 * (r.speed + speed), 0.5 * (r.speedA + speedA), results_[k]);
      }
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

} // namespace rockfall
