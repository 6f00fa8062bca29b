#include "solve/island/softImpacts.h"

#include "base/joined.h"
#include "law/settings.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace rockfall::soft
{

void Impacts::begin()
{
  joined_.resize(movers_.size());
  std::iota(joined_.begin(), joined_.end(), 0);
  energies_.assign(movers_.size(), {});
}

void Impacts::setStrips()
{
  rounds_.resize(std::size_t(rows_.strips));
  linked_ = false;
}

bool Impacts::closes(std::size_t row, double substeps) const
{
  const ContactRow& r = rows_.rows[row];
  const ContactRowCold& start = rows_.starts[row];
  const auto isHeard = [&](int i) { return i < 0 || -start.before > movers_[i].noise; };
  return start.pending >= 0.0 ||
    (-start.before > r.resting && r.gap + substeps * step_.h * start.before < 0.0 && isHeard(r.a) &&
      isHeard(r.b));
}

void Impacts::start(std::size_t manifold, std::size_t strip)
{
  for (std::size_t k = rows_.manifolds[manifold].first; k < rows_.manifolds[manifold].end; ++k)
  {
    if (this->closes(k, kSharedImpact) || this->jams(k))
    {
      rounds_[strip].struck.push_back(k);
    }
  }
}

bool Impacts::jams(std::size_t row) const
{
  return jammed_ && rows_.starts[row].jams && rows_.starts[row].before < rows_.rows[row].resting;
}

bool Impacts::staysOpen(std::size_t row) const
{
  const ContactRow& r = rows_.rows[row];
  return r.gap + 2.0 * step_.h * std::min(rows_.starts[row].before, -r.resting) > 0.0;
}

bool Impacts::isSetGoing(std::size_t m, std::vector<std::size_t>& woken)
{
  Manifold& manifold = rows_.manifolds[m];
  bool any = false;
  for (std::size_t k = manifold.first; k < manifold.end; ++k)
  {
    ContactRow& r = rows_.rows[k];
    rows_.starts[k].before = movers_.speedOf(r).dot(r.normal);
    any = any || this->closes(k, 1.0) || this->jams(k);
    if (!r.idle || this->staysOpen(k))
    {
      continue;
    }
    r.idle = false;
    if (rows_.place(r))
    {
      rows_.weigh(k);
    }
    if (!manifold.busy)
    {
      manifold.busy = true;
      woken.push_back(m);
    }
  }
  return any;
}

void Impacts::link()
{
  if (linked_)
  {
    return;
  }
  firstOf_.assign(movers_.size() + 2, 0);
  const auto forEnds = [&](std::size_t shift, auto&& visit)
  {
    for (std::size_t m = 0; m < rows_.manifolds.size(); ++m)
    {
      visit(std::size_t(rows_.manifolds[m].a) + shift, m);
      if (rows_.manifolds[m].b >= 0)
      {
        visit(std::size_t(rows_.manifolds[m].b) + shift, m);
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

double Impacts::leaves(std::size_t row) const
{
  if (jammed_)
  {
    return 0.0;
  }
  const ContactRowCold& start = rows_.starts[row];
  if (start.pending >= 0.0)
  {
    return start.pending;
  }
  const IslandContact& c = (*step_.contacts)[rows_.results[row].contact];
  return -start.before * c.restitutionAt(-start.before);
}

std::size_t Impacts::countStruck() const
{
  return std::accumulate(rounds_.begin(), rounds_.end(), std::size_t(0),
    [](std::size_t sum, const ImpactRound& g) { return sum + g.struck.size(); });
}

bool Impacts::anyCloses() const
{
  const auto closes = [this](std::size_t k) { return this->closes(k, 1.0); };
  return std::any_of(rounds_.begin(), rounds_.end(),
    [&](const ImpactRound& g) { return std::any_of(g.struck.begin(), g.struck.end(), closes); });
}

void Impacts::strike(double time)
{
  std::size_t struck = this->countStruck();
  if (struck == 0)
  {
    return;
  }
  jammed_ = false;
  this->link();
  for (int number = 1; number <= 2 * kGenerations && struck > 0; ++number)
  {
    rows_.forStrips([this](std::size_t s) { this->beginRound(rounds_[s]); }, struck);
    this->settleAll(struck);
    this->limitGains();
    rows_.forStrips([this](std::size_t s) { this->scaleBack(rounds_[s]); }, struck);
    rows_.forStrips([&](std::size_t s) { this->book(rounds_[s], time); }, struck);
    jammed_ = number >= kGenerations;
    rows_.forStrips([&](std::size_t s) { this->findStruck(s, number); }, struck);
    struck = jammed_ && !this->anyCloses() ? 0 : this->countStruck();
  }
  rows_.forStrips([this](std::size_t s) { this->listWoken(s); }, 0);
}

void Impacts::beginRound(ImpactRound& round)
{
  round.moved.clear();
  round.impacts.clear();
  for (const std::size_t k : round.struck)
  {
    const ContactRow& r = rows_.rows[k];
    const double stored = rows_.starts[k].pending >= 0.0
      ? (*step_.contacts)[rows_.results[k].contact].contact->springEnergy()
      : 0.0;
    rows_.starts[k].jams = jammed_;
    round.impacts.push_back(
      { k, 0.0, Vec3::Zero(), movers_.speedOf(r), movers_.speedOfA(r), this->leaves(k), stored });
  }
  round.struck.clear();
}

void Impacts::settleAll(std::size_t count)
{
  sweeps_.tick += 2;
  const int begun = sweeps_.tick;
  std::atomic<bool> any = true;
  const auto sweep = [&](std::size_t strip)
  {
    ImpactRound& round = rounds_[strip];
    const auto noteMove = [&](int i)
    {
      if (i >= 0)
      {
        int& stamp = sweeps_.stamp[std::size_t(i)];
        if (stamp < begun)
        {
          round.moved.push_back(i);
        }
        stamp = sweeps_.tick;
      }
    };
    for (Impact& impact : round.impacts)
    {
      const ContactRow& r = rows_.rows[impact.row];
      if (sweeps_.tick > begun && !sweeps_.moves(r.a) && !sweeps_.moves(r.b))
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
  for (int pass = 0; pass < kImpactSweeps && any; ++pass, ++sweeps_.tick)
  {
    any = false;
    rows_.forStrips(sweep, count);
  }
}

bool Impacts::settle(Impact& impact)
{
  const ContactRow& r = rows_.rows[impact.row];
  const Vec3 u = movers_.speedOf(r);
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
    movers_.push(r, dQ * r.normal + dS);
  }
  return size > r.mass *
    std::max(kImpactExact * std::abs(rows_.starts[impact.row].before), kImpactQuiet * r.resting);
}

double ImpactEnergy::share() const
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

void Impacts::limitGains()
{
  const auto forImpacts = [this](auto&& visit)
  {
    for (ImpactRound& round : rounds_)
    {
      for (Impact& impact : round.impacts)
      {
        visit(impact, rows_.rows[impact.row]);
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
    ImpactEnergy& gain = energies_[std::size_t(headOf(joined_, r.a))];
    gain.along += J.dot(impact.before);
    gain.work += 0.5 * J.dot(impact.before + movers_.speedOf(r));
    gain.stored += impact.stored;
  };
  const auto share = [this](Impact& impact, const ContactRow& r)
  { impact.share = energies_[std::size_t(headOf(joined_, r.a))].share(); };
  const auto part = [this](const Impact&, const ContactRow& r)
  {
    for (const int i : { r.a, r.b })
    {
      if (i >= 0)
      {
        joined_[std::size_t(i)] = i;
        energies_[std::size_t(i)] = {};
      }
    }
  };
  forImpacts(joinRocks);
  forImpacts(addWork);
  forImpacts(share);
  forImpacts(part);
}

void Impacts::scaleBack(const ImpactRound& round)
{
  for (const Impact& impact : round.impacts)
  {
    const ContactRow& r = rows_.rows[impact.row];
    if (impact.share < 1.0 && impact.Q > 0.0)
    {
      movers_.push(r, (impact.share - 1.0) * (impact.Q * r.normal + impact.S));
    }
  }
}

void Impacts::book(const ImpactRound& round, double time)
{
  for (const Impact& impact : round.impacts)
  {
    const ContactRow& r = rows_.rows[impact.row];
    this->note(impact, time);
    soft::book(r, impact.share * impact.Q, impact.share * impact.S,
      0.5 * (impact.before + movers_.speedOf(r)), 0.5 * (impact.beforeA + movers_.speedOfA(r)),
      rows_.results[impact.row]);
  }
}

void Impacts::note(const Impact& impact, double time)
{
  const ContactRow& r = rows_.rows[impact.row];
  ContactRowCold& start = rows_.starts[impact.row];
  Result& result = rows_.results[impact.row];
  if (impact.Q > 0.0 && start.pending < 0.0 && -start.before > result.struck)
  {
    const Mover& a = movers_[r.a];
    result.struck = -start.before;
    result.struckAt = time;
    result.struckPoint = a.start + a.displacement + r.lever;
  }
  start.pending = -1.0;
  for (const int i : { r.a, r.b })
  {
    if (i >= 0)
    {
      Mover& m = movers_[i];
      m.flies = m.flies && impact.Q == 0.0;
      m.noise = std::max(m.noise, 2.0 * kImpactExact * std::abs(start.before));
    }
  }
}

void Impacts::listWoken(std::size_t strip)
{
  std::vector<std::size_t>& woken = rounds_[strip].woken;
  std::vector<std::size_t>& busy = sweeps_.busyOf[strip];
  if (!woken.empty())
  {
    busy.insert(busy.end(), woken.begin(), woken.end());
    std::sort(busy.begin(), busy.end());
    woken.clear();
  }
}

void Impacts::findStruck(std::size_t strip, int number)
{
  ImpactRound& round = rounds_[strip];
  // Movers of its rows are of this strip and of the next one, and noted there or before it.
  const std::size_t end = std::min(strip + 2, std::size_t(rows_.strips));
  for (std::size_t s = strip == 0 ? 0 : strip - 1; s < end; ++s)
  {
    for (const int i : rounds_[s].moved)
    {
      for (std::size_t j = firstOf_[std::size_t(i)]; j < firstOf_[std::size_t(i) + 1]; ++j)
      {
        const std::size_t m = manifoldsOf_[j];
        const bool here = m >= rows_.firstOfStrip[strip] && m < rows_.firstOfStrip[strip + 1];
        if (!here || rows_.manifolds[m].impactRound == number)
        {
          continue;
        }
        rows_.manifolds[m].impactRound = number;
        if (this->isSetGoing(m, round.woken))
        {
          this->start(m, strip);
        }
      }
    }
  }
  std::sort(round.struck.begin(), round.struck.end());
}

} // namespace rockfall::soft
