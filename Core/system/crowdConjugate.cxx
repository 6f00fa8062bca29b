// Fewer sweeps of a crowd: between two of them it goes on along a conjugate direction.
//
// A sweep of Gauss–Seidel from forces f leads to f + d; d is taken for a step down a gradient, and
// the directions p of such steps are made conjugate as Fletcher and Reeves do: nonsmooth nonlinear
// conjugate gradients (Silcowitz, Niebe & Erleben 2010, The Visual Computer 26, 893). Displacements
// are linear in the forces, and go on in proportion with them. What a step leaves is what its last
// sweep made of it, so that forces are always within their cones.

#include "system/CrowdSolver.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rockfall
{

namespace
{

constexpr int kMoverBlock = 64;
constexpr std::size_t kBatchBlock = 64;

std::array<double*, 6> placesOf(crowd::Mover& m)
{
  return { m.way, m.way + 1, m.way + 2, m.turn, m.turn + 1, m.turn + 2 };
}

} // namespace

void CrowdSolver::begin()
{
  forcesBefore_ = forces_;
  forcesAlong_.assign(forces_.size(), crowd::Forces{});
  before_.resize(work_.size());
  along_.assign(work_.size(), Way{});
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    const crowd::Mover& m = movers_[i];
    before_[i] = { { m.way[0], m.way[1], m.way[2], m.turn[0], m.turn[1], m.turn[2] } };
  }
  lastChange_ = -1.0;
}

double CrowdSolver::changeOf(int first) const
{
  // In the norm of kinetic energy, with a ball's inertia for that of each rock.
  double sum = 0.0;
  const int end = std::min(first + kMoverBlock, int(work_.size()));
  for (int i = first; i < end; ++i)
  {
    const crowd::Mover& m = movers_[std::size_t(i)];
    const std::array<double, 6>& was = before_[std::size_t(i)].of;
    double way = 0.0, turn = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      way += (m.way[k] - was[std::size_t(k)]) * (m.way[k] - was[std::size_t(k)]);
      turn += (m.turn[k] - was[std::size_t(k) + 3]) * (m.turn[k] - was[std::size_t(k) + 3]);
    }
    const double mobile = m.inertia[0] + m.inertia[1] + m.inertia[2];
    sum += way / m.way[3] + 3.0 * turn / mobile;
  }
  return sum;
}

void CrowdSolver::goFurther()
{
  const int movers = int(work_.size());
  changes_.resize(std::size_t((movers + kMoverBlock - 1) / kMoverBlock));
  forEach(
    changes_.size(), 4, [&](std::size_t b) { changes_[b] = this->changeOf(int(b) * kMoverBlock); });
  const double change = std::accumulate(changes_.begin(), changes_.end(), 0.0);
  // Where it does not get smaller it begins anew.
  const bool first = lastChange_ < 0.0, anew = !first && !(change <= lastChange_);
  const double share = first || anew || change <= 0.0 ? 0.0 : change / lastChange_;
  lastChange_ = change;
  const auto forcesOf = [&](std::size_t block)
  {
    const std::size_t end = std::min((block + 1) * kBatchBlock, forces_.size());
    for (std::size_t k = block * kBatchBlock; k < end; ++k)
    {
      double* now = forces_[k].along[0];
      double* was = forcesBefore_[k].along[0];
      double* along = forcesAlong_[k].along[0];
      for (int i = 0; i < 3 * crowd::kLanes; ++i)
      {
        const double step = now[i] - was[i], further = share * along[i];
        was[i] = now[i] += further;
        along[i] = anew ? 0.0 : further + step;
      }
    }
  };
  forEach((forces_.size() + kBatchBlock - 1) / kBatchBlock, 4, forcesOf);
  const double quiet = kQuiet * enough_;
  const auto moverOf = [&](std::size_t i)
  {
    const std::array<double*, 6> now = placesOf(movers_[i]);
    double most = 0.0;
    for (std::size_t k = 0; k < 6; ++k)
    {
      double &was = before_[i].of[k], &along = along_[i].of[k];
      const double step = *now[k] - was, further = share * along;
      was = *now[k] += further;
      along = anew ? 0.0 : further + step;
      most = std::max(most, std::abs(further));
    }
    if (most > quiet)
    {
      changed_[i] = sweep_ - 1; // since the last visit
    }
  };
  forEach(work_.size(), kBodyGrain, moverOf);
}

} // namespace rockfall
