#pragma once

/// @file
/// Bodies and contacts of a step of rocks that touch each other, as asked and as answered.

#include "block/Block.h"
#include "contact/Contact.h"
#include "law/restitution.h"
#include "law/settings.h"
#include "law/springs.h"
#include "solve/step/StepSolver.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rockfall
{

/// Bodies and rows that one thread looks after at a time.
constexpr std::size_t kBodyGrain = 64, kRowGrain = 256;

/// Substeps of a step of `h` (s).
inline int substepsOf(double h, double timeStep)
{
  return std::max(1, int(std::ceil(kSubsteps * h / timeStep - 1e-6)));
}

struct IslandBody
{
  const Block* block = nullptr;
  BlockState* state = nullptr;
  double given = 0.0;  ///< Out: work that this rock did on other rocks in the step, J.
  StepOutcome onSlope; ///< Out: books of its contacts with the slope.
};

struct IslandContact
{
  Contact* contact = nullptr;
  int first = -1;
  int second = -1;               ///< −1: the slope.
  double friction = 0.0;         ///< tan φ
  double cohesion = 0.0;         ///< N
  double damping = 0.0;          ///< ζ along the normal, if it is between rocks.
  double restitution = 0.0;      ///< Newton's e of what closes faster than `resting`.
  double restitutionSpeed = 0.0; ///< > 0: K of e / (1 + (v/K)²), m/s.
  double resting = 0.0;          ///< Below it a touch is no impact, m/s.
  /// ≥ 0: speed along the normal at which an impact that is under way leaves, m/s.
  double reboundSpeed = -1.0;
  double work = 0.0;     ///< Out: what it took from the rocks' motion, springs included, J.
  double opening = 0.0;  ///< Out, if it carried: how far it opened along the normal, m.
  double struck = 0.0;   ///< Out: greatest speed at which it closed as an impact, m/s.
  double struckAt = 0.0; ///< Out: when that was, from the step's beginning, s,
  Vec3 struckPoint = Vec3::Zero(); ///< and where, m.
  /// Value of contact->closed() when the step begins; for whoever set the contact up and goes over
  /// all of them.
  bool closed = false;
  bool absent = false; ///< Let go for this step (SoftSolver::setAbsent): nothing holds it up.
  bool bare = false;   ///< Between rocks, gets its springs from the step that it carries in.

  double restitutionAt(double speed) const ///< Of what closes at this speed, m/s.
  {
    return restitutionSpeed > 0.0 ? restitutionAtSpeed(restitution, speed, restitutionSpeed)
                                  : restitution;
  }
};

/// Result of a look at where a step would end (SoftSolver).
struct EndDetectionOutcome
{
  double missed = 0.0; ///< Deepest overlap without a contact, of a radius; 0: none.
  /// Overlap, of a radius, by which rocks have come deeper into each other where no contact can
  /// hold them: along its normal they were as deep in the beginning, too. A shorter step may find
  /// another one.
  double passed = 0.0;
  bool again = false; ///< Contacts were let go or set in again: one more look is due.
  bool any() const { return missed > 0.0 || again; }
  bool asksFor(int look) const ///< Whether one is due after so many.
  {
    return look < kMissLooks || again || (look <= kMostMissLooks && missed > kWorthALook);
  }
  /// Whether the look after so many others finds out only how deep what it has missed is.
  bool onlyTells(int look) const { return look >= kMostMissLooks && !again; }
  bool isDeep() const { return std::max(missed, passed) > kDeepMiss; }
};

/// The bounce of a closed contact whose impact is under way, m/s: how it would leave by itself.
/// `approach`: speed at which it closes now.
inline double bounceLeft(const Contact& c, double approach)
{
  const double depth = -std::min(0.0, c.gap());
  return leavingSpeed(c.stiffness, c.dashpot, c.stopped, depth, approach);
}

/// Solutions of a step that are accepted.
enum class Accept : std::uint8_t
{
  Settled,
  Any,
};

struct IslandOutcome
{
  bool settled = false;      ///< No rocks are deep in each other that were not.
  bool accepted = false;     ///< Bodies and contacts are those at the end of the step.
  int iterations = 0;        ///< Substeps.
  double frictionWork = 0.0; ///< Between rocks, J.
  double dampedWork = 0.0;   ///< Between rocks, J.
};

} // namespace rockfall
