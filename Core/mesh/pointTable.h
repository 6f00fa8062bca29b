#pragma once

/// @file
/// Points in the lines of a text: the columns that the header names x, y and z, or the first three.

#include "mesh/Mesh.h"

#include <string>
#include <string_view>

namespace rockfall
{

/// Reads .csv, .xyz and .txt. Columns are parted by semicolons, tabs, commas or blanks; where they
/// are not parted by commas, decimals may be. Throws FileError that names the line.
Mesh readPointTable(const std::string& fileName);
/// The same of bytes in memory; `name` is for messages.
Mesh parsePointTable(std::string_view bytes, const std::string& name);

} // namespace rockfall
