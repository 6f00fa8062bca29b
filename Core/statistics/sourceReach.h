#pragma once

/// @file
/// How large a share of the rocks of a source comes to a cell.

#include "statistics/passages.h"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace rockfall
{

/// Sources of the rocks of a release, known by number and block.
class RockSources
{
public:
  struct Release
  {
    std::int64_t source = 0;
    std::int64_t iterations = 0; ///< That released the rock.
  };
  /// Throws DataError if the same rock had another source before.
  void add(int rock, std::int64_t blockId, const Release& release);
  /// Those of another part of the run. Throws DataError as above.
  void add(const RockSources& other);
  bool empty() const { return releases_.empty(); }
  /// By number and block.
  const std::map<std::pair<int, std::int64_t>, Release>& releases() const { return releases_; }

private:
  std::map<std::pair<int, std::int64_t>, Release> releases_;
};

/// Of the passages of one cell, the largest share over the sources: rocks of a source that came
/// over all of its releases. Rocks of other sources change nothing.
class SourceReach
{
public:
  explicit SourceReach(const RockSources& sources);

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
  std::vector<std::size_t> touched_; ///< Those that something came from.
};

} // namespace rockfall
