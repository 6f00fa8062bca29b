// Fewer sweeps of a crowd: between two of them it goes on along a conjugate direction.
//
// A sweep of Gauss–Seidel from forces f leads to f + d; d is taken for a step down a gradient, and
// the directions p of such steps are made conjugate as Fletcher and Reeves do: nonsmooth nonlinear
// conjugate gradients (Silcowitz, Niebe & Erleben 2010, The Visual Computer 26, 893). Displacements
// are linear in the forces, and go on in proportion with them. What a step leaves is what its last
// sweep made of it, so that forces are always within their cones.

#include "solve/island/CrowdSolver.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace rockfall
{

namespace
{

/// Rocks of a share of them all, and shares at most.
constexpr std::size_t kRocks = 64, kMostShares = 64;

} // namespace

void CrowdSolver::begin()
{
  forcesBefore_ = forces_;
  forcesAlong_.assign(forces_.size(), crowd::Forces{});
  before_.resize(work_.size());
  along_.assign(work_.size(), crowd::Motion{});
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    const crowd::Mover& m = movers_[i];
    std::copy(std::begin(m.displacement), std::end(m.displacement), before_[i].displacement);
    std::copy(std::begin(m.turn), std::end(m.turn), before_[i].turn);
  }
  lastChange_ = -1.0;
}

void CrowdSolver::extrapolate()
{
  // Rocks are in order along the island: who goes over a share of them has the same strips to
  // sweep.
  const std::size_t shares = std::clamp(work_.size() / kRocks, std::size_t(1), kMostShares);
  const auto forShares = [count = work_.size(), shares](auto&& go)
  {
    const auto goShare = [&](std::size_t share)
    {
      const std::size_t from = share * count / shares;
      go(share, from, (share + 1) * count / shares - from);
    };
    forEach(shares, 1, goShare);
  };
  changes_.resize(shares);
  const auto changeOf = [&](std::size_t share, std::size_t from, std::size_t count)
  { changes_[share] = kernel_->changeOf(&movers_[from], &before_[from], int(count)); };
  forShares(changeOf);
  const double change = std::accumulate(changes_.begin(), changes_.end(), 0.0);
  // Where it does not get smaller it begins anew.
  const bool first = lastChange_ < 0.0, anew = !first && !(change <= lastChange_);
  further_.share = first || anew || change <= 0.0 ? 0.0 : change / lastChange_;
  further_.anew = anew;
  further_.quiet = quiet_;
  further_.number = sweep_ - 1; // since the last visit
  lastChange_ = change;
  const auto goMovers = [&](std::size_t, std::size_t from, std::size_t count)
  {
    kernel_->goMovers(
      further_, &movers_[from], &before_[from], &along_[from], &changed_[from], count);
  };
  forShares(goMovers);
  goingFurther_ = true; // forces follow strip by strip, where they are visited next
}

void CrowdSolver::extrapolate(int strip)
{
  const auto go = [&](std::size_t first, std::size_t count)
  {
    kernel_->goForces(further_, forces_.data() + first, forcesBefore_.data() + first,
      forcesAlong_.data() + first, count);
  };
  this->forUsed(strip, go);
}

} // namespace rockfall
