#pragma once

/// @file
/// Springs and dashpots of one rock's contacts with the slope, and what follows from them: how long
/// a step may be, and whether the rock is calm enough for a long one.

#include "rock/parameters.h"
#include "rock/parts/RockBody.h"
#include "terrain/Surface.h"

#include <vector>

namespace rockfall
{

class SlopeSprings
{
public:
  SlopeSprings(const Surface& surface, const SimulationParameters& parameters, const Block& block);

  double leastPenalty() const { return least_; } ///< pₙ of a rock that comes slowly, N/m.
  double penalty() const { return penalty_; }    ///< pₙ of the contacts that are made now, N/m.
  /// For a touch-down: no stiffer than needed to stop the rock in time.
  void beginContact(const RockBody& body) { penalty_ = this->stoppingPenalty(body); }
  /// A rock that slides into something may be faster than when its contact began.
  void stiffen(const RockBody& body);
  /// The rock is stepped by itself from now on.
  void part(const RockBody& body);
  /// The rock is stepped with others from now on: sweeps over an island follow no springs that are stiffer than those
  /// between rocks. Contacts go on with softer ones that hold the same energy.
  void join(RockBody& body);
  /// Springs and dashpot of a contact that is about to close. `restitution`: of the ground there.
  void give(Contact& contact, const RockBody& body, double restitution);

  // Lengths of a step, s

  double travelLimit(const RockBody& body) const; ///< Goes no further than contacts serve.
  double impactStep(const RockBody& body) const;  ///< Resolves an impact.
  /// The part of a step of `h` that contacts which are closed or close in it allow.
  double touchdownStep(const RockBody& body, double h) const;
  bool mayLast(const RockBody& body, double h) const; ///< A long, damped step is right.

  /// Whether the springs hold no more than what rests on them.
  bool holdLittle(const RockBody& body) const;
  /// Whether contacts that carry neither approach nor part.
  bool carryAtRest(const RockBody& body) const;

private:
  struct Stiffness
  {
    double normal, shear;
  };
  /// Stiffness that stops it in time, N/m. `held`: energy that springs hold already, J.
  double stoppingPenalty(const RockBody& body, double held = 0.0) const;
  /// N/m, with the block behind the contact. Its normal `n`, a tangent `t` and its place `y`: in the
  /// block's frame.
  Stiffness stiffnessAt(const RockBody& body, const Vec3& n, const Vec3& t, const Vec3& y) const;
  double dampingRatioFor(int ground, double restitution); ///< ζ of a class of ground, now.

  const Surface& surface_;
  const SimulationParameters& parameters_;
  double least_, penalty_;
  std::vector<double> dampingRatios_;      ///< ζ by restitution class; < 0: not known yet.
  double dampedFor_ = -1.0, damped_ = 0.0; ///< The restitution looked up last, and its ζ.
};

} // namespace rockfall
