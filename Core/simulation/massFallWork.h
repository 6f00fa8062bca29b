#pragma once

/// @file
/// What massFallGroup.cxx and massFallStep.cxx share.

#include "simulation/MassFall.h"

namespace rockfall
{

constexpr double kTooShort = 1e-9; // s

/// What is worth handing to another thread.
constexpr std::size_t kRockGrain = 16, kPairGrain = 32;

/// What a step of a group needs, kept by thread.
struct MassFall::Workspace
{
  GroupSolver solver;
  std::vector<GroupBody> bodies;
  std::vector<GroupContact> contacts;
  std::vector<double> energyBefore;
  std::vector<int> partners;
  std::vector<std::uint64_t> carriers; ///< By place, what carries it.
  /// First contact of each rock's with the slope among `contacts`, and of each pair.
  std::vector<std::size_t> slopeFirsts, firsts;
};

} // namespace rockfall
