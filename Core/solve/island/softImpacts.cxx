// Impacts within a substep: what closes faster than the resting speed leaves by Newton's law, and
// strikes what closes by it in the next impact round.

#include "base/joined.h"
#include "base/parallel.h"
#include "law/settings.h"
#include "solve/island/softSweep.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace rockfall
{

bool SoftSolver::closes(std::size_t row, double substeps) const
{
  const ContactRow& r = rows_[row];
  const ContactRowCold& start = starts_[row];
  const auto isHeard = [&](int i)
  { return i < 0 || -start.before > movers_[std::size_t(i)].noise; };
  return start.pending >= 0.0 ||
    (-start.before > r.resting && r.gap + substeps * h_ * start.before < 0.0 && isHeard(r.a) &&
      isHeard(r.b));
}

void SoftSolver::startImpact(std::size_t manifold, std::vector<std::size_t>& struck)
{
  for (std::size_t k = manifolds_[manifold].first; k < manifolds_[manifold].end; ++k)
  {
    if (this->closes(k, kSharedImpact))
    {
      struck.push_back(k);
    }
  }
}

bool SoftSolver::staysOpen(std::size_t row) const
{
  const ContactRow& r = rows_[row];
  return r.gap + 2.0 * h_ * std::min(starts_[row].before, -r.resting) > 0.0;
}

bool SoftSolver::startsImpact(std::size_t m, std::vector<std::size_t>& woken)
{
  Manifold& manifold = manifolds_[m];
  bool any = false;
  for (std::size_t k = manifold.first; k < manifold.end; ++k)
  {
    ContactRow& r = rows_[k];
    starts_[k].before = this->speedOf(r).dot(r.normal);
    any = any || this->closes(k, 1.0);
    if (!r.idle || this->staysOpen(k))
    {
      continue;
    }
    r.idle = false;
    if (this->place(r))
    {
      this->weigh(k);
    }
    if (!manifold.busy)
    {
      manifold.busy = true;
      woken.push_back(m);
    }
  }
  return any;
}

void SoftSolver::link()
{
  if (linked_)
  {
    return;
  }
  firstOf_.assign(movers_.size() + 2, 0);
  const auto forEnds = [&](std::size_t shift, auto&& visit)
  {
    for (std::size_t m = 0; m < manifolds_.size(); ++m)
    {
      visit(std::size_t(manifolds_[m].a) + shift, m);
      if (manifolds_[m].b >= 0)
      {
        visit(std::size_t(manifolds_[m].b) + shift, m);
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

double SoftSolver::leaves(std::size_t row) const
{
  const ContactRowCold& start = starts_[row];
  if (start.pending >= 0.0)
  {
    return start.pending;
  }
  const IslandContact& c = (*contacts_)[results_[row].contact];
  return -start.before * c.restitutionAt(-start.before);
}

std::size_t SoftSolver::countStruck() const
{
  return std::accumulate(impactRounds_.begin(), impactRounds_.end(), std::size_t(0),
    [](std::size_t sum, const ImpactRound& g) { return sum + g.struck.size(); });
}

void SoftSolver::strikeGenerations(double time)
{
  std::size_t struck = this->countStruck();
  if (struck == 0)
  {
    return;
  }
  for (int number = 1; number <= kGenerations && struck > 0; ++number)
  {
    this->forStrips([this](std::size_t s) { this->beginImpacts(impactRounds_[s]); }, struck);
    this->settleImpacts(struck);
    this->limitGains();
    this->forStrips([this](std::size_t s) { this->scaleBack(impactRounds_[s]); }, struck);
    this->forStrips([&](std::size_t s) { this->bookImpacts(impactRounds_[s], time); }, struck);
    if (number < kGenerations)
    {
      this->link();
      this->forStrips([&](std::size_t s) { this->findStruck(s, number); }, struck);
    }
    struck = this->countStruck();
  }
  this->forStrips([this](std::size_t s) { this->listWoken(s); }, 0);
}

void SoftSolver::beginImpacts(ImpactRound& impactRound) const
{
  impactRound.moved.clear();
  impactRound.impacts.clear();
  for (const std::size_t k : impactRound.struck)
  {
    const ContactRow& r = rows_[k];
    const double stored =
      starts_[k].pending >= 0.0 ? (*contacts_)[results_[k].contact].contact->springEnergy() : 0.0;
    impactRound.impacts.push_back(
      { k, 0.0, Vec3::Zero(), this->speedOf(r), this->speedOfA(r), this->leaves(k), stored });
  }
  impactRound.struck.clear();
}

void SoftSolver::settleImpacts(std::size_t count)
{
  tick_ += 2;
  const int begun = tick_;
  std::atomic<bool> any = true;
  const auto sweep = [&](std::size_t strip)
  {
    ImpactRound& impactRound = impactRounds_[strip];
    const auto noteMove = [&](int i)
    {
      if (i >= 0)
      {
        int& stamp = stamp_[std::size_t(i)];
        if (stamp < begun)
        {
          impactRound.moved.push_back(i);
        }
        stamp = tick_;
      }
    };
    for (Impact& impact : impactRound.impacts)
    {
      const ContactRow& r = rows_[impact.row];
      if (tick_ > begun && !this->moves(r.a) && !this->moves(r.b))
      {
        continue;
      }
      if (this->settle(impact))
      {
        noteMove(r.a);
        noteMove(r.b);
        any.store(true, std::memory_order_relaxed);
      }
    }
  };
  for (int pass = 0; pass < kImpactSweeps && any; ++pass, ++tick_)
  {
    any = false;
    this->forStrips(sweep, count);
  }
}

bool SoftSolver::settle(Impact& impact)
{
  const ContactRow& r = rows_[impact.row];
  const Vec3 u = this->speedOf(r);
  const double v = u.dot(r.normal);
  const double Q = std::max(0.0, impact.Q - r.mass * (v - impact.leaves)), dQ = Q - impact.Q;
  Vec3 S = impact.S - r.shearMass * (u - v * r.normal);
  limitTo(S, r.friction * Q);
  const Vec3 dS = S - impact.S;
  impact.Q = Q;
  impact.S = S;
  const double size = std::abs(dQ) + dS.norm();
  if (size > 0.0)
  {
    this->push(r, dQ * r.normal + dS);
  }
  return size > r.mass *
    std::max(kImpactExact * std::abs(starts_[impact.row].before), kImpactQuiet * r.resting);
}

double SoftSolver::ImpactEnergy::share() const
{
  if (work <= stored)
  {
    return 1.0;
  }
  // The work of a share s is along s + (work − along) s².
  const double square = work - along;
  const double root = std::sqrt(std::max(0.0, along * along + 4.0 * square * stored));
  return std::clamp((-along + root) / (2.0 * square), 0.0, 1.0);
}

void SoftSolver::limitGains()
{
  const auto forImpacts = [this](auto&& visit)
  {
    for (ImpactRound& impactRound : impactRounds_)
    {
      for (Impact& impact : impactRound.impacts)
      {
        visit(impact, rows_[impact.row]);
      }
    }
  };
  const auto joinRocks = [this](const Impact&, const ContactRow& r)
  {
    if (r.b >= 0)
    {
      joinTwo(joined_, r.a, r.b);
    }
  };
  const auto addWork = [this](const Impact& impact, const ContactRow& r)
  {
    const Vec3 J = impact.Q * r.normal + impact.S;
    ImpactEnergy& gain = impactEnergies_[std::size_t(headOf(joined_, r.a))];
    gain.along += J.dot(impact.before);
    gain.work += 0.5 * J.dot(impact.before + this->speedOf(r));
    gain.stored += impact.stored;
  };
  const auto share = [this](Impact& impact, const ContactRow& r)
  { impact.share = impactEnergies_[std::size_t(headOf(joined_, r.a))].share(); };
  const auto part = [this](const Impact&, const ContactRow& r)
  {
    for (const int i : { r.a, r.b })
    {
      if (i >= 0)
      {
        joined_[std::size_t(i)] = i;
        impactEnergies_[std::size_t(i)] = {};
      }
    }
  };
  forImpacts(joinRocks);
  forImpacts(addWork);
  forImpacts(share);
  forImpacts(part);
}

void SoftSolver::scaleBack(const ImpactRound& impactRound)
{
  for (const Impact& impact : impactRound.impacts)
  {
    const ContactRow& r = rows_[impact.row];
    if (impact.share < 1.0 && impact.Q > 0.0)
    {
      this->push(r, (impact.share - 1.0) * (impact.Q * r.normal + impact.S));
    }
  }
}

void SoftSolver::bookImpacts(const ImpactRound& impactRound, double time)
{
  for (const Impact& impact : impactRound.impacts)
  {
    const ContactRow& r = rows_[impact.row];
    this->noteImpact(impact, time);
    book(r, impact.share * impact.Q, impact.share * impact.S,
      0.5 * (impact.before + this->speedOf(r)), 0.5 * (impact.beforeA + this->speedOfA(r)),
      results_[impact.row]);
  }
}

void SoftSolver::noteImpact(const Impact& impact, double time)
{
  const ContactRow& r = rows_[impact.row];
  ContactRowCold& start = starts_[impact.row];
  Result& result = results_[impact.row];
  if (impact.Q > 0.0 && start.pending < 0.0 && -start.before > result.struck)
  {
    const Mover& a = movers_[std::size_t(r.a)];
    result.struck = -start.before;
    result.struckAt = time;
    result.struckPoint = a.start + a.displacement + r.lever;
  }
  start.pending = -1.0;
  for (const int i : { r.a, r.b })
  {
    if (i >= 0)
    {
      Mover& m = movers_[std::size_t(i)];
      m.flies = m.flies && impact.Q == 0.0;
      m.noise = std::max(m.noise, 2.0 * kImpactExact * std::abs(start.before));
    }
  }
}

void SoftSolver::listWoken(std::size_t strip)
{
  std::vector<std::size_t>& woken = impactRounds_[strip].woken;
  std::vector<std::size_t>& busy = busyOf_[strip];
  if (!woken.empty())
  {
    busy.insert(busy.end(), woken.begin(), woken.end());
    std::sort(busy.begin(), busy.end());
    woken.clear();
  }
}

void SoftSolver::findStruck(std::size_t strip, int number)
{
  ImpactRound& impactRound = impactRounds_[strip];
  // Movers of its rows are of this strip and of the next one, and noted there or before it.
  const std::size_t end = std::min(strip + 2, std::size_t(strips_));
  for (std::size_t s = strip == 0 ? 0 : strip - 1; s < end; ++s)
  {
    for (const int i : impactRounds_[s].moved)
    {
      for (std::size_t j = firstOf_[std::size_t(i)]; j < firstOf_[std::size_t(i) + 1]; ++j)
      {
        const std::size_t m = manifoldsOf_[j];
        const bool here = m >= firstOfStrip_[strip] && m < firstOfStrip_[strip + 1];
        if (!here || manifolds_[m].impactRound == number)
        {
          continue;
        }
        manifolds_[m].impactRound = number;
        if (this->startsImpact(m, impactRound.woken))
        {
          this->startImpact(m, impactRound.struck);
        }
      }
    }
  }
  std::sort(impactRound.struck.begin(), impactRound.struck.end());
}

} // namespace rockfall
