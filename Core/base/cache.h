#pragma once

/// @file
/// Memory that a loop comes to soon.

#include <cstddef>

namespace rockfall
{

constexpr std::size_t kCacheLine = 64; // bytes

/// Asks the cache for so many lines from there on.
template <std::size_t Lines>
void askCache(const void* from)
{
  const char* const first = static_cast<const char*>(from);
#pragma GCC unroll 32
  for (std::size_t k = 0; k < Lines; ++k)
  {
    __builtin_prefetch(first + k * kCacheLine);
  }
}

} // namespace rockfall
