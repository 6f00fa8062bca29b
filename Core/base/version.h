#pragma once

/// @file
/// The version of the program.

#include <string>

namespace rockfall
{

/// "1.2.3".
const char* versionNumber();

/// "RockfallDDA 1.2.3", as it stands in files that are written.
std::string versionText();

} // namespace rockfall
