#pragma once

/// @file
/// A look at where a step of an island would end.
///
/// A step takes the points of touch along the axis on which two rocks are farthest apart when it
/// begins, and what may reach the slope as the rocks move then. Rocks that meet fast, turn, or are
/// pushed by others on the way may come to touch elsewhere, and would be found as deep in each
/// other or in the slope as they go in a step.

#include "contact/ground/features.h"
#include "world/IslandWork.h"

namespace rockfall
{

class EndDetection
{
public:
  EndDetection(WorldState& world, const Island& island, IslandWork& work, double duration);

  /// Appends contacts that show only where the step would end, corrects the gaps of others, and
  /// asks trees whether they hold.
  EndDetectionOutcome detect();

private:
  void placeRock(std::size_t member);
  double deepestPassed() const; ///< EndDetectionOutcome::passed
  // Depths that are returned are of the deepest, of the smaller radius; 0: none.
  double detectAtPairs();
  /// Whether two rocks overlap where the step would end, deeper than a contact of theirs; finds
  /// their axis there.
  bool isMissed(std::size_t pair);
  double addMissed(std::size_t missed);
  /// The contact in the system between the same features as `touch`; its size: none.
  std::size_t find(std::size_t pair, const Contact& touch) const;
  double overlapAt(std::size_t contact) const; ///< Gap there, without its offset, m.
  double deepestOf(std::size_t pair) const;    ///< Least of a pair's, at most 0, m.
  double detectOnSlope();
  bool isMissedOnSlope(std::size_t member);
  const CandidatePairs& candidatesOf(std::size_t member);
  CameFrom cameFrom(const FallingRock& rock) const;
  /// Contacts of a rock with the slope there: those that are reckoned with, then those that are
  /// not. Returns how many the former are.
  std::size_t touchesOnSlope(
    std::size_t member, const CandidatePairs& near, std::vector<Contact>& touches) const;

  WorldState& world_;
  const Island& island_;
  IslandWork& work_;
  double h_; ///< s
};

} // namespace rockfall
