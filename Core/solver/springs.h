#pragma once

/// @file
/// The one-sided normal spring of a contact over a step.

#include <algorithm>
#include <cmath>

namespace rockfall
{

/// Force, its stiffness and the part of the step in which the spring is compressed.
struct NormalSpring
{
  double force = 0.0;     ///< Mean over the step, N, ≥ 0.
  double stiffness = 0.0; ///< −∂force/∂d₁, N/m, ≥ 0.
  double share = 1.0;     ///< Dimensionless, 0 … 1.
};

/// The discrete gradient of V(d) = ½ p min(d, 0)²: force · (d₁ − d₀) = V(d₀) − V(d₁) to the last
/// digit, whether the spring closes, opens or stays closed (Gonzalez 1996 for the idea).
inline NormalSpring conservingSpring(double p, double d0, double d1)
{
  NormalSpring s;
  if (d0 <= 0.0 && d1 <= 0.0)
  {
    s.force = -0.5 * p * (d0 + d1);
    s.stiffness = 0.5 * p;
  }
  else if (d0 > 0.0 && d1 > 0.0)
  {
    s.share = 0.0;
  }
  else if (d0 <= 0.0)
  {
    // Opens on the way.
    const double way = d1 - d0;
    s.force = 0.5 * p * d0 * d0 / way;
    s.stiffness = s.force / way;
    s.share = -d0 / way;
  }
  else
  {
    // Closes on the way.
    const double way = d0 - d1;
    s.force = 0.5 * p * d1 * d1 / way;
    s.stiffness = -0.5 * p * d1 * (2.0 * d0 - d1) / (way * way);
    s.share = -d1 / way;
  }
  return s;
}

/// Blends the conserving force with Shi's force at the end of the step: `damped` = 0 … 1.
inline NormalSpring normalSpring(double p, double d0, double d1, double damped)
{
  if (damped == 0.0)
  {
    return conservingSpring(p, d0, d1);
  }
  NormalSpring s;
  s.force = d1 < 0.0 ? -p * d1 : 0.0;
  s.stiffness = d1 < 0.0 ? p : 0.0;
  s.share = d1 < 0.0 ? 1.0 : 0.0;
  return s;
}

} // namespace rockfall
