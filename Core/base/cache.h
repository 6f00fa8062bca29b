#pragma once

/// @file
/// A line of the cache.

#include <cstddef>

namespace rockfall
{

constexpr std::size_t kCacheLine = 64; // bytes

} // namespace rockfall
