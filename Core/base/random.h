#pragma once

/// @file
/// Counter-based random numbers: a number is a function of (seed, iteration, purpose, index), never
/// of the order in which numbers are drawn, so that results do not depend on threads or ranks
/// (Salmon et al. 2011, Philox 4×32-10, through Random123).

#include <Random123/philox.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace rockfall
{

/// Purposes of random numbers; one stream each.
enum class Draw : std::uint32_t
{
  Roughness = 1,
  Restitution = 2,
  FrictionAngle = 3,
  // Of a square of the map; the index is the square's.
  RoughField = 4,
  ObstaclePlace = 5,
  ObstacleHeight = 6,
  Softness = 7,
  // Of a rock in an iteration; the index is the rock's.
  StartPosition = 16,
  StartHeight = 17,
  Attitude = 18,
  Volume = 19,
  // Of a rock or a piece of one, by a number of its own.
  Survival = 24,
  Breaking = 25,
  BreakingPlane = 26,
  FragmentDirection = 27,
  // Of a rock when its source makes it; the iteration counts attempts.
  SourceNumber = 32,
  SourcePlace = 33,
  SourceShape = 34,
  SourceVolume = 35,
  SourceAttitude = 36,
  // Of a joint in its set; the iteration is the number of the set.
  JointSpacing = 48,
  JointTilt = 49,
};

/// Largest magnitude that `normalDeviate` can give: √(−2 ln 2⁻⁵³).
constexpr double largestDeviate = 8.6;

/// Two independent uniform deviates in (0, 1) for this realisation.
inline std::array<double, 2> uniformDeviates(
  std::uint64_t seed, std::uint32_t iteration, Draw purpose, std::uint64_t index)
{
  const r123::Philox4x32::ctr_type counter = { { std::uint32_t(index), std::uint32_t(index >> 32),
    iteration, std::uint32_t(purpose) } };
  const r123::Philox4x32::key_type key = { { std::uint32_t(seed), std::uint32_t(seed >> 32) } };
  const auto bits = r123::Philox4x32()(counter, key);
  const auto uniform = [](std::uint32_t high, std::uint32_t low)
  {
    const std::uint64_t wide = (std::uint64_t(high) << 32 | low) >> 11;
    return (double(wide) + 0.5) * 0x1p-53;
  };
  return { uniform(bits[0], bits[1]), uniform(bits[2], bits[3]) };
}

/// One of them.
inline double uniformDeviate(
  std::uint64_t seed, std::uint32_t iteration, Draw purpose, std::uint64_t index)
{
  return uniformDeviates(seed, iteration, purpose, index)[0];
}

/// Two independent standard normal deviates (Box–Muller) for this realisation.
inline std::array<double, 2> normalDeviates(
  std::uint64_t seed, std::uint32_t iteration, Draw purpose, std::uint64_t index)
{
  const auto [u, v] = uniformDeviates(seed, iteration, purpose, index);
  const double size = std::sqrt(-2.0 * std::log(u)), angle = 2.0 * std::numbers::pi * v;
  return { size * std::cos(angle), size * std::sin(angle) };
}

/// One of them.
inline double normalDeviate(
  std::uint64_t seed, std::uint32_t iteration, Draw purpose, std::uint64_t index)
{
  return normalDeviates(seed, iteration, purpose, index)[0];
}

} // namespace rockfall
