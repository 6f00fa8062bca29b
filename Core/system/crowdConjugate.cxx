// Fewer sweeps of a crowd: between two of them it goes on along a conjugate direction.
//
// A sweep of Gauss–Seidel from forces f leads to f + d; d is taken for a step down a gradient, and
// the directions p of such steps are made conjugate as Fletcher and Reeves do: nonsmooth nonlinear
// conjugate gradients (Silcowitz, Niebe & Erleben 2010, The Visual Computer 26, 893). Displacements
// are linear in the forces, and go on in proportion with them. What a step leaves is what its last
// sweep made of it, so that forces are always within their cones.

#include "system/CrowdSolver.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace rockfall
{

namespace
{

/// Rocks, or batches of contacts, that are gone over at once.
constexpr std::size_t kBlock = 64, kGrain = 4;

} // namespace

void CrowdSolver::begin()
{
  forcesBefore_ = forces_;
  forcesAlong_.assign(forces_.size(), crowd::Forces{});
  before_.resize(work_.size());
  along_.assign(work_.size(), crowd::Way{});
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    const crowd::Mover& m = movers_[i];
    std::copy(std::begin(m.way), std::end(m.way), before_[i].way);
    std::copy(std::begin(m.turn), std::end(m.turn), before_[i].turn);
  }
  lastChange_ = -1.0;
}

void CrowdSolver::goFurther()
{
  const std::size_t movers = work_.size(), forces = forces_.size();
  const auto blocksOf = [](std::size_t count) { return (count + kBlock - 1) / kBlock; };
  const auto inBlock = [](std::size_t block, std::size_t count, auto&& go)
  { go(block * kBlock, std::min((block + 1) * kBlock, count) - block * kBlock); };
  changes_.resize(blocksOf(movers));
  const auto compare = [&](std::size_t block)
  {
    const auto changeOf = [&](std::size_t first, std::size_t count)
    { changes_[block] = kernel_->changeOf(&movers_[first], &before_[first], int(count)); };
    inBlock(block, movers, changeOf);
  };
  forEach(changes_.size(), kGrain, compare);
  const double change = std::accumulate(changes_.begin(), changes_.end(), 0.0);
  // Where it does not get smaller it begins anew.
  const bool first = lastChange_ < 0.0, anew = !first && !(change <= lastChange_);
  crowd::Further further;
  further.share = first || anew || change <= 0.0 ? 0.0 : change / lastChange_;
  further.anew = anew;
  further.quiet = quiet_;
  further.number = sweep_ - 1; // since the last visit
  lastChange_ = change;
  const auto goForces = [&](std::size_t from, std::size_t count)
  { kernel_->goForces(further, &forces_[from], &forcesBefore_[from], &forcesAlong_[from], count); };
  const auto goMovers = [&](std::size_t from, std::size_t count)
  {
    kernel_->goMovers(
      further, &movers_[from], &before_[from], &along_[from], &changed_[from], count);
  };
  const std::size_t ofMovers = changes_.size();
  const auto go = [&](std::size_t block)
  {
    if (block < ofMovers)
    {
      inBlock(block, movers, goMovers);
    }
    else
    {
      inBlock(block - ofMovers, forces, goForces);
    }
  };
  forEach(ofMovers + blocksOf(forces), kGrain, go);
}

} // namespace rockfall
