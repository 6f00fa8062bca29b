#pragma once

/// @file
/// How long a way takes, and how far a turn goes.

#include "base/types.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rockfall
{

/// Smallest t ≥ 0 with rate·t + ½ acceleration·t² = distance (rate may be negative: receding), s; 0
/// if there is no distance left, ∞ if it is never covered.
inline double timeToCover(double distance, double rate, double acceleration)
{
  if (distance <= 0.0)
  {
    return 0.0;
  }
  if (acceleration <= 0.0)
  {
    return rate > 0.0 ? distance / rate : std::numeric_limits<double>::infinity();
  }
  const double root = std::sqrt(rate * rate + 2.0 * acceleration * distance);
  return rate > 0.0 ? 2.0 * distance / (rate + root) : (root - rate) / acceleration;
}

/// Longest way of a point within `radius` (m) of the centre of a turn from one orientation to
/// another, m: no less than it is, and hardly more if the turn is small.
inline double rimTravel(const Quat& from, const Quat& to, double radius)
{
  return 2.0 * radius *
    std::min((to.coeffs() - from.coeffs()).norm(), (to.coeffs() + from.coeffs()).norm());
}

} // namespace rockfall
