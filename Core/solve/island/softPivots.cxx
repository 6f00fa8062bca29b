#include "solve/island/softPivots.h"

#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall::soft
{

void Pivots::warm(std::size_t m)
{
  const ContactRow& r = rows_.rows[all_[m].row];
  rows_.manifolds[m].pivots = r.P > 0.0 && !r.idle;
  if (rows_.manifolds[m].pivots)
  {
    movers_.twist(r, all_[m].M);
  }
}

void Pivots::find(std::size_t m, int pushing, std::size_t last)
{
  Manifold& manifold = rows_.manifolds[m];
  Pivot& pivot = all_[m];
  const bool before = manifold.pivots, same = before && pushing == 1 && pivot.row == last;
  if (before && !same)
  {
    movers_.twist(rows_.rows[pivot.row], -pivot.M);
  }
  manifold.pivots = pushing == 1 && manifold.b >= 0 && rows_.rows[last].friction > 0.0;
  if (!manifold.pivots)
  {
    return;
  }
  if (!same)
  {
    pivot.M.setZero();
    pivot.row = last;
  }
  const ContactRow& r = rows_.rows[last];
  const Mover &a = movers_[r.a], &b = movers_[r.b];
  const double radius = std::min(a.block->radius(), b.block->radius());
  pivot.inertia = 1.0 / (movers_.mobility(r.a) + movers_.mobility(r.b));
  const double patch = std::sqrt(r.P / (step_.h * std::numbers::pi * kCrushingStress));
  pivot.arm = 2.0 / 3.0 * r.friction * std::min(patch, kLargestPatch * radius);
}

void Pivots::relax(std::size_t m)
{
  Pivot& pivot = all_[m];
  const ContactRow& r = rows_.rows[pivot.row];
  Vec3 M = pivot.M -
    pivot.inertia *
      (movers_.motions[std::size_t(r.a)].spin - movers_.motions[std::size_t(r.b)].spin);
  limitTo(M, pivot.arm * r.P);
  movers_.twist(r, M - pivot.M);
  pivot.M = M;
}

void Pivots::book(std::size_t m)
{
  const Pivot& pivot = all_[m];
  const ContactRow& r = rows_.rows[pivot.row];
  const auto mean = [this](int i)
  {
    return Vec3(0.5 * (movers_.before[std::size_t(i)].spin + movers_.motions[std::size_t(i)].spin));
  };
  const Vec3 a = mean(r.a);
  rows_.results[pivot.row].frictionWork -= pivot.M.dot(a - mean(r.b));
  rows_.results[pivot.row].workOnA += pivot.M.dot(a);
}

} // namespace rockfall::soft
