#pragma once

/// @file
/// Bytes as a file that is in memory only, for readers that want a name.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

/// Writes the bytes and gives the name, the same one every time for this process.
inline std::string temporaryFile(
  const std::uint8_t* data, std::size_t size, const char* extension = "")
{
  const std::string name = "/dev/shm/rockfall-fuzz." + std::to_string(getpid()) + extension;
  std::ofstream out(name, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(data), std::streamsize(size));
  out.close();
  return name;
}
