#pragma once

/// @file
/// Legends of arrays whose numbers stand for something: a colour and a name each, no numbers.

#include "looks.h"

#include <string>

class vtkSMProxy;

namespace rockfall::window
{

/// Gives the palette of Fate, Outcome, or Intensity… of a hazard map one colour and one name for each
/// number; of Intensity… those of the source's thresholds. What was changed by hand stays, until the
/// thresholds change. Returns whether the array is one of these.
bool nameNumbers(const std::string& array, const Shown& shown, vtkSMProxy* table);

} // namespace rockfall::window
