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
///
/// Of a rock that lies before a tree, and is driven into it, the tree does not take its energy but
/// that of those behind. If the tree pushes with P in the step, and without it the rock would come
/// at v, it takes
///
///     E = ½ P v² / (v + w),    w: the speed at which the rock leaves it,
///
/// which is the loss of energy in a stop, whatever stands behind the rock, and that of the rock alone
/// where it bounces. What a tree has taken in this way adds up over a fall, as it would else hang on
/// Δt; with more than its capacity it breaks. Of several hits in one step v is that of the last, and
/// E an estimate.

#include "world/IslandWork.h"

namespace rockfall
{

class StepTrees
{
public:
  StepTrees(WorldState& world, const Island& island, IslandWork& work);

  void stand();        ///< All of them again.
  bool look(double h); ///< Whether any was let go, or set in again, in a step of `h` (s).
  /// Forgets those of rocks that take the step by themselves (IslandWork::alone): what others drove
  /// them into did not happen, and their own step asks the trees.
  void forgetSingles();
  /// Breaks trees that could not hold a rock in the step that it has gone.
  void fell(std::size_t member);

private:
  using Stem = IslandWork::Stem;

  const FallingRock& rockOf(const Stem& stem) const;
  /// use(tree, contact, its number in the system): of a rock with all trees, those that were found
  /// in the step too.
  template <class Use>
  void forAll(std::size_t member, Use&& use) const;
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
  /// The tree as it pushes on a rock in a step of `h`.
  Stem pushOf(std::size_t member, int tree, double h) const;
  double takenByAll(int tree) const;        ///< Of all that was driven into it so far, J.
  bool isOfAnother(const Stem& stem) const; ///< Whether a rock before this one breaks it.
  double takenOf(
    const Stem& stem, double h) const; ///< Of what drives the rock into it, which is let go, J.

  WorldState& world_;
  const Island& island_;
  IslandWork& work_;
  const Obstacles* obstacles_; ///< Null if there are none.
};

} // namespace rockfall
