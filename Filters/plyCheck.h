#pragma once

/// @file
/// VTK's PLY reader believes what a file's header says and crashes if the rest is shorter.

#include <string>

namespace rockfall::filters
{

/// Throws FileError unless the file is a PLY with all the data that its header announces.
void checkPly(const std::string& fileName);

} // namespace rockfall::filters
