#pragma once

/// @file
/// Trees that the rocks of an island are driven into within a step.
///
/// A rock that comes to a tree by itself is told before the step whether the tree holds it
/// (rock/fall/atStructures.h). Others may drive a rock into a tree that it did not come to, and
/// the tree would take all that they give it. So one that carries in the solution and could not
/// hold the rock as it would go without it (StructuresOnWay::stemHolds, here too) is let go. If the
/// rock drives on through it then and the tree cannot hold it, it passes, else the tree is set in
/// again.

#include "world/IslandWork.h"

namespace rockfall
{

class StepTrees
{
public:
  StepTrees(WorldState& world, const Island& island, IslandWork& work);

  void stand();        ///< All of them again.
  bool look(double h); ///< Whether any was let go, or set in again, in a step of `h` (s).
  /// Breaks trees that could not hold a rock in the step that it has gone.
  void fell(std::size_t member);

private:
  using Stem = IslandWork::Stem;

  const FallingRock& rockOf(const Stem& stem) const;
  /// use(contact, its number in the system): those of the rock with the tree.
  template <class Use>
  void forContacts(const Stem& stem, Use&& use) const;
  void setAbsent(const Stem& stem, bool absent);
  BlockState endOf(const Stem& stem) const;
  /// The same without what trees do in a step of `h`, as long as others do as they did.
  BlockState endWithout(const Stem& stem, double h) const;
  /// Whether the tree cannot hold the rock that ends so, and that goes on into it. `through`: it is
  /// let go.
  bool cannotHold(const Stem& stem, const BlockState& end, bool through) const;
  bool isKnown(std::size_t member, int tree) const;

  WorldState& world_;
  const Island& island_;
  IslandWork& work_;
  const Obstacles* obstacles_; ///< Null if there are none.
};

} // namespace rockfall
