#pragma once

/// @file
/// The numbers of a preset of ground, for the fields of the panel that it replaces.

#include <string>
#include <utility>
#include <vector>

namespace rockfall::window
{

/// Properties of DEM to CFE Mesh and what a preset, from 1, makes of them, in the panel's units.
/// Nothing for 0, no preset.
std::vector<std::pair<std::string, double>> presetValues(int preset);

} // namespace rockfall::window
