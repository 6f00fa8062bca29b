#pragma once

/// @file
/// Legend of the arrays Intensity… of a hazard map: a colour and a name a class, no numbers.

#include "looks.h"

#include <string>

class vtkSMProxy;

namespace rockfall::window
{

/// Whether an array is one of classes of intensity.
bool isIntensity(const std::string& array);

/// Gives a palette one colour and one name for each class that the source's thresholds make. Names
/// and colours that were changed by hand stay until the thresholds change.
void nameClasses(const Shown& shown, vtkSMProxy* table);

} // namespace rockfall::window
