#pragma once

/// @file
/// Stems of a stand that is given by its density, as offices have forests.

#include "terrain/structures.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rockfall
{

/// A forest as an inventory describes it.
struct Stand
{
  std::int64_t feature = 0;             ///< Number in its layer, from 1.
  std::vector<std::vector<Vec3>> rings; ///< In the local frame, m; an odd number encloses.
  double stemsPerHectare = 0.0;         ///< > 0
  double diameterMean = 0.3;            ///< At breast height, m, > 0.
  double diameterDeviation = 0.0;       ///< m, from 0 to the mean.
  double height = 20.0;                 ///< Of all trees, m, > 0.
  double conifers = 1.0;                ///< Share of the stems, 0 to 1.
  double coniferFactor = 0.9;           ///< Of stemCapacity: spruce.
  double broadleafFactor = 1.7;         ///< Beech.
  double spacing = 0.0;                 ///< Least distance of two stems, m, ≥ 0.
  int material = 0;
};

/// Most stems of a stand: more than any slope has.
constexpr double kMostStems = 1e6;

/// Trees of a stand. The number is Poisson's with the mean of density times area, places have equal
/// chance but keep the distance, diameters are gamma's. All is drawn by counter: a function of the
/// stand, its number and `seed`. Stems break at their capacity if `breaks`. Throws DataError, to
/// follow the name of the row: no area, too many stems, or no room for them.
std::vector<Tree> growStand(const Stand& stand, bool breaks, std::uint64_t seed = 1);

} // namespace rockfall
