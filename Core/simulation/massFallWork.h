#pragma once

/// @file
/// What massFallGroup.cxx and massFallStep.cxx share.

#include "simulation/MassFall.h"

namespace rockfall
{

constexpr double kTooShort = 1e-9; // s

/// What a step of a group needs, kept by thread.
struct MassFall::Workspace
{
  GroupSolver solver;
  std::vector<GroupBody> bodies;
  std::vector<GroupContact> contacts;
  std::vector<double> energyBefore;
  std::vector<int> partners;
  std::vector<std::size_t> firsts; ///< First contact of each pair among `contacts`.
};

} // namespace rockfall
