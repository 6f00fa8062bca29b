#pragma once

/// @file
/// Trajectories as bytes, for the way from one process to another of the same program.

#include "rock/results.h"

#include <span>
#include <vector>

namespace rockfall
{

/// Appends all of a trajectory.
void pack(const Trajectory& trajectory, std::vector<char>& bytes);

/// Takes one trajectory off the front of `bytes`, the same bit for bit. Throws DataError if they
/// end within it.
Trajectory unpack(std::span<const char>& bytes);

} // namespace rockfall
