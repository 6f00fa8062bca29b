#pragma once

/// @file
/// Where a rock is at any time, from its samples.

#include "rock/results.h"
#include "simulation/runOutputs.h"

namespace rockfall::filters
{

/// Motion of a rock.
enum class MotionState
{
  Flying = 0,
  InContact = 1,
  Stopped = 2,    ///< Lies at rest for good.
  LeftDomain = 3, ///< Gone; shown where it left, as it left.
};

/// Interpolates between the samples around `time`: positions, velocities and scalars linearly,
/// orientations along the shortest turn, contact as in the nearer sample. Before the first and
/// after the last sample the rock is as there. The trajectory has at least one sample.
Sample sampleAt(const Trajectory& trajectory, double time);

MotionState stateAt(const Trajectory& trajectory, double time);

/// Both, to be shown.
ShownRock momentOf(const Trajectory& trajectory, double time);

} // namespace rockfall::filters
