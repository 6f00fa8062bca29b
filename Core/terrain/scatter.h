#pragma once

/// @file
/// How often what deviates is drawn anew (METHOD 7), and what a touch of the ground is drawn for.
///
/// A number is a function of seed, iteration and touch, never of the order in which touches come:
/// threads, ranks and runs of a single iteration do not change it.

#include "base/types.h"

#include <cmath>
#include <cstdint>

namespace rockfall
{

/// For what a number with a deviation is drawn.
enum class DeviationPer
{
  Iteration = 0, ///< Once for each class of ground: the paper's.
  Impact = 1,    ///< For each impact of each rock.
  Place = 2,     ///< For each place: two rocks of an iteration meet the same spot alike.
};

/// By its number. Throws ParameterError if it is none.
DeviationPer deviationPerFrom(double number);

/// Side of the squares that are one place each, m. They are squares of the map, whatever the cells.
constexpr double kPlaceSize = 1.0;

/// A touch of the ground.
struct GroundTouch
{
  std::int64_t cfe = 0;         ///< Under it: says its classes.
  Vec3 position = Vec3::Zero(); ///< Local frame, m: says its place.
  std::uint32_t rock = 0;       ///< Number of the rock in its iteration, from 0.
  std::uint32_t impact = 0;     ///< How many impacts of this rock are over.
};

/// Number of a square of the map: squares of this `size` (m), counted from the origin of the map.
inline std::uint64_t squareIndex(std::int64_t column, std::int64_t row)
{
  return std::uint64_t(std::uint32_t(column)) << 32 | std::uint32_t(row);
}
inline std::uint64_t squareAt(double easting, double northing, double size)
{
  return squareIndex(
    std::int64_t(std::floor(easting / size)), std::int64_t(std::floor(northing / size)));
}

} // namespace rockfall
