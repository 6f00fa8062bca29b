#pragma once

/// @file
/// Bodies and contacts of a step of rocks that touch each other, as asked and as answered.

#include "block/Block.h"
#include "contact/Contact.h"
#include "law/contactLaw.h"
#include "law/settings.h"
#include "law/springs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace rockfall
{

/// Bodies and rows that one thread looks after at a time.
constexpr std::size_t kBodyGrain = 64, kRowGrain = 256;

struct IslandBody
{
  const Block* block = nullptr;
  BlockState* state = nullptr;
  Vec3 acceleration = Vec3::Zero();     ///< Of the last step, world, m/s².
  Vec3 spinAcceleration = Vec3::Zero(); ///< Of the spin, body axes, rad/s².
  double given = 0.0; ///< Out: work that this rock did on other rocks in the step, J.
  double frictionWork = 0.0, dampedWork = 0.0;   ///< Out: on the slope, J.
  double springEnergy = 0.0, normalEnergy = 0.0; ///< Out: of its contacts with the slope, J.
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
  double approach = 0.0;         ///< Speed at which it closes, m/s.
  /// ≥ 0: speed along the normal at which it leaves, m/s: closed, the impact is under way; open (in
  /// a crowd), it closes as an impact.
  double reboundSpeed = -1.0;
  double work = 0.0;     ///< Out: what it took from the rocks' motion, springs included, J.
  double opening = 0.0;  ///< Out, if it carried: how far it opened along the normal, m.
  double struck = 0.0;   ///< Out: greatest speed at which it closed as an impact, m/s.
  double struckAt = 0.0; ///< Out: when that was, from the step's beginning, s,
  Vec3 struckPoint = Vec3::Zero(); ///< and where, m.
  /// Value of contact->closed() when the step begins; for whoever set the contact up and goes over
  /// all of them.
  bool closed = false;
  bool absent = false; ///< Let go for this step (IslandSystem::setAbsent): nothing holds it up.
  /// Has no springs: it mayStayOpen, and a solver that takes it for speculative gives it some when
  /// it closes.
  bool bare = false;

  double restitutionAt(double speed) const ///< Of what closes at this speed, m/s.
  {
    const double ratio = restitutionSpeed > 0.0 ? speed / restitutionSpeed : 0.0;
    return restitution / (1.0 + ratio * ratio);
  }
};

/// Result of a look at where a step would end (IslandSolver).
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

/// Whether a contact is open and stays so in a step of `h` (s) unless its rocks are pushed: for
/// Gauss–Seidel it is speculative, and it needs no springs before it closes.
inline bool mayStayOpen(const IslandContact& k, double h)
{
  return !k.closed && k.reboundSpeed < 0.0 && k.contact->gap() > h * k.approach;
}

/// Speed at which the mass that a closed contact stops came in, or leaves again if nothing more is
/// lost, m/s: the spring holds what is missing of it. `approach`: speed at which it closes now.
inline double elasticSpeed(const Contact& c, double approach)
{
  return std::hypot(approach, std::sqrt(c.stiffness / c.stopped) * std::min(0.0, c.gap()));
}

/// The bounce of a closed contact whose impact is under way, m/s: how it would leave by itself.
inline double bounceLeft(const Contact& c, double approach)
{
  const double depth = -std::min(0.0, c.gap());
  return leavingSpeed(c.stiffness, c.dashpot, c.stopped, depth, approach);
}

/// Solutions of a step that are accepted.
enum class Accept : std::uint8_t
{
  Settled,
  Converging, ///< Solutions of Gauss–Seidel, too, that are not far from settled.
  Any,
};

struct IslandOutcome
{
  bool settled = false;
  bool unconverged = false;  ///< Far from settled; counted where it is accepted.
  bool accepted = false;     ///< Bodies and contacts are those at the end of the step.
  int iterations = 0;        ///< Of open–close.
  double residual = 0.0;     ///< Largest |Δ gap| of the last correction, m.
  double frictionWork = 0.0; ///< Between rocks, J.
  double dampedWork = 0.0;   ///< Between rocks, J.
};

/// The gap at the start of a step of `h` (s) that makes a contact leave as its bounce asks for.
/// `turned`: stiffness times mobility along the normal; the spring misses a gap by so much of what
/// it has to turn round, which is added to it.
inline double bounceGap(const IslandContact& contact, double h, double turned)
{
  return -h * (contact.reboundSpeed + (contact.approach + contact.reboundSpeed) / turned);
}

/// Change of a gap at the start (m) if the one at the end is found to be another one than
/// reckoned. No contact is asked to open further than it was.
inline double gapChange(double gap0, double reckoned, double found)
{
  return std::max(std::min(0.0, gap0) - gap0, found - reckoned);
}

/// Lower bounce of a contact, m/s, if it gives the rocks energy. Newton's law asks for a speed
/// along the normal, whatever friction does: where that turns the velocity across the normal round,
/// as it can under a long lever, both together may give more than was there (Kane & Levinson 1985).
/// And a bounce that goes on with an impact under way gives back what its spring holds; against the
/// load of others the same speed would take more. An impulse P does the work P · ½ (v + v′).
/// `force` (N) and velocities before and after a step of `h` (s; m/s) are along the normal and the
/// tangents. Negative if nothing is to be changed.
inline double heldBounce(
  const IslandContact& contact, double h, const Vec3& force, const Vec3& before, const Vec3& after)
{
  const Vec3 twice = before + after;
  const Contact& c = *contact.contact;
  const double across = force.tail<2>().dot(twice.tail<2>());
  const double came = contact.closed ? elasticSpeed(c, contact.approach) : contact.approach;
  const double given = across + force[0] * twice[0] - 2.0 * c.springEnergy() / h;
  const bool may = contact.reboundSpeed > 0.0 && (contact.closed || across > 0.0);
  return may && given > (contact.closed ? kBounceGainOn : kBounceGain) * force[0] * came
    ? std::max(0.0, contact.reboundSpeed - given / force[0])
    : -1.0;
}

/// Energies of a contact in a step, J.
struct ContactBooks
{
  std::array<double, 2> done = {}; ///< Work of its force on the two rocks, if it is between rocks.
  double frictionWork = 0.0, dampedWork = 0.0;
  double normalEnergy = 0.0, springEnergy = 0.0; ///< In it at the end.
};

/// Motion of a contact's point on its two rocks in a step.
struct ContactMotion
{
  std::array<Vec3, 2> means; ///< ½ h (v₀ + v₁), m: a force over the step does its work on it.
  Vec3 displacement = Vec3::Zero(); ///< First less second along the normal and the tangents, m.
};

/// Writes a contact after a step: forces, gap, state and slip. `law` is as evaluated, with the
/// forces that the rocks were moved with; `directions` its normal and tangents; `gap0` the gap at
/// the start without what a bounce asks for.
///
/// A lasting step's displacement is h v₁. What an impulse P takes from rocks that move at v₀ and
/// leave at v₁ is −P · ½ (v₀ + v₁), though; the rest is booked as damped along the normal, as
/// friction across.
ContactBooks writeContact(const ContactLaw& law, const std::array<Vec3, 3>& directions,
  const ContactMotion& motion, double gap0, IslandContact& contact);

/// Adds the books of all contacts, in their order, to those of the bodies.
void addBooks(const std::vector<IslandContact>& contacts, const std::vector<ContactBooks>& books,
  std::vector<IslandBody>& bodies, IslandOutcome& outcome);

} // namespace rockfall
