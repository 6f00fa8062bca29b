#pragma once

/// @file
/// How an overlap that was found, not made, is pressed out of a lasting contact.
///
/// A loose overlap goes by less than the compression of the weight in each step, and the spring
/// hardly notices. A deep one goes at a stated speed: the spring is compressed by the way of one
/// lasting step just before it, the step takes the rock that far, and damps what the spring would
/// give besides. Such a compression must not outlast the step. It holds ½ k d², thousands of times
/// what a light rock on a stiff spring ever had, and an impact step would give that back.

#include "contact/Contact.h"
#include "law/settings.h"
#include "rock/parts/RockBody.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rockfall
{

/// Speed at which a deep overlap of a rock of this radius (m) is pressed out, m/s.
inline double deepSpeed(double gravity, double radius)
{
  return kRecoverDeep * std::min(1.0, std::sqrt(std::max(gravity, kLeastGravity) * radius));
}

/// After a step: a loose overlap, by `slow` (m). Returns what the spring holds less by it, J.
inline double recoverLooseOverlap(Contact& c, double slow, double loose)
{
  if (c.offset < -loose || c.offset == 0.0)
  {
    return 0.0;
  }
  const double held = c.springEnergy();
  c.offset = c.offset < 0.0 ? std::min(0.0, c.offset + slow) : std::max(0.0, c.offset - slow);
  return held - c.springEnergy();
}

/// Before a lasting step: an overlap deeper than `loose` (m), by `way` (m). Returns whether it is.
inline bool recoverDeepOverlap(Contact& c, double way, double loose)
{
  const bool deep = c.offset < -loose;
  c.offset = deep ? std::min(0.0, c.offset + way) : c.offset;
  return deep;
}

/// Lets a deep overlap be where a step has left its spring compressed by more than `most` (m).
/// Returns the energy that the spring then no longer holds, J.
inline double limitOverlap(Contact& c, double most, double loose)
{
  const double gap = c.gap();
  if (!c.closed() || c.offset >= -loose || gap >= -most)
  {
    return 0.0;
  }
  c.offset = c.distance + most;
  return 0.5 * c.stiffness * (gap * gap - most * most);
}

/// Whether one overlaps deeper than `loose` (m).
inline bool anyDeep(const std::vector<Contact>& contacts, double loose)
{
  return std::any_of(contacts.begin(), contacts.end(),
    [&](const Contact& c) { return c.closed() && c.offset < -loose; });
}

/// The same for the shear spring of any contact beside a deep overlap. A rock that is jammed
/// between two cannot follow what presses one of them out, and would wind up the other's spring by
/// a little in every step.
inline double limitSlip(Contact& c, double most)
{
  const double slip = c.slip.norm();
  if (!c.closed() || !(slip > most))
  {
    return 0.0;
  }
  c.slip *= most / slip;
  return 0.5 * c.shearStiffness * (slip * slip - most * most);
}

/// The overlaps of one rock with the slope, step by step.
class OverlapRecovery
{
public:
  OverlapRecovery(double gravity, double normalPenalty)
    : gravity_(gravity)
    , normalPenalty_(normalPenalty)
  {
  }

  /// Deep ones, before a lasting step of `h` (s).
  void beforeStep(RockBody& body, double h);
  /// Whether one was pressed out in the step at hand; asked once, after it.
  bool drainRecovered();
  /// Loose ones, after it.
  void afterStep(RockBody& body, double h) const;
  /// No spring in an overlap deeper than `loose` (m) holds more than at the speed (m/s) that springs
  /// give a rock that lies still and alone. Returns what it no longer holds, J.
  static double limit(RockBody& body, double loose, double settledSpeed);
  /// Depth from which an overlap is deep, m.
  static double looseOf(const RockBody& body);

private:
  double gravity_;          ///< m/s²
  double normalPenalty_;    ///< N/m
  bool recovering_ = false; ///< A deep overlap is pressed out in the step at hand.
};

} // namespace rockfall
