#pragma once

/// @file
/// Names that lead to no file of bytes.

#include <string>

namespace rockfall
{

/// What stands there instead of a file, in words, if an open or a read of it may wait for ever or
/// never end: a pipe, a device, a file of the kernel's. Empty of files, of folders and of nothing.
/// Opens nothing.
std::string noFile(const std::string& fileName);

} // namespace rockfall
