#pragma once

/// @file
/// A map of hazards laid on the slope, to look at.

class vtkImageData;
class vtkPolyData;

namespace rockfall::filters
{

/// The cells of a map that anything passed, as quadrilaterals on the slope, lifted a little so that
/// they hide it. All cell arrays go along. A map without the heights of a slope lies at z = 0.
void drapeMap(vtkImageData* map, vtkPolyData* output);

} // namespace rockfall::filters
