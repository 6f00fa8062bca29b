#pragma once

/// @file
/// The rocks of a release: how often each was released, how rare it is and where it comes from.

#include "statistics/copies.h"
#include "statistics/frequency.h"
#include "statistics/passages.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace rockfall
{

/// Releases of one rock in some iterations.
struct RockRelease
{
  std::int64_t iterations = 1;          ///< Iterations that released the rock.
  std::optional<double> frequency = {}; ///< 1/a
  std::optional<std::int64_t> source = {};
};

/// Rocks of a release, known by number and block. What a rock's passages in one iteration weigh is
/// its frequency over the iterations that released it.
class RockReleases
{
public:
  /// Throws DataError if the frequency is negative or not finite, or another one than the same rock
  /// had before.
  void add(int rock, std::int64_t blockId, const RockRelease& release);
  /// Takes in the rocks of another part of the run. Throws DataError as above.
  void add(const RockReleases& other);
  /// By number and block.
  const std::map<std::pair<int, std::int64_t>, RockRelease>& all() const { return rocks_; }
  bool haveFrequencies() const; ///< At least one.
  bool haveSources() const;     ///< Likewise.
  /// Throws DataError if a rock has two sources.
  void requireOneSource() const;
  /// Of one trajectory, 1/a. Throws DataError for a rock whose frequency is not known.
  double weight(const Passage& of) const;
  /// The same of a rock; NaN if its frequency is not known.
  double weight(int rock, std::int64_t blockId) const;
  FrequencyRange weights() const; ///< Of all rocks.
  RockRuns runs() const;
  /// The largest weight of a rock, 1/a.
  double largestWeight() const;

private:
  std::map<std::pair<int, std::int64_t>, RockRelease> rocks_;
  std::string twoSources_; ///< Error of the first rock that has two; else empty.
};

} // namespace rockfall
