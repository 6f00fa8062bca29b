#pragma once

/// @file
/// Looks of charts: a rock along its way, and exceedance at a line.

#include "looks.h"

namespace rockfall::window
{

/// Speed and height on the left axis, energy on the right one, along the way.
void styleProfile(vtkSMProxy* representation, vtkSMViewProxy* view);
/// Both axes from 0: a rock that touches the ground is some millimetres in it.
void followProfile(const Shown& shown, vtkSMViewProxy* view);

/// Share over energy, a curve from (0, 1) to the largest energy.
void styleExceedance(const Shown& shown, vtkSMProxy* representation, vtkSMViewProxy* view);
/// Looks that hang on the table: the title says where nothing passes; several lines are points, as
/// a curve would go on from one to the next.
void followExceedance(const Shown& shown, vtkSMProxy* representation, vtkSMViewProxy* view);

} // namespace rockfall::window
