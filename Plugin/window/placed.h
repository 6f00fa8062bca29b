#pragma once

/// @file
/// Places of sources and filters that are new: on the slope that is there.

class pqPipelineSource;
class vtkSMSourceProxy;

namespace rockfall::window
{

/// Draws the line that a filter takes where nothing is drawn, so that the mouse finds one to move.
void drawPlaced(vtkSMSourceProxy* proxy);

/// Puts rocks on the slope that is there, as those of Rock Release are, unless they have one.
void standOnSlope(pqPipelineSource* rocks);

} // namespace rockfall::window
