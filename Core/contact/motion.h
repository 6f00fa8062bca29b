#pragma once

/// @file
/// How long a way takes.

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

} // namespace rockfall
