#pragma once

/// @file
/// The first view of a slope.

class vtkSMSourceProxy;
class vtkSMViewProxy;

namespace rockfall::window
{

/// Looks at a slope obliquely, from its valley, z up, and lights it as a map's relief is. Does
/// nothing if the slope's data are not here.
void lookFromValley(vtkSMSourceProxy* slope, vtkSMViewProxy* view);

} // namespace rockfall::window
