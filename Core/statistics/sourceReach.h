#pragma once

/// @file
/// How large a share of the rocks of a source comes to a cell.

#include "statistics/rockReleases.h"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace rockfall
{

/// Of the passages of one cell, the largest share over the sources: rocks of a source that came
/// over all of its releases. Rocks of other sources change nothing, nor do those of another run,
/// whose sources may have the same numbers.
class SourceReach
{
public:
  /// Throws DataError if a rock has two sources.
  explicit SourceReach(const RockReleases& releases);

  /// Throws DataError for a rock whose source is not known.
  void add(const Passage& passage);
  /// Of what was added since it was asked before.
  double take();

private:
  struct Source
  {
    std::int64_t released = 0, came = 0;
  };
  std::vector<Source> sources_;
  std::map<std::pair<int, std::int64_t>, std::size_t> sourceOf_;
  std::vector<std::size_t> touched_; ///< Sources that a rock of the cell is of.
};

} // namespace rockfall
