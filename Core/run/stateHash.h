#pragma once

/// @file
/// A number that two runs share if and only if (but for chance, 2⁻⁶⁴) they had the same motion, bit
/// for bit: to compare threads, ranks, machines and restarts.

#include "rock/results.h"

namespace rockfall
{

/// Over the bits of a trajectory's motion: rock, iteration, fate, start, end, last state, energy
/// audit, counts, and every impact. Not over its samples and what is found by looking at them
/// (greatest height, path length), so that it depends neither on the output interval nor on what is
/// kept. Needs the last sample. Never 0.
std::uint64_t motionHash(const Trajectory& trajectory);

/// Of a whole run: trajectories' hashes, in the order (iteration, rock).
class StateHash
{
public:
  void add(std::uint64_t hash);
  std::uint64_t value() const { return value_; }
  std::string text() const; ///< 16 hexadecimal digits.

private:
  std::uint64_t value_ = 0;
};

} // namespace rockfall
