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
  /// statementOf its parameters, and as the last line, if it is known, a releaseLine; empty: not
  /// known.
  std::string properties;
};

/// What a run released, as a line of its properties: the number of its content, and the block of its
/// first rock, from which on rocks are numbered.
std::string releaseLine(std::uint64_t content, std::int64_t firstBlock);

/// Notes on runs of another slope, or of other properties, than the first of which that is known,
/// and on runs that released other rocks under the same numbers. `name`: of a run, for people.
std::vector<std::string> askAfterRuns(
  std::span<const RunOrigin> runs, const std::function<std::string(std::size_t)>& name);

} // namespace rockfall
