// Impacts within a substep: what closes faster than the resting speed leaves by Newton's law, and
// strikes what closes by it in the next generation.

#include "law/settings.h"
#include "system/SoftSolver.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

bool SoftSolver::closes(std::size_t row, double substeps) const
{
  const Row& r = rows_[row];
  const RowStart& start = starts_[row];
  const double noise =
    std::max(movers_[std::size_t(r.a)].noise, r.b >= 0 ? movers_[std::size_t(r.b)].noise : 0.0);
  return start.pending >= 0.0 ||
    (-start.before > std::max(r.resting, noise) && r.gap + substeps * h_ * start.before < 0.0);
}

void SoftSolver::strike(std::size_t manifold, std::vector<std::size_t>& struck)
{
  for (std::size_t k = manifolds_[manifold][0]; k < manifolds_[manifold][1]; ++k)
  {
    if (this->closes(k, kSharedImpact))
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
    const Row& r = rows_[k];
    starts_[k].before = this->speedOf(r).dot(r.normal);
    any = any || this->closes(k, 1.0);
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

double SoftSolver::leaves(std::size_t row) const
{
  const RowStart& start = starts_[row];
  if (start.pending >= 0.0)
  {
    return start.pending;
  }
  const IslandContact& c = (*contacts_)[results_[row].contact];
  return -start.before * c.restitutionAt(-start.before);
}

void SoftSolver::strikeGenerations(double time)
{
  for (int generation = 1; !struck_.empty(); ++generation)
  {
    const double stored = this->beginImpacts();
    this->settleImpacts();
    this->bookImpacts(this->shareOfImpacts(stored), time);
    struck_.clear();
    if (generation < kGenerations)
    {
      this->findStruck(generation);
    }
  }
}

double SoftSolver::beginImpacts()
{
  moving_.clear();
  impacts_.clear();
  double stored = 0.0;
  for (const std::size_t k : struck_)
  {
    const Row& r = rows_[k];
    impacts_.push_back(
      { k, 0.0, Vec3::Zero(), this->speedOf(r), this->speedOfA(r), this->leaves(k) });
    // Springs of impacts that were under way give what they hold.
    stored +=
      starts_[k].pending >= 0.0 ? (*contacts_)[results_[k].contact].contact->springEnergy() : 0.0;
  }
  return stored;
}

void SoftSolver::settleImpacts()
{
  tick_ += 2;
  const int begun = tick_;
  const auto noteMove = [&](int i)
  {
    if (i >= 0)
    {
      int& stamp = stamp_[std::size_t(i)];
      if (stamp < begun)
      {
        moving_.push_back(i);
      }
      stamp = tick_;
    }
  };
  bool any = true;
  for (int pass = 0; pass < kImpactSweeps && any; ++pass, ++tick_)
  {
    any = false;
    for (Impact& impact : impacts_)
    {
      const Row& r = rows_[impact.row];
      if (pass > 0 && !this->moves(r.a) && !this->moves(r.b))
      {
        continue;
      }
      if (this->settle(impact))
      {
        noteMove(r.a);
        noteMove(r.b);
        any = true;
      }
    }
  }
}

bool SoftSolver::settle(Impact& impact)
{
  const Row& r = rows_[impact.row];
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

double SoftSolver::shareOfImpacts(double stored) const
{
  double along = 0.0, work = 0.0;
  for (const Impact& impact : impacts_)
  {
    const Row& r = rows_[impact.row];
    const Vec3 J = impact.Q * r.normal + impact.S;
    along += J.dot(impact.before);
    work += 0.5 * J.dot(impact.before + this->speedOf(r));
  }
  if (work <= stored)
  {
    return 1.0;
  }
  // The work of a share s is along s + (work − along) s².
  const double square = work - along;
  const double root = std::sqrt(std::max(0.0, along * along + 4.0 * square * stored));
  return std::clamp((-along + root) / (2.0 * square), 0.0, 1.0);
}

void SoftSolver::bookImpacts(double share, double time)
{
  for (const Impact& impact : impacts_)
  {
    const Row& r = rows_[impact.row];
    if (share < 1.0 && impact.Q > 0.0)
    {
      this->push(r, (share - 1.0) * (impact.Q * r.normal + impact.S));
    }
  }
  for (const Impact& impact : impacts_)
  {
    const Row& r = rows_[impact.row];
    RowStart& start = starts_[impact.row];
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
    book(r, share * impact.Q, share * impact.S, 0.5 * (impact.before + this->speedOf(r)),
      0.5 * (impact.beforeA + this->speedOfA(r)), result);
  }
}

void SoftSolver::wake(std::size_t manifold)
{
  for (std::size_t k = manifolds_[manifold][0]; k < manifolds_[manifold][1]; ++k)
  {
    Row& r = rows_[k];
    if (r.idle)
    {
      r.idle = false;
      woken_.push_back(k);
      if (this->place(r))
      {
        this->weigh(k);
      }
    }
  }
}

void SoftSolver::listWoken()
{
  if (woken_.empty())
  {
    return;
  }
  for (const std::size_t row : woken_)
  {
    const int strip = this->stripOf((*contacts_)[results_[row].contact]);
    busyOf_[std::size_t(strip)].push_back(row);
  }
  woken_.clear();
  this->forStrips(
    [this](std::size_t strip) { std::sort(busyOf_[strip].begin(), busyOf_[strip].end()); });
}

void SoftSolver::findStruck(int generation)
{
  if (!linked_)
  {
    this->link();
  }
  for (const int i : moving_)
  {
    for (std::size_t j = firstOf_[std::size_t(i)]; j < firstOf_[std::size_t(i) + 1]; ++j)
    {
      const std::size_t m = manifoldsOf_[j];
      RowStart& first = starts_[manifolds_[m][0]];
      if (first.generation == generation)
      {
        continue;
      }
      first.generation = generation;
      this->wake(m);
      if (this->strikes(m))
      {
        this->strike(m, struck_);
      }
    }
  }
  std::sort(struck_.begin(), struck_.end());
}

} // namespace rockfall
