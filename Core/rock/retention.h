#pragma once

/// @file
/// The part of a trajectory that is kept.

#include "rock/results.h"

#include <vector>

namespace rockfall
{

enum class Retention
{
  Nothing = 0,        ///< The summary only.
  StoppingPoints = 1, ///< The last sample.
  Events = 2,         ///< Release, touches, take-offs, end.
  Thinned = 3,        ///< Release, all knots, end: between them the motion is one cubic.
  Full = 4,           ///< All samples.
};

/// The parts of a trajectory that somebody asks for. No others are collected.
struct Kept
{
  Retention samples = Retention::Full;
  bool impacts = true; ///< The list of impacts; without it they are counted.
};

/// Whether one that is neither the first nor the last is kept.
bool isKeptBetween(const Sample& sample, Retention retention);

/// Samples that `retention` keeps: indices, rising.
std::vector<std::size_t> keptSamples(const std::vector<Sample>& samples, Retention retention);

/// Drops the other samples of a trajectory and gives their memory back.
void thin(Trajectory& trajectory, Retention retention);

} // namespace rockfall
