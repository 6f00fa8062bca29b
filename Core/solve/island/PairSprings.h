#pragma once

/// @file
/// Springs and dashpots of contacts between rocks.

#include "block/Block.h"
#include "contact/Contact.h"

#include <array>

namespace rockfall
{

/// Of what contacts between rocks are made.
struct PairStiffness
{
  double normalPenalty = 0.0; ///< pₙ, N/m
  double shearRatio = 1.0;    ///< pₛ / pₙ
  bool rigid = false;         ///< Blocks do not strain beside their contacts.
};

/// Gives contacts of two rocks what they are made of, along the normal and across it side by side;
/// what only the normal decides is found once.
class PairSprings
{
public:
  /// As the two move; `second` may be none: the slope. `damping`: ζ along the normal.
  PairSprings(const PairStiffness& stiffness, double damping, const Block& first,
    const BlockState& firstState, const Block* second, const BlockState* secondState);

  void set(Contact& contact);

private:
  using Two = Eigen::Array2d;
  struct Side
  {
    const Block* block = nullptr; ///< None: the slope.
    Mat3 turn;                    ///< Body to world axes.
    Vec3 position;
    TwoDirections motions; ///< The normal and a direction across it, body axes.
  };
  bool rigid_;
  Two dampings_;
  Two penalties_; ///< N/m
  Vec3 normal_ = Vec3::Zero();
  std::array<Side, 2> sides_;
};

} // namespace rockfall
