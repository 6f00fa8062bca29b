#pragma once

/// @file
/// How an overlap with the slope that was found, not made, goes under a rock alone.
///
/// A loose overlap goes by less than the compression of the weight in each step that lasts, and the
/// spring hardly notices. With a deep one the rock takes the step as an island of one
/// (rock/fall/islandOfOne.h), where it goes as place: a spring that pressed it out would throw what
/// is jammed.

#include "rock/parts/RockBody.h"

namespace rockfall
{

/// Whether a contact overlaps deeper than `loose` (m).
bool isDeep(const RockBody& body, double loose);
/// Loose overlaps, after a step of `h` (s) that lasts.
void recoverLooseOverlaps(RockBody& body, double h, double gravity, double normalPenalty);

} // namespace rockfall
