#pragma once

/// @file
/// Where the ground ends at a hole of nodata.

#include "terrain/Surface.h"

#include <span>

namespace rockfall
{

/// A side of a triangle of the slope with no ground beyond it.
struct Rim
{
  int triangle;
  int side; ///< Of nodes k, k + 1.
};

/// The ground is a solid. Appends to the patch, whose slope is complete, the upright walls in which
/// it goes down along these rims, with their ridges, and makes the nodes there peaks. Does nothing
/// if there are no rims.
void addWalls(std::span<const Rim> rims, SurfacePatch& patch);

/// Lowest node (m) of the cells that a box in x–y (local frame, m) touches; NaN if none of them has
/// a height. Costs as many nodes as there are.
double lowestNode(const Surface& surface, double x0, double x1, double y0, double y1);

} // namespace rockfall
