#pragma once

/// @file
/// A contact of an island as a soft row, and its law of friction.

#include "base/types.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace rockfall::soft
{

/// A contact while it is solved for, of a point that moves with the rock `a`: what sweeps go
/// over, in three cache lines.
struct alignas(64) ContactRow
{
  int a, b;         ///< Movers; b < 0: the slope.
  bool idle;        ///< Stays open in the substep.
  bool stops;       ///< Stopped what closed: its impulse is not one to go on with.
  bool loaded;      ///< Did so in the last substep: it carries a load.
  bool pressed;     ///< Pushed, and what pressing gave was taken back.
  double gap;       ///< Now, m.
  double P;         ///< N s
  double mass;      ///< Effective, kg.
  Vec3 normal;      ///< Direction from b to a, at mid-step.
  Vec3 lever;       ///< Arm from a's centroid, at mid-step, m.
  Vec3 leverB;      ///< Arm from b's centroid to that point now, m.
  Vec3 T;           ///< Across, N s.
  double shearMass; ///< Effective, kg.
  double friction;  ///< tan φ
  double cohesion;  ///< N s
  double rate;      ///< β, 1/s
  double softness;  ///< m β / (h pₙ)
  double resting;   ///< Speed below which a touch is no impact, m/s.
  double slide2;    ///< Square of how far its rocks may slide and weigh the same, m².
};

/// What else of a row.
struct ContactRowCold
{
  bool flipped;   ///< `a` is the contact's second rock.
  bool jams;      ///< The row was stopped in the substep as one of a jam.
  double gap0;    ///< Where the step begins, m.
  double spring;  ///< pₙ, N/m
  double before;  ///< Speed along the normal before an impact round, m/s.
  double pending; ///< ≥ 0: speed at which an impact that was under way leaves, m/s.
  double loose;   ///< Deepest loose overlap beyond what its force explains, m.
  double warmP;   ///< Of a deep rock, before it is pressed: along the normal, N s,
  Vec3 warmT;     ///< and across.
};

/// What a contact did in the step.
struct Result
{
  std::size_t contact;
  Vec3 impulse;        ///< On a, N s.
  double normalWork;   ///< On both, J.
  double workOnA;      ///< On a alone, J.
  double frictionWork; ///< Taken, J.
  double struck;       ///< Greatest speed at which it closed as an impact, m/s.
  double struckAt;     ///< When that was, from the step's beginning, s,
  Vec3 struckPoint;    ///< and where, from Step::origin, m.
};

/// Rows of the same two rocks.
struct Manifold
{
  int a, b; ///< Movers; b < 0: the slope.
  std::size_t first, end;
  int impactRound; ///< Of impacts, in which it was last asked.
  bool busy;       ///< Swept over: rows that are not idle stand where the rocks are.
  bool pivots;     ///< Two rocks that push each other at one point only.
};

inline void limitTo(Vec3& T, double most)
{
  const double size2 = T.squaredNorm();
  if (size2 > most * most)
  {
    T *= most / std::sqrt(size2);
  }
}

/// Most of an impulse across with P along the normal, N s.
inline double frictionLimit(const ContactRow& r, double P)
{
  return r.friction * P + std::min(r.cohesion, kCohesionPerForce * P);
}

/// Friction under an impulse P (N s) along the normal. Returns by how much it changes, N s.
inline Vec3 solveFriction(ContactRow& r, double P, const Vec3& across)
{
  Vec3 T = r.T - r.shearMass * across;
  T -= T.dot(r.normal) * r.normal;
  limitTo(T, frictionLimit(r, P));
  const Vec3 dT = T - r.T;
  r.T = T;
  return dT;
}

/// Books an impulse `along` the normal and `across` (N s), whose work is along the mean of the
/// velocities before and after, of both rocks and of a's point alone (m/s).
inline void book(const ContactRow& r, double along, const Vec3& across, const Vec3& mean,
  const Vec3& meanA, Result& result)
{
  result.normalWork += along * r.normal.dot(mean);
  result.frictionWork -= across.dot(mean);
  const Vec3 impulse = along * r.normal + across;
  result.workOnA += impulse.dot(meanA);
  result.impulse += impulse;
}

} // namespace rockfall::soft
