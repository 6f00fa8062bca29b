#pragma once

/// @file
/// Height of a rock over the grid of the slope, and where the two touch.

#include "contact/ground/candidates.h"

#include <vector>

namespace rockfall
{

/// Height of the rock over the window's ground, along the vertical, m; < 0: it overlaps it. What is
/// not more than `least` is told as something that is not.
double heightOver(const PlacedBlock& rock, const HeightWindow& window, double least);
/// The same of a round body; ∞ if there is no ground under it.
double roundGap(const PlacedBlock& rock, const HeightWindow& window);
/// A place where a rock and the slope touch.
struct GroundPlace
{
  Vec3 point;  ///< Of the rock, world, m.
  Vec3 normal; ///< Out of the slope, world, unit.
};
/// Places of the rock that are no more than `within` (m) over the window's ground, along the
/// vertical: its vertices over CFEs, its edges over ridges, peaks under its faces. For a rock that
/// is about to touch: what is first there is between its features' normal cones by itself.
void findTouches(const PlacedBlock& rock, const HeightWindow& window, double within,
  std::vector<GroundPlace>& places);

} // namespace rockfall
