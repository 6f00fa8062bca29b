#pragma once

/// @file
/// Handles of drawn lines lie on the slope: the mouse drags them in the plane of the picture, into
/// the ground or off it.

#include <optional>

class pqPipelineSource;

namespace rockfall::window
{

/// Lays the drawn points of a source or filter that were moved, and are not applied yet, on the
/// slope. Nothing while a button of the mouse is pressed.
void layHandles(pqPipelineSource* source);

/// Whether ParaView's key P, which puts a drawn point of this source or filter under the mouse of the
/// active view, finds no slope there.
bool missesSlope(pqPipelineSource* source);

/// The height of a slope that is there, m, in whole cm; nothing beyond all of them.
std::optional<double> groundAt(double x, double y);

} // namespace rockfall::window
