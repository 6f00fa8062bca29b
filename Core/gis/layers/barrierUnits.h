#pragma once

/// @file
/// Heights and capacities of barriers that only another unit explains.

#include "gis/layers/FeatureRow.h"

#include <optional>

namespace rockfall::gis
{

/// The largest nets are tested to 10,000 kJ and stand some 10 m high.
constexpr double kMostBarrierHeight = 30.0;    // m
constexpr double kMostBarrierCapacity = 100e3; // kJ

/// Throws DataError, naming file, row and field, if a barrier's `height` (m) or `capacity` (kJ) is
/// far beyond what is built: it would stop everything.
void refuseOtherUnits(
  const FeatureRow& row, std::optional<double> height, std::optional<double> capacity);

} // namespace rockfall::gis
