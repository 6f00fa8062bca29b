#pragma once

/// @file
/// How much each rock of a collector counts where frequencies are summed, and which ones are there
/// twice.

#include "results/collectorOutputs.h"
#include "statistics/rockReleases.h"

#include <span>
#include <string>
#include <vector>

namespace rockfall::filters
{

/// Releases of the rocks, with the frequencies of their crossings, which a Calculator may have made,
/// else with their own. Throws DataError if a frequency is bad, or a rock has two.
RockReleases releasesOf(const ReleasedRocks& released, std::span<const Crossing> crossings);

/// Gives each crossing the weight of its rock.
void weigh(const RockReleases& releases, std::span<Crossing> crossings);

/// The note on rocks that crossed as one of another run did.
std::vector<std::string> copyNotes(
  const RockReleases& releases, std::span<const Crossing> crossings);

} // namespace rockfall::filters
