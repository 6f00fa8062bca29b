#pragma once

/// @file
/// Text for the user of a simulation: the state of its run, and notes on its inputs.

#include "rock/Rock.h"
#include "run/ensemble.h"
#include "shared/ranks.h"
#include "simulation/liveRun.h"
#include "terrain/Terrain.h"

#include <span>
#include <string>

namespace rockfall::filters
{

/// "finished: 1,000 trajectories in 12 s", "stopped: 12,300 of …", or how far it is.
std::string statusOf(const LiveRun& live);

/// Note on blocks that fit together, as those of a cut mass, but fall each as if alone.
void tellApart(std::span<const Rock> rocks);

/// A note that what rocks of a run without contacts between them are given for these has no effect.
void tellIdleContacts(bool file, bool push, bool cohesion);

/// Notes on rocks of no rock, on more of them than fall, and on those that start in the air.
void tellOdd(
  const Terrain& terrain, std::span<const Rock> rocks, std::span<const double> frequencies);

/// Note on nets that wear or fill up, of which each rock meets a new one.
void tellNewNets(const Terrain& terrain);

/// Note on impulses that are asked for on a slope on which there are none.
void tellIdleImpulses(const Terrain& terrain, const SimulationParameters& parameters);

/// Note on realisations that nothing makes differ.
void tellAlike(const Terrain& terrain, std::span<const Rock> rocks, int iterations);

/// The note on what broke, in a run in which rocks may.
std::vector<std::string> brokenNotes(
  const BrokenRocks& broken, const SimulationParameters& parameters);

/// The notes on rocks that got energy from nowhere, or lost it there.
std::vector<std::string> unclosedNotes(const UnclosedBooks& books);

/// The notes on rocks that barriers are too low or too short for.
std::vector<std::string> passedNotes(const PassedBarriers& barriers);

/// Note of the first rank on blocks that were pushed apart.
void tellPushed(const Ensemble& ensemble, const PushedApart& pushed, const Ranks& ranks);

} // namespace rockfall::filters
