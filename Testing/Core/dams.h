#pragma once

/// @file
/// Level ground and a straight embankment on it.

#include "slopes.h"
#include "terrain/structures.h"

namespace rockfall::testing
{

inline constexpr double kSize = 100.0; // m

/// Level ground at z = 100 m, of 5 m cells.
inline Terrain level(const SurfaceMaterial& m)
{
  return makePlane(21, kSize, 0.0, 0.0, m);
}

/// Along x through the middle; its points are given so that it has joints.
inline Embankment dam(double height, double width, double slope)
{
  Embankment e;
  e.feature = 1;
  e.points = { { 20.0, 50.0 }, { 37.0, 50.0 }, { 48.5, 50.0 }, { 80.0, 50.0 } };
  e.height = height;
  e.crestWidth = width;
  e.mountainSlope = e.valleySlope = slope;
  return e;
}

inline Structures only(const Embankment& e)
{
  Structures s;
  s.embankments = { e };
  return s;
}

} // namespace rockfall::testing
