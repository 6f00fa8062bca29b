#pragma once

/// @file
/// The fall of one rock: its parts, as its phases pass them on (SingleRock). A part keeps one thing
/// and its rule, and knows no other part but by what it is given.
///
///   body        motion, contacts, books          RockBody
///   ground      what of the slope is near        GroundNear
///   springs     of contacts; lengths of steps    SlopeSprings
///   soil        scar, drag, slip                 SoilUnderRock
///   structures  trees and barriers               StructuresOnWay
///   impact      the one that is under way        SlopeImpact
///   recorder    samples, maxima, energy          Recorder
///
/// Phases: flightPhase, impulseImpacts, contactPhase; inSoil, atStructures and islandOfOne within
/// them; endOfFall.

#include "law/settings.h"
#include "rock/parameters.h"
#include "rock/parts/GroundNear.h"
#include "rock/parts/Recorder.h"
#include "rock/parts/RockBody.h"
#include "rock/parts/SlopeImpact.h"
#include "rock/parts/SlopeSprings.h"
#include "rock/parts/SoilUnderRock.h"
#include "rock/parts/StructuresOnWay.h"

namespace rockfall
{

struct Rock;

struct Fall
{
  /// `number` of the rock in its iteration.
  Fall(const Surface& s, const Rock& rock, const Block& block, const SimulationParameters& p,
    std::uint32_t number);

  void end(Fate fate);
  /// Whether the horizon is reached, but for what is too short to be a step.
  bool arrived() const { return this->body.state.time >= this->horizon - kTooShort; }

  const Surface& surface;
  const SimulationParameters& parameters;
  // In the order of their use in the step of an island, which goes from rock to rock: what it needs
  // lies together.
  bool inContact = false;
  RockBody body;
  bool pressed = false;   ///< Out of an island, or a deep overlap: it goes as place.
  bool impulses;          ///< Impacts are events in impulse space.
  int struckAtOnce = 0;   ///< Impacts since the rock last moved on.
  double openTime = 0.0;  ///< Time since the rock touched, s.
  double horizon = 0.0;   ///< Time up to which the rock is to advance, s.
  double nearSince = 0.0; ///< Begin of the contact at hand, s.
  double freeUntil = 0.0; ///< Nothing can be touched until then, after a take-off or over Λ, s.
  std::uint64_t carrying = 0; ///< The features that carried in the last lasting step.
  SlopeSprings springs;
  StructuresOnWay structures;
  GroundNear ground;
  SlopeImpact impact;
  SoilUnderRock soil;
  Recorder recorder;
};

} // namespace rockfall
