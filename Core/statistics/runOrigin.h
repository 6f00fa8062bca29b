#pragma once

/// @file
/// Runs whose rocks are counted together: whether they belong together.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace rockfall
{

/// What rocks fell on, and by which properties.
struct RunOrigin
{
  std::uint64_t slope = 0; ///< Number of its content; 0: not known.
  std::string properties;  ///< statementOf its parameters; empty: not known.
};

/// Notes on runs of another slope, or of other properties, than the first of which that is known.
/// `name`: of a run, for people.
std::vector<std::string> askAfterRuns(
  std::span<const RunOrigin> runs, const std::function<std::string(std::size_t)>& name);

} // namespace rockfall
