#pragma once

/// @file
/// Memory that will be needed soon.

#include <cstddef>

namespace rockfall
{

/// Bytes that come from memory together.
constexpr std::size_t kLine = 64;

/// Has the line of an address brought to the caches meanwhile. Changes nothing; any address will
/// do.
inline void prefetch([[maybe_unused]] const void* address)
{
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(address);
#endif
}

/// The same for all of an object.
template <class T>
void prefetchAll(const T& object)
{
  const char* begin = reinterpret_cast<const char*>(&object);
  for (std::size_t i = 0; i < sizeof(T); i += kLine)
  {
    prefetch(begin + i);
  }
}

} // namespace rockfall
