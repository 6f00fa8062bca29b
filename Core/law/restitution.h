#pragma once

/// @file
/// Restitution that falls with the speed of the impact.

#include <algorithm>

namespace rockfall
{

/// Rn of the speed-dependent model: Rn / (1 + (v/K)²) (Pfeiffer & Bowen 1989). Speeds in m/s.
inline double restitutionAtSpeed(double restitution, double approachSpeed, double referenceSpeed)
{
  const double ratio = std::max(0.0, approachSpeed) / referenceSpeed;
  return restitution / (1.0 + ratio * ratio);
}

} // namespace rockfall
