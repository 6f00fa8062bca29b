#pragma once

/// @file
/// Rocks of several runs that are counted together: which run each is of, and which of them fell
/// twice.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace rockfall
{

/// Runs of rocks, known by number and block. Each run numbers its rocks from 0, so that two blocks
/// of one number are of two runs; and its sources, so that a source of one number in two runs is
/// two sources.
class RockRuns
{
public:
  RockRuns() = default;
  /// A run goes on as its blocks do: while the block is as far from the number as before, else while
  /// the number ascends. Of rocks without two blocks of one number all are of run 0.
  explicit RockRuns(std::vector<std::pair<int, std::int64_t>> rocks);

  int count() const { return count_; }
  int of(int rock, std::int64_t blockId) const; ///< From 0, in the order of blocks.
  /// Whether another run has a rock of this number.
  bool hasSeveral(int rock) const;

private:
  int count_ = 1;
  std::map<std::pair<int, std::int64_t>, int> runs_; ///< Empty if all are of run 0.
};

/// Finds rocks that fell exactly as one of another run did: of the same iteration and number, under
/// another block id, with the same in all that is known of them. It is one run that was made again.
class Copies
{
public:
  /// What is known of a rock, in any order.
  void add(int iteration, int rock, std::int64_t blockId, std::span<const double> values);
  std::int64_t count() const; ///< Rocks beyond the first of each.

private:
  /// Sums of mixed values.
  std::map<std::tuple<int, int, std::int64_t>, std::uint64_t> contents_;
};

/// The note on so many of them; none of 0.
std::vector<std::string> copyNotes(std::int64_t copies);

} // namespace rockfall
