#pragma once

/// @file
/// How far the ground under a rock may rise.

#include "contact/PlacedBlock.h"
#include "terrain/Surface.h"

namespace rockfall
{

/// Lower bound of the height by which all of a patch may rise straight up until it touches the
/// rock, m; ≤ 0: it may touch now. More than `enough` is not told apart. By the planes of the
/// patch's triangles and of the rock's faces, so that the size of cells does not matter.
double headroom(const PlacedBlock& rock, const SurfacePatch& patch, double enough);

} // namespace rockfall
