// Moments of rocks that push each other at one point only.
//
// A corner under the load N is crushed to a patch of radius a that bears it, N = π a² σ. The
// friction of a patch that is pressed evenly holds 2/3 μ a N against spin about its normal. The
// same is taken against tipping over it: half of the patch carries then, and its centre of
// pressure is 0.4 to 0.6 a away. Rocks that touch at several points have longer arms.

#include "law/settings.h"
#include "solve/island/softSweep.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

void SoftSolver::warmPivot(std::size_t m)
{
  const ContactRow& r = rows_[pivots_[m].row];
  manifolds_[m].pivots = r.P > 0.0 && !r.idle;
  if (manifolds_[m].pivots)
  {
    this->twist(r, pivots_[m].M);
  }
}

void SoftSolver::findPivot(std::size_t m, int pushing, std::size_t last)
{
  Manifold& manifold = manifolds_[m];
  Pivot& pivot = pivots_[m];
  const bool before = manifold.pivots, same = before && pushing == 1 && pivot.row == last;
  if (before && !same)
  {
    this->twist(rows_[pivot.row], -pivot.M);
  }
  manifold.pivots = pushing == 1 && manifold.b >= 0 && rows_[last].friction > 0.0;
  if (!manifold.pivots)
  {
    return;
  }
  if (!same)
  {
    pivot.M.setZero();
    pivot.row = last;
  }
  const ContactRow& r = rows_[last];
  const Mover &a = movers_[std::size_t(r.a)], &b = movers_[std::size_t(r.b)];
  const double radius = std::min(a.block->radius(), b.block->radius());
  pivot.inertia = 1.0 / (this->mobility(r.a) + this->mobility(r.b));
  const double patch = std::sqrt(r.P / (h_ * std::numbers::pi * kCrushingStress));
  pivot.arm = 2.0 / 3.0 * r.friction * std::min(patch, kLargestPatch * radius);
}

void SoftSolver::relax(Pivot& pivot)
{
  const ContactRow& r = rows_[pivot.row];
  Vec3 M =
    pivot.M - pivot.inertia * (motions_[std::size_t(r.a)].spin - motions_[std::size_t(r.b)].spin);
  limitTo(M, pivot.arm * r.P);
  this->twist(r, M - pivot.M);
  pivot.M = M;
}

void SoftSolver::bookPivot(const Pivot& pivot)
{
  const ContactRow& r = rows_[pivot.row];
  const auto mean = [this](int i)
  { return Vec3(0.5 * (before_[std::size_t(i)].spin + motions_[std::size_t(i)].spin)); };
  const Vec3 a = mean(r.a);
  results_[pivot.row].frictionWork -= pivot.M.dot(a - mean(r.b));
  results_[pivot.row].workOnA += pivot.M.dot(a);
}

} // namespace rockfall
