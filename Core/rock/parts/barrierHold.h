#pragma once

/// @file
/// Whether a barrier holds a rock that passes its line: by the rock's size, not by its centre.
///
/// The rock's outline is seen along the line. Less a share of its height and width that may stand
/// out (Barrier::overhang), its top must be under the rope, and its left and right side each before
/// a net, the same or another one. So a rock passes beside an end, and between two nets through a
/// gap that is wider than the rock. It strikes what is before a part of its outline all the same.

#include "block/Block.h"

#include <span>

namespace rockfall
{

class Obstacles;
struct BarrierState;

/// Where the line of a barrier is passed on a way.
struct BarrierPassage
{
  double fraction = 0.0; ///< Of the way; by rounding rather behind the line.
  int barrier = -1;
  int piece = -1;      ///< Of Obstacles::barrierPieces.
  bool beyond = false; ///< On the straight continuation of the line, beyond an end.

  /// Two pieces of a barrier meet at one place.
  bool operator==(const BarrierPassage& other) const
  {
    return fraction == other.fraction && barrier == other.barrier;
  }
};

/// What a barrier is to the outline of a rock.
enum class BarrierMeets
{
  Nothing, ///< The rock is over the rope or beside an end with all of it.
  Strikes, ///< With a part of it.
  Holds,
};

/// For a rock that stands so on the line of a piece of a barrier, or on its continuation, with its
/// centre this high over the barrier's foot (m; NaN: there is no ground to stand on). What fills the
/// barrier lifts a rock that comes lower. `broken` barriers hold nothing.
BarrierMeets meetsOutline(const Obstacles& obstacles, int piece, const BarrierState& state,
  std::span<const int> broken, const Block& block, const BlockState& at, double height);

} // namespace rockfall
