#pragma once

/// @file
/// Rocks that lie on each other face on face, as the blocks of a cut rock mass do.

#include "rock/Rock.h"

#include <cstdint>
#include <span>

namespace rockfall::filters
{

/// How many of the rocks have a face that is also one of another rock, on its other side, within
/// some 0.1 mm. A face that the rounding of coordinates puts aside may be missed.
std::int64_t countFaceOnFace(std::span<const Rock> rocks);

} // namespace rockfall::filters
