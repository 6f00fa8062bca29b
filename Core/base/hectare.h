#pragma once

/// @file
/// The hectare, by which densities of forests and frequencies of sources are given.

namespace rockfall
{

inline constexpr double kHectare = 1e4; ///< m²

} // namespace rockfall
