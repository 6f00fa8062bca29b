#pragma once

/// @file
/// The one-sided normal spring of a contact over a step, with the dashpot that makes a coefficient
/// of restitution of it.

#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

/// With a dashpot beside the spring while it is compressed, c · (change of compression) / h, and no
/// tension ever. `rate`: c/h, N/m.
inline NormalSpring dampedSpring(double p, double rate, double d0, double d1)
{
  NormalSpring s = conservingSpring(p, d0, d1);
  if (rate > 0.0)
  {
    s.force += rate * (std::min(d0, 0.0) - std::min(d1, 0.0));
    s.stiffness += d1 < 0.0 ? rate : 0.0;
    if (s.force <= 0.0)
    {
      s = { 0.0, 0.0, 0.0 };
    }
  }
  return s;
}

/// A dashpot (N s/m) as it acts over a step of `h` (s) on the mass that it stops (kg). By the mean
/// velocity of the step more than this would turn the mass round, not stop it.
inline double dashpotOver(double h, double dashpot, double stopped)
{
  return std::min(dashpot, 2.0 * stopped / h);
}

/// Shi's: the force at the end of the step.
inline NormalSpring endSpring(double p, double d1)
{
  return d1 < 0.0 ? NormalSpring{ -p * d1, p, 1.0 } : NormalSpring{ 0.0, 0.0, 0.0 };
}

/// Damping ratio ζ of a mass on a spring and a dashpot, c = 2 ζ √(p m), that comes back with e
/// times its speed when it may leave as soon as the force is no longer a push: e = exp(−2 ζ acos ζ
/// / √(1 − ζ²)), for ζ > 1 with acosh and √(ζ² − 1) (Schwager & Pöschel 2007, Granular Matter 9,
/// 465, for the condition of no tension). Between 0.01 and 1; below, as for 0.01.
double dampingRatio(double restitution);

/// The speed at which a mass (kg) leaves such a spring (N/m) and dashpot (N s/m) that is being
/// pressed together by `depth` (m) and closes at `approach` (m/s, < 0: opens), m/s: its velocity v
/// obeys the same equation as its place, and is what it is when the force is no longer a push, v′ =
/// 0.
inline double leavingSpeed(
  double spring, double dashpot, double mass, double depth, double approach)
{
  const double w = std::sqrt(spring / mass);
  double z = dashpot / (2.0 * mass * w);
  z = std::abs(z - 1.0) < 1e-6 ? 1.0 + 1e-6 : z;
  const double a = -w * (w * depth + 2.0 * z * approach); // v′ now
  if (!(w > 0.0) || a > 0.0)
  {
    return std::max(0.0, -approach);
  }
  const double s = w * std::sqrt(std::abs(1.0 - z * z));
  const double sine = a * s, cosine = w * (w * approach + z * a);
  const double along = (a + z * w * approach) / s;
  if (z < 1.0)
  {
    const double turn = std::atan2(sine, cosine) + std::numbers::pi;
    return std::max(
      0.0, -std::exp(-z * w * turn / s) * (approach * std::cos(turn) + along * std::sin(turn)));
  }
  const double ratio = sine / cosine;
  if (!(ratio > 0.0 && ratio < 1.0))
  {
    return 0.0; // it only creeps out
  }
  const double turn = std::atanh(ratio);
  return std::max(
    0.0, -std::exp(-z * w * turn / s) * (approach * std::cosh(turn) + along * std::sinh(turn)));
}

} // namespace rockfall
