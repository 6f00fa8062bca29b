#pragma once

/// @file
/// Heights and capacities of barriers that only another unit explains.

#include "gis/base/FeatureRow.h"

#include <optional>

namespace rockfall::gis
{

/// Throws DataError, naming file, row and field, if a barrier's `height` (m) or `capacity` (kJ) is
/// far beyond what is built (terrain/plausible.h): it would stop everything.
void refuseOtherUnits(
  const FeatureRow& row, std::optional<double> height, std::optional<double> capacity);

} // namespace rockfall::gis
