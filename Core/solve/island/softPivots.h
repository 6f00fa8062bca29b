#pragma once

/// @file
/// Moments of rocks that push each other at one point only.
///
/// A corner under the load N is crushed to a patch of radius a that bears it, N = π a² σ. The
/// friction of a patch that is pressed evenly holds 2/3 μ a N against spin about its normal. The
/// same is taken against tipping over it: half of the patch carries then, and its centre of
/// pressure is 0.4 to 0.6 a away. Rocks that touch at several points have longer arms.

#include "solve/island/softRows.h"

#include <vector>

namespace rockfall::soft
{

/// What a manifold that pivots does against its rocks' turning about its point.
struct Pivot
{
  Vec3 M;          ///< Impulse of the moment, on a, N m s.
  std::size_t row; ///< Which pushes.
  double inertia;  ///< Effective, kg m².
  double arm;      ///< M within arm · P, m.
};

class Pivots
{
public:
  Pivots(const Step& step, Movers& movers, Rows& rows)
    : step_(step)
    , movers_(movers)
    , rows_(rows)
  {
  }

  void resize() { all_.resize(rows_.manifolds.size()); }
  /// Begins with the moment of the last substep.
  void warm(std::size_t manifold);
  /// Whether a manifold pivots: `pushing` of its rows push, `last` the last of them.
  void find(std::size_t manifold, int pushing, std::size_t last);
  void relax(std::size_t manifold);
  void book(std::size_t manifold); ///< What the moment takes.

private:
  const Step& step_;
  Movers& movers_;
  Rows& rows_;
  std::vector<Pivot> all_; ///< By manifold.
};

} // namespace rockfall::soft
