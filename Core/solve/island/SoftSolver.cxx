#include "solve/island/SoftSolver.h"

#include "base/parallel.h"
#include "law/settings.h"
#include "solve/island/softSweep.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace rockfall
{

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
  motions_.resize(bodies.size());
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
  stamp_.assign(movers_.size(), -1);
  joined_.resize(movers_.size());
  std::iota(joined_.begin(), joined_.end(), 0);
  impactEnergies_.assign(movers_.size(), {});
  tick_ = 0;
  this->arrange();
  this->run();
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
    this->place(rows_[k]);
    this->weigh(k);
    this->prepareImpulses(k, (*contacts_)[results_[k].contact]);
    rows_[k].idle = false;
    results_[k] = { results_[k].contact, Vec3::Zero(), 0.0, 0.0, 0.0, 0.0, 0.0, Vec3::Zero() };
  };
  forEach(rows_.size(), kRowGrain, start);
  for (Manifold& manifold : manifolds_)
  {
    manifold.busy = true;
    manifold.pivots = false;
  }
  for (int k = 0; k < substeps_; ++k)
  {
    this->substep(k);
  }
  const auto look = [&](std::size_t i)
  {
    Mover& m = movers_[i];
    const double near = kNoMotion * m.block->radius();
    m.moved = m.moved || (m.displacement - m.seenAt).cwiseAbs().maxCoeff() > near ||
      (m.turn - m.seenTurn).cwiseAbs().maxCoeff() > kNoMotion;
  };
  forEach(movers_.size(), kBodyGrain, look);
}

bool SoftSolver::place(ContactRow& r) const
{
  const Mover& a = movers_[std::size_t(r.a)];
  if (r.b < 0)
  {
    return a.turned;
  }
  const Mover& b = movers_[std::size_t(r.b)];
  const Vec3 slide = a.displacement - b.displacement;
  r.leverB = r.lever + ((a.start - b.start) + slide);
  return a.turned || b.turned || slide.squaredNorm() > r.slide2;
}

double SoftSolver::gapOf(const ContactRow& r, const ContactRowCold& start) const
{
  const Mover& a = movers_[std::size_t(r.a)];
  Vec3 motion = a.displacement + a.turn.cross(r.lever);
  if (r.b >= 0)
  {
    const Mover& b = movers_[std::size_t(r.b)];
    motion -= b.displacement + b.turn.cross(r.lever + (a.start - b.start));
  }
  return start.gap0 + r.normal.dot(motion);
}

void SoftSolver::book(const ContactRow& r, double along, const Vec3& across, const Vec3& mean,
  const Vec3& meanA, Result& result)
{
  result.normalWork += along * r.normal.dot(mean);
  result.frictionWork -= across.dot(mean);
  const Vec3 impulse = along * r.normal + across;
  result.workOnA += impulse.dot(meanA);
  result.impulse += impulse;
}

void SoftSolver::bookForces(std::size_t strip)
{
  const auto bookRow = [this](std::size_t k)
  {
    const ContactRow& r = rows_[k];
    if (r.P != 0.0)
    {
      book(r, r.P, r.T, 0.5 * (speedOf(r, before_) + speedOf(r, motions_)),
        0.5 * (speedOfA(r, before_) + speedOfA(r, motions_)), results_[k]);
    }
  };
  for (const std::size_t m : busyOf_[strip])
  {
    this->forRows(manifolds_[m], bookRow);
    if (manifolds_[m].pivots)
    {
      this->bookPivot(pivots_[m]);
    }
  }
}

void SoftSolver::updateGaps(std::size_t strip)
{
  std::vector<std::size_t>& struck = impactRounds_[strip].struck;
  std::vector<std::size_t>& busy = busyOf_[strip];
  struck.clear();
  busy.clear();
  for (std::size_t m = firstOfStrip_[strip]; m < firstOfStrip_[strip + 1]; ++m)
  {
    Manifold& manifold = manifolds_[m];
    bool any = false, anyBusy = false;
    for (std::size_t k = manifold.first; k < manifold.end; ++k)
    {
      this->arriveAt(k, manifold.busy && !rows_[k].idle);
      anyBusy = anyBusy || !rows_[k].idle;
      any = any || this->closes(k, 1.0);
    }
    manifold.busy = anyBusy;
    manifold.impactRound = 0;
    if (anyBusy)
    {
      busy.push_back(m);
    }
    if (any)
    {
      this->startImpact(m, struck);
    }
  }
}

void SoftSolver::arriveAt(std::size_t k, bool placed)
{
  ContactRow& r = rows_[k];
  ContactRowCold& start = starts_[k];
  const bool weighs = !placed && this->place(r);
  start.before = this->speedOf(r).dot(r.normal);
  r.gap = this->gapOf(k);
  r.idle = r.P == 0.0 && this->staysOpen(k);
  if (!r.idle && weighs)
  {
    this->weigh(k);
  }
}

void SoftSolver::warm(std::size_t strip)
{
  for (const std::size_t m : busyOf_[strip])
  {
    this->forRows(manifolds_[m], [this](std::size_t k) { this->warm(rows_[k]); });
    if (manifolds_[m].pivots)
    {
      this->warmPivot(m);
    }
  }
}

void SoftSolver::warm(ContactRow& r)
{
  r.loaded = r.stops;
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

void SoftSolver::keepPushing(std::size_t strip)
{
  std::vector<std::size_t>& busy = busyOf_[strip];
  const auto pushes = [this](std::size_t m)
  {
    const Manifold& manifold = manifolds_[m];
    int pushing = 0;
    std::size_t last = 0;
    const auto count = [&](std::size_t k)
    {
      const bool more = rows_[k].P > 0.0;
      pushing += more ? 1 : 0;
      last = more ? k : last;
    };
    this->forRows(manifold, count);
    this->findPivot(m, pushing, last);
    const bool any = pushing > 0;
    for (const int i : { manifold.a, manifold.b })
    {
      if (any && i >= 0)
      {
        movers_[std::size_t(i)].touched = true;
        movers_[std::size_t(i)].carried = movers_[std::size_t(i)].carried || manifold.b >= 0;
        movers_[std::size_t(i)].flies = false;
      }
    }
    return any;
  };
  const auto letGo = [&](std::size_t m)
  {
    manifolds_[m].busy = pushes(m);
    return !manifolds_[m].busy;
  };
  std::erase_if(busy, letGo);
}

bool SoftSolver::solveNormal(ContactRow& r)
{
  const Vec3 u = this->speedOf(r);
  const double v = u.dot(r.normal);
  r.stops = r.stops || (v < -r.resting && !r.loaded);
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
  if (dP == 0.0)
  {
    return false;
  }
  // What rests has the friction of the last substep; what is squeezed or let go has its own.
  const bool squeezes = std::abs(dP) > r.mass * r.resting;
  const Vec3 dT = squeezes || P == 0.0 ? solveFriction(r, P, u - v * r.normal) : Vec3(Vec3::Zero());
  r.P = P;
  this->push(r, dP * r.normal + dT);
  return squeezes;
}

bool SoftSolver::relax(ContactRow& r)
{
  if (r.P == 0.0)
  {
    return false;
  }
  const Vec3 u = this->speedOf(r);
  const double v = u.dot(r.normal), P = std::max(0.0, r.P - r.mass * v), dP = P - r.P;
  const Vec3 dT = this->solveFriction(r, P, u - v * r.normal);
  r.P = P;
  this->push(r, dP * r.normal + dT);
  return std::abs(dP) > r.mass * r.resting;
}

bool SoftSolver::stripMoves(std::size_t strip) const
{
  const std::size_t first = strip == 0 ? 0 : strip - 1;
  const std::size_t end = std::min(strip + 2, std::size_t(strips_));
  return std::any_of(stampOfStrip_.begin() + std::ptrdiff_t(first),
    stampOfStrip_.begin() + std::ptrdiff_t(end), [this](int stamp) { return stamp >= tick_ - 1; });
}

void SoftSolver::noteMoved(const Manifold& manifold)
{
  stamp_[std::size_t(manifold.a)] = tick_;
  if (manifold.b >= 0)
  {
    stamp_[std::size_t(manifold.b)] = tick_;
  }
}

template <class Sweep>
void SoftSolver::sweep(int least, Sweep&& sweepManifold)
{
  tick_ += 2;
  std::size_t rows = kRowGrain; // of rocks that have moved, about
  for (int sweep = 0; sweep < least || (rows > 0 && sweep < kMostSweeps); ++sweep, ++tick_)
  {
    std::atomic<std::size_t> moving = 0;
    const auto sweepStrip = [&](std::size_t strip)
    {
      if (sweep >= least && !this->stripMoves(strip))
      {
        return;
      }
      for (const std::size_t m : busyOf_[strip])
      {
        const Manifold& manifold = manifolds_[m];
        if (sweep >= least && !this->moves(manifold.a) && !this->moves(manifold.b))
        {
          continue;
        }
        if (sweepManifold(m))
        {
          this->noteMoved(manifold);
          stampOfStrip_[strip] = tick_;
          moving.fetch_add(manifold.end - manifold.first, std::memory_order_relaxed);
        }
      }
    };
    this->forStrips(sweepStrip, sweep < least ? kRowGrain : rows);
    rows = moving;
  }
}

void SoftSolver::substep(int number)
{
  const Vec3 gravity(0.0, 0.0, -gravity_);
  this->forStrips([&](std::size_t strip) { this->updateGaps(strip); });
  this->strikeGenerations(number * h_);
  before_ = motions_;
  const auto fall = [&](std::size_t i)
  {
    motions_[i].velocity += h_ * gravity;
    movers_[i].touched = movers_[i].carried = false;
    movers_[i].kinetic = this->kineticEnergy(i);
  };
  forEach(movers_.size(), kBodyGrain, fall);
  this->forStrips([this](std::size_t strip) { this->warm(strip); });
  const auto press = [this](std::size_t m)
  {
    bool moved = false;
    this->forRows(
      manifolds_[m], [&](std::size_t k) { moved = this->solveNormal(rows_[k]) || moved; });
    return moved;
  };
  this->sweep(1, press);
  this->forStrips([this](std::size_t strip) { this->keepPushing(strip); });
  const auto move = [&](std::size_t i)
  {
    Mover& m = movers_[i];
    // What nothing touches falls on its parabola.
    m.displacement += h_ * motions_[i].velocity;
    if (!m.touched)
    {
      m.displacement -= 0.5 * h_ * h_ * gravity;
    }
    this->turn(i);
  };
  forEach(movers_.size(), kBodyGrain, move);
  const auto place = [&](std::size_t row)
  {
    if (this->place(rows_[row]))
    {
      this->weigh(row);
    }
  };
  this->forBusy(place);
  const auto relax = [this](std::size_t m)
  {
    bool moved = false;
    this->forRows(manifolds_[m], [&](std::size_t k) { moved = this->relax(rows_[k]) || moved; });
    if (manifolds_[m].pivots)
    {
      this->relax(pivots_[m]);
    }
    return moved;
  };
  this->sweep(kRelaxSweeps, relax);
  forEach(movers_.size(), kBodyGrain, [this](std::size_t i) { this->holdEnergy(i); });
  this->forStrips([this](std::size_t strip) { this->bookForces(strip); });
}

void SoftSolver::append()
{
  const std::vector<IslandContact>& contacts = *contacts_;
  const std::size_t known = gap0_.size();
  gap0_.resize(contacts.size(), 0.0);
  for (std::size_t k = known; k < contacts.size(); ++k)
  {
    // The gap at the start from which this motion leads to the one at the end.
    ContactRow row;
    ContactRowCold start;
    this->prepareRow(k, row, start);
    start.gap0 = 0.0;
    Contact& c = *contacts[k].contact;
    c.distance -= this->gapOf(row, start);
    c.offset = std::min(0.0, c.distance);
    gap0_[k] = c.distance;
  }
  this->arrange();
}

double SoftSolver::gap(std::size_t k) const
{
  const std::size_t row = rowOf_[k];
  return this->gapOf(row) - starts_[row].gap0 + gap0_[k] - (*contacts_)[k].contact->offset;
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
  starts_[rowOf_[k]].gap0 += change;
  return true;
}

void SoftSolver::setAbsent(std::size_t k)
{
  starts_[rowOf_[k]].gap0 = (*contacts_)[k].absent ? kAbsent : gap0_[k];
}

} // namespace rockfall
