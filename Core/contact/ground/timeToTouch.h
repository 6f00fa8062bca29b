#pragma once

/// @file
/// How far a rock is from touching: lower bounds of the time in free flight.

#include "contact/PlacedBlock.h"
#include "terrain/Obstacles.h"
#include "terrain/Surface.h"

#include <span>
#include <vector>

namespace rockfall
{

/// Lower bound of the time (s, at most `horizon`) to the first touch in free flight over the
/// window, which must hold all that the rock can come over until then. For every place where the
/// gap along the vertical can be least, it is covered at the speed that this point of the rock has,
/// towards a slope that may differ from the window's mean by as much as any of its CFEs does. 0
/// where the two overlap.
double timeToTouch(const PlacedBlock& rock, const BlockState& state, const HeightWindow& window,
  double gravity, double horizon);
/// Height and free time of a rock in flight over the window's ground.
struct FlightLook
{
  double gap;  ///< Height over the ground, along the vertical, m; < 0: overlap.
  Vec3 lowest; ///< Place of the least gap, material point of the rock, m.
  double free; ///< Lower bound of the time without a touch, s.
};
/// Time as of timeToTouch, and closer, where there is ground all over the window: around what is under a
/// point of the rock (`near`, material, m) the slope's gradients are taken as they are there.
FlightLook lookAhead(const PlacedBlock& rock, const BlockState& state, const HeightWindow& window,
  const Vec3& near, double gravity, double horizon);
/// Time as above for the bounding sphere over the plane that no node of the window is above.
double timeToNear(const BlockState& state, double radius, const HeightWindow& window,
  double gravity, double horizon);
/// Time as above for the rock itself over that plane.
double timeToPlane(const PlacedBlock& rock, const BlockState& state, const HeightWindow& window,
  double gravity, double horizon);

/// Lower bound of the time (s, at most `horizon`) to the first touch of an obstacle in free flight.
/// Where the bounding sphere comes to one within `close` (s), `rock` is placed there and looked at
/// itself. Trees that are `gone` (ascending) do not count.
double timeToObstacle(PlacedBlock& rock, const BlockState& state, const Block& block,
  const Obstacles& obstacles, std::span<const int> gone, double gravity, double close,
  double horizon);

} // namespace rockfall
