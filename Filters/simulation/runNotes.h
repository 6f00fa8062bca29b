#pragma once

/// @file
/// Text for the user of a simulation: the state of its run, and notes on its inputs.

#include "rock/Rock.h"
#include "run/ensemble.h"
#include "simulation/liveRun.h"
#include "terrain/Terrain.h"

#include <span>
#include <string>
#include <vector>

class vtkFieldData;

namespace rockfall::filters
{

/// "finished: 1,000 trajectories in 12 s", "stopped: 12,300 of …", or how far it is.
std::string statusOf(const LiveRun& live);

/// Notes that the slope and the rocks of a run came with, each once.
std::vector<std::string> inputNotes(vtkFieldData* terrain, vtkFieldData* rocks);

/// Notes on a run that is about to be made: blocks that fit together, as those of a cut mass, but
/// fall each as if alone; nets that wear or fill up, of which each rock meets a new one; impulses
/// that are asked for on a slope on which there are none; rocks of no rock, more of them than fall,
/// and those that start in the air; and realisations that nothing makes differ.
std::vector<std::string> notesBefore(const Terrain& terrain, std::span<const Rock> rocks,
  std::span<const double> frequencies, const SimulationParameters& parameters);

/// The note on what broke, in a run in which rocks may.
std::vector<std::string> brokenNotes(
  const BrokenRocks& broken, const SimulationParameters& parameters);

/// The notes on rocks that got energy from nowhere, or lost it there.
std::vector<std::string> unclosedNotes(const UnclosedBooks& books);

/// The notes on rocks that barriers are too low or too short for.
std::vector<std::string> passedNotes(const PassedBarriers& barriers);

/// The note on blocks that were pushed apart.
std::vector<std::string> pushedNotes(const Ensemble& ensemble, const PushedApart& pushed);

} // namespace rockfall::filters
