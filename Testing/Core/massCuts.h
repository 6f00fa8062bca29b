#pragma once

/// @file
/// Joint sets and the blocks that they make, for the tests of cut rock masses.

#include "geometry/jointSets.h"

namespace rockfall::testing
{

/// Angles in degrees, lengths in m.
inline JointSet jointSet(double dip, double dipDirection, double spacing, double offset = 0.0)
{
  JointSet set;
  set.dip = radians(dip);
  set.dipDirection = radians(dipDirection);
  set.spacing = spacing;
  set.offset = offset;
  return set;
}

/// Of the blocks' volumes, m³.
inline double sumOf(const CutMass& cut)
{
  double sum = 0.0;
  for (const Polyhedron& block : cut.blocks)
  {
    sum += block.integrals().volume;
  }
  return sum;
}

} // namespace rockfall::testing
