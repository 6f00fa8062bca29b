#pragma once

/// @file
/// What massFallGroup.cxx and massFallStep.cxx share.

#include "simulation/MassFall.h"

#include <deque>

namespace rockfall
{

constexpr double kTooShort = 1e-9; // s

/// A rock's partner in the step, if it has none.
constexpr int kMeetsNone = -3;

/// Whether an open contact comes in as an impact within a step of `h`.
inline bool hits(const Contact& c, double approach, double resting, double h)
{
  return !c.closed() && approach > resting && c.gap() < approach * h;
}

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
  /// Contacts that are found in a second look, behind the others in `contacts`, and whose they are.
  std::deque<Contact> added;
  std::vector<std::size_t> addedTo;
  std::vector<char> missed; ///< By pair.
  bool looked = false;      ///< Where the step ends.
};

} // namespace rockfall
