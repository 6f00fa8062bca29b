#pragma once

/// @file
/// The ground under one rock where it yields (terrain/yieldingGround.h): the scar that the rock is
/// in, what soil takes of its motion, and friction that falls with the slip.

#include "rock/parts/GroundNear.h"
#include "rock/parts/RockBody.h"
#include "rock/parts/Scar.h"
#include "rock/parts/StructuresOnWay.h"
#include "terrain/Surface.h"

namespace rockfall
{

class SoilUnderRock
{
public:
  SoilUnderRock(const Surface& surface, double gravity)
    : surface_(surface)
    , gravity_(gravity)
    , yields_(surface.terrain().yields())
  {
  }

  bool yields() const { return yields_; } ///< Some class of the ground does.
  const Scar& scar() const { return scar_; }
  const YieldingGround& groundOf(int restitutionClass) const;
  /// tan φ at a contact as the slip so far has left it; NaN: it does not hang on slip.
  double slipFriction(
    const Contact& contact, const RockBody& body, const StructuresOnWay& structures) const;

  // Λ sinks and rises

  /// How Λ would sink under a contact.
  struct Sink
  {
    const Contact* under = nullptr; ///< Null: it stays.
    double depth = 0.0;             ///< m
    double approach = 0.0;          ///< Of the contact, m/s.
  };
  /// Under what comes down within a step of `h` (s).
  Sink sinkWithin(const RockBody& body, const StructuresOnWay& structures, double h) const;
  void sink(
    const Sink& sink, const StructuresOnWay& structures, RockBody& body, GroundNear& ground);
  /// By how much it may rise with the rock now, m; 0: not yet.
  double riseNow(
    const RockBody& body, const StructuresOnWay& structures, const GroundNear& ground) const;
  void rise(double by, GroundNear& ground); ///< m

  // Motion in the soil

  /// Lower bound of the time in which the rock, over nothing but slope, does not come to Λ; 0:
  /// not known.
  double freeOverScar(const RockBody& body, GroundNear& ground) const;
  /// Flies for so long (s), braked. Whether soil took anything.
  bool fly(RockBody& body, double duration);
  /// After a step of contact of `h` (s) from `before` to `state`. Whether soil took anything.
  bool yieldInStep(RockBody& body, const StructuresOnWay& structures, double h);
  void forgetSlip(double duration); ///< Time (s) without touch.

private:
  /// At a contact; hard on trees.
  const YieldingGround& groundAt(const Contact& contact, const StructuresOnWay& structures) const;
  /// S of the ground under the rock, of the class at a contact.
  double softnessAt(const Contact& contact, const RockBody& body) const;
  /// Takes what a swept volume (m³) takes from speed and spin; whether there is any.
  bool plough(RockBody& body, double volume);

  const Surface& surface_;
  double gravity_; ///< m/s²
  bool yields_;
  Scar scar_;
  double slip_ = 0.0; ///< s of the slip-dependent friction, m.
  int touched_ = 0;   ///< Class of the ground that it touched last.
  struct Softness
  {
    int ground = -1; ///< Class.
    Vec3 place = Vec3::Zero();
    double value = 1.0;
  };
  mutable Softness known_; ///< As last drawn: each contact of a step asks for the same.
};

} // namespace rockfall
