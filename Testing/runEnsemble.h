#pragma once

/// @file
/// Every rock in every iteration, in one call.

#include "base/abort.h"
#include "run/ensemble.h"

namespace rockfall::testing
{

/// Returns false if `progress` aborted.
inline bool runEnsemble(const Terrain& terrain, std::span<const Rock> rocks,
  const SimulationParameters& parameters, TrajectorySink& sink, const Progress& progress = {})
{
  try
  {
    const AbortScope scope([&] { return !progress || progress(0.0); });
    const Ensemble ensemble(terrain, rocks, parameters);
    return ensemble.run(ensemble.whole(), sink, progress);
  }
  catch (const Aborted&)
  {
    return false; // rocks were still being checked or pushed apart
  }
}

} // namespace rockfall::testing
