#pragma once

/// @file
/// Memory that a loop comes to soon.

#include <cstddef>

namespace rockfall
{

constexpr std::size_t kCacheLine = 64; // bytes

/// Asks the cache for what lies between two places.
inline void askCache(const void* from, const void* to)
{
  for (const char* at = static_cast<const char*>(from); at < to; at += kCacheLine)
  {
    __builtin_prefetch(at);
  }
}

} // namespace rockfall
