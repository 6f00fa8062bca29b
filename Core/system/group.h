#pragma once

/// @file
/// What a step of rocks that touch each other is asked with and answers: bodies and contacts.

#include "block/Block.h"
#include "contact/Contact.h"

namespace rockfall
{

struct GroupBody
{
  const Block* block = nullptr;
  BlockState* state = nullptr;
  Vec3 acceleration = Vec3::Zero();     ///< Of the last step, world, m/s².
  Vec3 spinAcceleration = Vec3::Zero(); ///< Of the spin, body axes, rad/s².
  double given = 0.0; ///< Out: work that this rock did on other rocks in the step, J.
  double frictionWork = 0.0, dampedWork = 0.0;   ///< Out: on the slope, J.
  double springEnergy = 0.0, normalEnergy = 0.0; ///< Out: of its contacts with the slope, J.
};

struct GroupContact
{
  Contact* contact = nullptr;
  int first = -1;
  int second = -1;       ///< −1: the slope.
  double friction = 0.0; ///< tan φ
  double cohesion = 0.0; ///< N
  /// ≥ 0: leaves with at least this speed along the normal if it closes in a lasting step (Newton's
  /// law of restitution), m/s.
  double bounce = -1.0;
  double approach = 0.0; ///< Speed at which it closes, m/s.
  double work = 0.0;     ///< Out: what it took from the rocks' motion, springs included, J.
};

struct GroupOutcome
{
  bool settled = false;
  int iterations = 0;        ///< Of open–close.
  double residual = 0.0;     ///< Largest |Δ gap| of the last correction, m.
  double frictionWork = 0.0; ///< Between rocks, J.
  double dampedWork = 0.0;   ///< Between rocks, J.
};

/// The unit quaternion of a turn by Cayley's vector r (METHOD 10.4).
inline Quat cayley(const Vec3& r)
{
  const double scale = 1.0 / std::sqrt(1.0 + 0.25 * r.squaredNorm());
  return Quat(scale, 0.5 * scale * r.x(), 0.5 * scale * r.y(), 0.5 * scale * r.z());
}

/// A bounce is this much stiffer than the rocks are heavy. Much more, and what bounces to and fro
/// between others would keep Gauss–Seidel from settling.
constexpr double kBounceStiffness = 100.0;

} // namespace rockfall
