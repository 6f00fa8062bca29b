#pragma once

/// @file
/// Blocks of a metre on slopes of kilometres: bodies from nearby, dots of fixed size from afar.

class vtkSMProxy;
class vtkSMViewProxy;

namespace rockfall::window
{

/// Blocks that are smaller than some pixels in this view become dots, walls lines, and the other
/// way round. Leaves any other way to show them that somebody chose. Returns whether something
/// changed.
bool fitMarker(vtkSMProxy* representation, vtkSMViewProxy* view);

} // namespace rockfall::window
