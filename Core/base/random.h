#pragma once

/// @file
/// Counter-based random numbers: a number is a function of (seed, iteration, purpose, index), never
/// of the order in which numbers are drawn, so that results do not depend on threads or ranks
/// (Salmon et al. 2011, Philox 4×32-10, through Random123).

#include <Random123/philox.h>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace rockfall
{

/// What a number is drawn for; one stream each.
enum class Draw : std::uint32_t
{
  Roughness = 1,
  Restitution = 2,
  FrictionAngle = 3,
};

/// Largest magnitude that `normalDeviate` can give: √(−2 ln 2⁻⁵³).
constexpr double largestDeviate = 8.6;

/// A standard normal deviate (Box–Muller) for this realisation.
inline double normalDeviate(
  std::uint64_t seed, std::uint32_t iteration, Draw purpose, std::uint64_t index)
{
  const r123::Philox4x32::ctr_type counter = { { std::uint32_t(index), std::uint32_t(index >> 32),
    iteration, std::uint32_t(purpose) } };
  const r123::Philox4x32::key_type key = { { std::uint32_t(seed), std::uint32_t(seed >> 32) } };
  const auto bits = r123::Philox4x32()(counter, key);
  const auto uniform = [](std::uint32_t high, std::uint32_t low)
  {
    const std::uint64_t wide = (std::uint64_t(high) << 32 | low) >> 11;
    return (double(wide) + 0.5) * 0x1p-53; // in (0, 1)
  };
  const double u = uniform(bits[0], bits[1]);
  const double v = uniform(bits[2], bits[3]);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

} // namespace rockfall
