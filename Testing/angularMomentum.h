#pragma once

/// @file
/// A sum that free motion keeps.

#include "block/Block.h"

namespace rockfall::testing
{

/// About the centroid, world axes, kg m²/s.
inline Vec3 angularMomentum(const Block& block, const BlockState& state)
{
  Vec12 velocity;
  velocity << state.orientation.conjugate() * state.velocity, state.spin, state.strainRate;
  const Vec12 p = block.massMatrix() * velocity;
  return state.orientation * Vec3(p.segment<3>(kRotation));
}

} // namespace rockfall::testing
