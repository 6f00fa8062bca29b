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
  /// Dashpots of contacts that stop the rock together within a step of `h` (s), given as if each were
  /// alone. A dashpot of 2 ζ k / ω makes the coefficient of restitution that ζ stands for if ω is the
  /// frequency of what comes against the spring. A contact alone feels the mobility of its own point.
  /// Several feel what they stop together: four corners of a plate that falls on its face stop its
  /// mass, though each alone would turn it. That is Rayleigh's quotient for springs that are
  /// compressed in proportion to the speeds v at which they come in, ω² = fᵀ M⁻¹ f / Σ k v², with f
  /// the forces k v of all of them. Dashpots in proportion to the springs damp nothing else.
  void tuneTogether(RockBody& body, double h) const;
  /// Stiffens springs into which others press the rock. A spring of a light rock is made for what the
  /// rock itself brings, at `fastest` (m/s) since its impact began. Under a boulder it would take the
  /// boulder's energy, at an overlap as large as the stone, and give it to the stone: hundreds of
  /// m/s. In nature the stone is crushed.
  void stiffenPressed(RockBody& body, double fastest) const;

  // Lengths of a step, s

  double travelLimit(const RockBody& body) const; ///< Step no further than contacts serve, s.
  double impactStep(const RockBody& body) const;  ///< Step that resolves an impact, s.
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
