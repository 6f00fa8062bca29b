#pragma once

/// @file
/// Results of an island's step: into its rocks and pairs.

#include "world/IslandWork.h"

namespace rockfall
{

class StepResult
{
public:
  /// Of a step that has gone on for a duration (s).
  StepResult(WorldState& world, const Island& island, IslandWork& work, double duration);

  void apply();

private:
  /// Rocks that struck the slope and no other rock, nor could have met one if the impact had come
  /// a little later: they take the step by themselves.
  void splitOffSingles();
  bool isNearAnother(std::size_t pair) const;
  void stepSingle(FallingRock& rock);
  /// Motion of a rock since a state, for those that look at its pairs.
  void noteMotion(const FallingRock& rock, const BlockState& from);
  void applyToPair(std::size_t touching); ///< By number among those that touch.
  void bookContact(RockPair& pair, const IslandContact& touch) const;
  void applyAdded();    ///< Contacts that were missed at first.
  void finishImpacts(); ///< Of pairs that have parted, or lie on each other.
  void applyToRock(std::size_t member);
  /// The axis of a pair where the step ends, if it was looked at there.
  void keepAxis(std::size_t pair);

  WorldState& world_;
  const Island& island_;
  IslandWork& work_;
  double h_; ///< s
};

} // namespace rockfall
