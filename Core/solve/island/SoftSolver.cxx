#include "solve/island/SoftSolver.h"

#include "base/parallel.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

using namespace soft;

void SoftSolver::begin(const StepRequest& request, Accept accept, std::vector<IslandBody>& bodies,
  std::vector<IslandContact>& contacts)
{
  accept_ = accept;
  seen_ = {};
  look_ = 0;
  looking_ = true;
  step_.duration = request.duration;
  step_.gravity = request.gravity;
  step_.origin = bodies.front().state->position;
  step_.bodies = &bodies;
  step_.contacts = &contacts;
  step_.substeps = request.substeps;
  step_.h = step_.duration / step_.substeps;
  movers_.begin();
  rows_.gap0.resize(contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    rows_.gap0[k] = contacts[k].contact->distance;
  }
  rows_.findStrips();
  sweeps_.begin(movers_.size());
  impacts_.begin();
  this->arrange();
  this->run();
}

void SoftSolver::arrange()
{
  rows_.arrange();
  pivots_.resize();
  impacts_.setStrips();
  sweeps_.setStrips();
}

void SoftSolver::goOn(const EndDetectionOutcome& seen)
{
  seen_ = seen;
  movers_.noteDetection();
  // Rows of what is found at the end are those of a straight way back.
  const bool cut = accept_ != Accept::Any && seen.missed > kCutMiss;
  looking_ = seen.any() && !cut;
  if (looking_)
  {
    this->append();
    looking_ = !seen.onlyTells(look_);
    if (looking_)
    {
      movers_.start();
      this->run();
    }
  }
  ++look_;
}

void SoftSolver::run()
{
  rows_.start();
  for (int k = 0; k < step_.substeps; ++k)
  {
    this->substep(k);
  }
  movers_.findMoved();
}

void SoftSolver::bookForces(std::size_t strip)
{
  const auto bookRow = [this](std::size_t k)
  {
    const ContactRow& r = rows_.rows[k];
    if (r.P != 0.0)
    {
      book(r, r.P, r.T,
        0.5 * (Movers::speedOf(r, movers_.before) + Movers::speedOf(r, movers_.motions)),
        0.5 * (Movers::speedOfA(r, movers_.before) + Movers::speedOfA(r, movers_.motions)),
        rows_.results[k]);
    }
  };
  for (const std::size_t m : sweeps_.busyOf[strip])
  {
    rows_.forRows(rows_.manifolds[m], bookRow);
    if (rows_.manifolds[m].pivots)
    {
      pivots_.book(m);
    }
  }
}

void SoftSolver::updateGaps(std::size_t strip)
{
  std::vector<std::size_t>& busy = sweeps_.busyOf[strip];
  impacts_.forget(strip);
  busy.clear();
  for (std::size_t m = rows_.firstOfStrip[strip]; m < rows_.firstOfStrip[strip + 1]; ++m)
  {
    Manifold& manifold = rows_.manifolds[m];
    bool any = false, anyBusy = false;
    for (std::size_t k = manifold.first; k < manifold.end; ++k)
    {
      this->arriveAt(k, manifold.busy && !rows_.rows[k].idle);
      anyBusy = anyBusy || !rows_.rows[k].idle;
      any = any || impacts_.closes(k, 1.0);
      this->noteDeep(k);
    }
    manifold.busy = anyBusy;
    manifold.impactRound = 0;
    if (anyBusy)
    {
      busy.push_back(m);
    }
    if (any)
    {
      impacts_.start(m, strip);
    }
  }
}

void SoftSolver::arriveAt(std::size_t k, bool placed)
{
  ContactRow& r = rows_.rows[k];
  ContactRowCold& start = rows_.starts[k];
  const bool weighs = !placed && rows_.place(r);
  start.before = movers_.speedOf(r).dot(r.normal);
  start.jams = false;
  r.gap = rows_.gapOf(k);
  r.idle = r.P == 0.0 && impacts_.staysOpen(k);
  if (!r.idle && weighs)
  {
    rows_.weigh(k);
  }
}

void SoftSolver::noteDeep(std::size_t k)
{
  const ContactRow& r = rows_.rows[k];
  const ContactRowCold& start = rows_.starts[k];
  if (r.b < 0 && -r.gap - r.P / (step_.h * start.spring) > start.loose)
  {
    movers_[r.a].deep = true;
  }
}

bool SoftSolver::isDeep(const Manifold& m) const
{
  return movers_[m.a].deep || (m.b >= 0 && movers_[m.b].deep);
}

void SoftSolver::takeBackPress(std::size_t strip)
{
  const auto back = [this](std::size_t k)
  {
    ContactRow& r = rows_.rows[k];
    const ContactRowCold& start = rows_.starts[k];
    movers_.push(r, (start.warmP - r.P) * r.normal + (start.warmT - r.T));
    r.pressed = r.P > 0.0;
    r.P = start.warmP;
    r.T = start.warmT;
  };
  for (const std::size_t m : sweeps_.busyOf[strip])
  {
    if (this->isDeep(rows_.manifolds[m]))
    {
      rows_.forRows(rows_.manifolds[m], back);
    }
  }
}

void SoftSolver::warm(std::size_t strip)
{
  for (const std::size_t m : sweeps_.busyOf[strip])
  {
    const Manifold& manifold = rows_.manifolds[m];
    const bool deep = this->isDeep(manifold);
    const auto warm = [&](std::size_t k)
    {
      ContactRow& r = rows_.rows[k];
      this->warm(r);
      if (deep)
      {
        rows_.starts[k].warmP = r.P;
        rows_.starts[k].warmT = r.T;
      }
    };
    rows_.forRows(manifold, warm);
    if (manifold.pivots)
    {
      pivots_.warm(m);
    }
  }
}

void SoftSolver::warm(ContactRow& r)
{
  r.pressed = false;
  r.loaded = r.stops;
  if (r.stops)
  {
    r.P = 0.0;
    r.stops = false;
  }
  if (r.P > 0.0)
  {
    movers_.push(r, r.P * r.normal + r.T);
  }
  else
  {
    r.T.setZero();
  }
}

void SoftSolver::keepPushing(std::size_t strip)
{
  std::vector<std::size_t>& busy = sweeps_.busyOf[strip];
  const auto pushes = [this](std::size_t m)
  {
    const Manifold& manifold = rows_.manifolds[m];
    int pushing = 0;
    std::size_t last = 0;
    const bool deep = this->isDeep(manifold);
    const auto count = [&](std::size_t k)
    {
      const bool more = rows_.rows[k].P > 0.0 || (deep && rows_.starts[k].warmP > 0.0);
      pushing += more ? 1 : 0;
      last = more ? k : last;
    };
    rows_.forRows(manifold, count);
    pivots_.find(m, pushing, last);
    const bool any = pushing > 0;
    for (const int i : { manifold.a, manifold.b })
    {
      if (any && i >= 0)
      {
        movers_[i].touched = true;
        movers_[i].flies = false;
      }
    }
    return any;
  };
  const auto letGo = [&](std::size_t m)
  {
    rows_.manifolds[m].busy = pushes(m);
    return !rows_.manifolds[m].busy;
  };
  std::erase_if(busy, letGo);
}

bool SoftSolver::solveNormal(ContactRow& r)
{
  const Vec3 u = movers_.speedOf(r);
  const double v = u.dot(r.normal);
  r.stops = r.stops || (v < -r.resting && !r.loaded);
  double change = 0.0;
  if (r.gap > 0.0)
  {
    change = -r.mass * (v + r.gap / step_.h);
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
  movers_.push(r, dP * r.normal + dT);
  return squeezes;
}

bool SoftSolver::relax(ContactRow& r)
{
  if (r.P == 0.0 && !r.pressed)
  {
    return false;
  }
  const Vec3 u = movers_.speedOf(r);
  const double v = u.dot(r.normal), P = std::max(0.0, r.P - r.mass * v), dP = P - r.P;
  const Vec3 dT = solveFriction(r, P, u - v * r.normal);
  r.P = P;
  movers_.push(r, dP * r.normal + dT);
  return std::abs(dP) > r.mass * r.resting;
}

void SoftSolver::substep(int number)
{
  movers_.forgetDeep();
  rows_.forStrips([&](std::size_t strip) { this->updateGaps(strip); });
  impacts_.strike(number * step_.h);
  movers_.before = movers_.motions;
  movers_.fall();
  rows_.forStrips([this](std::size_t strip) { this->warm(strip); });
  const auto press = [this](std::size_t m)
  {
    bool moved = false;
    rows_.forRows(rows_.manifolds[m],
      [&](std::size_t k) { moved = this->solveNormal(rows_.rows[k]) || moved; });
    return moved;
  };
  sweeps_.sweep(1, press);
  rows_.forStrips([this](std::size_t strip) { this->keepPushing(strip); });
  movers_.move();
  rows_.forStrips([this](std::size_t strip) { this->takeBackPress(strip); });
  const auto place = [&](std::size_t row)
  {
    if (rows_.place(rows_.rows[row]))
    {
      rows_.weigh(row);
    }
  };
  sweeps_.forBusy(place);
  const auto relax = [this](std::size_t m)
  {
    bool moved = false;
    rows_.forRows(
      rows_.manifolds[m], [&](std::size_t k) { moved = this->relax(rows_.rows[k]) || moved; });
    if (rows_.manifolds[m].pivots)
    {
      pivots_.relax(m);
    }
    return moved;
  };
  sweeps_.sweep(kRelaxSweeps, relax);
  rows_.forStrips([this](std::size_t strip) { this->bookForces(strip); });
}

void SoftSolver::append()
{
  const std::vector<IslandContact>& contacts = *step_.contacts;
  const std::size_t known = rows_.gap0.size();
  rows_.gap0.resize(contacts.size(), 0.0);
  for (std::size_t k = known; k < contacts.size(); ++k)
  {
    // The gap at the start from which this motion leads to the one at the end.
    ContactRow row;
    ContactRowCold start;
    rows_.prepare(k, row, start);
    start.gap0 = 0.0;
    Contact& c = *contacts[k].contact;
    c.distance -= rows_.gapOf(row, start);
    c.offset = std::min(0.0, c.distance);
    rows_.gap0[k] = c.distance;
  }
  this->arrange();
}

IslandOutcome SoftSolver::finish()
{
  IslandOutcome outcome;
  const bool deep = seen_.isDeep() || writer_.isDeep();
  outcome.settled = !deep;
  outcome.iterations = step_.substeps;
  outcome.accepted = !deep || accept_ == Accept::Any;
  if (outcome.accepted)
  {
    writer_.write(outcome);
  }
  return outcome;
}

double SoftSolver::force(std::size_t k) const
{
  const std::size_t row = rows_.rowOf[k];
  return std::max(0.0, rows_.results[row].impulse.dot(rows_.rows[row].normal)) / step_.duration;
}

bool SoftSolver::setGap(std::size_t k, double found)
{
  const double change = found - this->gap(k);
  const IslandContact& asked = (*step_.contacts)[k];
  if (std::abs(change) <= kNoMotion * (*step_.bodies)[std::size_t(asked.first)].block->radius())
  {
    return false;
  }
  rows_.gap0[k] += change;
  rows_.starts[rows_.rowOf[k]].gap0 += change;
  return true;
}

void SoftSolver::setAbsent(std::size_t k)
{
  rows_.starts[rows_.rowOf[k]].gap0 = (*step_.contacts)[k].absent ? kAbsent : rows_.gap0[k];
}

} // namespace rockfall
