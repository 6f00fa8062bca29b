#pragma once

/// @file
/// Structures on the way of one rock: which of them stand for it, what of them it meets, what it
/// has broken. What that does to the rock is in atStructures.h, but for what a stem takes.

#include "contact/Contact.h"
#include "contact/PlacedBlock.h"
#include "rock/parts/barrierHold.h"
#include "rock/results.h"
#include "terrain/Obstacles.h"

#include <map>
#include <span>
#include <utility>
#include <vector>

namespace rockfall
{

class Surface;
struct RockBody;
struct SurfacePatch;

/// Where a rock goes in one go: along a parabola, or by a step of contact.
struct Way
{
  const BlockState& from;
  const BlockState& to;
  double duration; ///< s
  bool flight;
};

/// Where a rock meets a barrier on a way.
struct BarrierHit
{
  int barrier = -1;      ///< −1: none.
  double fraction = 0.0; ///< Of the way.
  double heightOverGround = 0.0;
  double stored = 0.0; ///< In contact springs at the time, J.
};

/// Takes kinetic energy: all velocities become smaller by the same factor.
void slowDown(BlockState& state, double energy, double taken);
/// Outcome for a structure where the rock is `at`, with this energy (J) and its centre this high
/// over the slope (m); nothing is taken of it.
StructureEvent eventAt(StructureOutcome outcome, std::int64_t feature, const Block& block,
  const BlockState& at, double energy, double height);
/// Notes what a barrier is like before the rock comes.
void noteLoad(StructureEvent& event, const BarrierLoad& before, const BarrierState& barrier);

class StructuresOnWay
{
public:
  explicit StructuresOnWay(const Surface& surface);

  bool solid() const { return solid_; } ///< There are embankments or trees.
  bool hasBarriers() const { return barriers_; }
  const Obstacles& obstacles() const { return *obstacles_; }

  // Trees
  std::span<const int> goneTrees() const { return goneTrees_; } ///< Ascending.
  bool isGone(int tree) const;
  int treeOf(const Contact& contact) const; ///< −1: the contact is on none.
  /// Whether the contact is on what stays where it is when Λ of a scar sinks.
  bool isFirm(const Contact& contact) const
  {
    return solid_ && contact.cfe >= obstacles_->firstCfe() && obstacles_->isFirm(contact.cfe);
  }
  /// Where the rock is released there is no tree.
  void clearTrees(const PlacedBlock& rock, const BlockState& state);
  /// Whether a stem holds a rock with this motion: the laws of terrain/stemHit.h. What presses
  /// against it by one of these contacts, or is no faster than at rest, it holds up to its capacity.
  bool stemHolds(int tree, const RockBody& body, const BlockState& state,
    std::span<const Contact> contacts) const;
  /// Trees that the last step came against and that cannot hold the rock.
  std::vector<int> treesHit(const RockBody& body) const;
  /// Trees that the rock is about to touch within `h`, presses against or has `hit`, and that cannot
  /// hold it; whether there were any.
  bool breakTrees(
    double h, std::span<const int> hit, RockBody& body, std::vector<StructureEvent>& events);
  /// One that cannot hold the rock: it breaks, or the rock slips past. What it holds of the rock's
  /// energy (J) has been taken already. `driven`: others drive the rock into it with more than it holds.
  void passTree(
    int tree, double held, bool driven, RockBody& body, std::vector<StructureEvent>& events);
  double capacityOf(int tree) const; ///< J
  /// Notes that a tree held the rock, which others have driven into it with so much (J).
  void noteDriven(int tree, double energy) { broke_.driven[tree] += energy; }
  double notedDriven(int tree) const; ///< Of that, since others were told, J.

  // Barriers
  /// What barriers have held in this fall, by number.
  void setBarrierLoads(const std::vector<BarrierLoad>* loads) { barrierLoads_ = loads; }
  BarrierLoad loadOf(int barrier) const;
  /// Finds those whose line is passed, or its straight continuation as near to an end as the rock
  /// is wide (`radius`, m).
  void findBarriers(const Way& way, double gravity, double radius);
  /// The rock goes on along a way on which barriers have taken so much so far (J): notes what records
  /// or lets it pass, and finds the first barrier that stops it or breaks, `hit`. After such a one
  /// flight goes on to those at the same place only; its rest is flown anew.
  void passBarriers(const Way& way, double taken, double gravity, const RockBody& body,
    std::vector<StructureEvent>& events);
  const BarrierHit& hit() const { return hit_; }
  const Barrier& barrierHit() const;                        ///< The barrier in `hit`.
  void load(const BarrierLoad& held);                       ///< The barrier held the rock.
  void breakBarrier() { this->breakBarrier(hit_.barrier); } ///< The barrier did not.

  // Others of the fall
  /// Trees and barriers, by number, and what they have held.
  struct Broken
  {
    std::vector<int> trees, barriers;
    std::vector<std::pair<int, BarrierLoad>> held;
    std::map<int, double> driven; ///< Of trees that held what others drove in, J.

    void addTo(std::vector<BarrierLoad>& loads) const; ///< What is held, by number of barrier.
  };
  Broken drainBroken();   ///< What the rock has broken since the last call.
  Broken drainBarriers(); ///< The same without trees.
  /// What others have broken is gone for this rock, too. Whether a tree was near a piece of slope.
  bool apply(const Broken& broken, const SurfacePatch& patch);

private:
  void breakBarrier(int barrier);
  /// Elevation of the foot of a piece of a barrier where a rock passes it, m.
  double footOf(int piece, const Eigen::Vector2d& at) const;

  bool solid_ = false;
  bool barriers_ = false;
  const Surface* surface_;
  const Obstacles* obstacles_;      ///< Null if there are none.
  std::vector<int> goneTrees_;      ///< Ascending.
  std::vector<int> brokenBarriers_; ///< In the order of breaking.
  Broken broke_;                    ///< Structures that others have not heard of yet.
  const std::vector<BarrierLoad>* barrierLoads_ = nullptr; ///< Null: all are as new.
  std::vector<BarrierPassage> passages_;                   ///< Of the way at hand.
  std::size_t passed_ = 0;                                 ///< How many of them are dealt with.
  BarrierHit hit_;
};

} // namespace rockfall
