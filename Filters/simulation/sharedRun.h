#pragma once

/// @file
/// An ensemble shared out over ranks.

#include "run/ensemble.h"
#include "shared/ranks.h"
#include "simulation/runSink.h"

namespace rockfall::filters
{

/// Simulates the whole ensemble on all ranks and hands it to the sink of rank 0, in order: what
/// comes out is the same, bit for bit, for any number of them. Collective; every rank has the same
/// ensemble. `sink` is not looked at on the other ranks, `progress` is called on every rank.
///
/// Returns false, on all ranks, if `progress` of any aborted; throws Error, on all ranks with one
/// text, if any failed. `noMemory` is the text for want of memory.
///
/// The work goes in rounds of some seconds, trajectory n to rank n mod ranks, and after each of
/// them the ranks agree on how it went and rank 0 takes what they have: no rank keeps results.
bool runShared(const Ensemble& ensemble, const KeptParts& kept, TrajectorySink* sink,
  const Ranks& ranks, const Progress& progress, const std::string& noMemory);

/// Rocks pushed apart on all ranks, if that is done anew in each iteration. Collective.
PushedApart pushedOnAll(const Ensemble& ensemble, const Ranks& ranks);

} // namespace rockfall::filters
