#pragma once

/// @file
/// The dashpots of contacts that stop a motion together.
///
/// A dashpot of 2 ζ k / ω makes the coefficient of restitution that ζ stands for if ω is the
/// frequency of what comes against the spring. A contact alone feels the mobility of its own point.
/// Several at a time feel what they stop together: four corners of a plate that falls on its face
/// stop its mass, though each alone would turn it. That is Rayleigh's quotient for springs that are
/// compressed in proportion to the speeds at which they come in, ω² = fᵀ M⁻¹ f / Σ k v², with f the
/// forces k v of all of them. Dashpots in proportion to the springs then damp nothing else.

#include "contact/Contact.h"
#include "contact/PlacedBlock.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rockfall
{

/// Response of a body to a force and its moment about `at` (N, N m): fᵀ M⁻¹ f, N² / kg.
inline double response(
  const PlacedBlock& body, const Vec3& force, const Vec3& moment, const Vec3& at)
{
  const Vec3 turning = body.rotation().transpose() * (moment + (at - body.position()).cross(force));
  return force.squaredNorm() / body.block().mass() +
    turning.dot(body.block().inverseInertia() * turning);
}

/// Of contacts that close within a step of `h` (s), armed as if each were alone. `approachOf`: how
/// fast one comes in along its normal, m/s; `responseTo`: as `response`, of all bodies.
template <typename Approach, typename Response>
void tuneDashpots(
  std::vector<Contact>& contacts, double h, const Approach& approachOf, const Response& responseTo)
{
  const auto stops = [h](const Contact& c, double approach)
  { return c.closed() || (approach > 0.0 && c.gap() < approach * h); };
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero(), at = Vec3::Zero();
  double work = 0.0;
  int count = 0;
  bool damped = false;
  for (const Contact& c : contacts)
  {
    const double approach = approachOf(c);
    if (!stops(c, approach))
    {
      continue;
    }
    at = count++ == 0 ? c.point : at;
    const Vec3 f = c.stiffness * approach * c.normal;
    force += f;
    moment += (c.point - at).cross(f);
    work += c.stiffness * approach * approach;
    damped = damped || (!c.closed() && c.dashpot > 0.0);
  }
  if (count < 2 || !damped || !(work > 0.0))
  {
    return;
  }
  const double frequency2 = responseTo(force, moment, at) / work;
  for (Contact& c : contacts)
  {
    if (!c.closed() && stops(c, approachOf(c)))
    {
      const double together2 = std::max(frequency2, kLowestImpactMode * c.frequency2);
      c.dashpot *= std::sqrt(c.frequency2 / together2);
      c.stopped = c.stiffness / together2;
    }
  }
}

} // namespace rockfall
