#pragma once

/// @file
/// Rocks whose way is not known to its end, and how that is told: the results have less of them
/// than the slope has.

#include "base/types.h"

#include <span>
#include <string>
#include <vector>

namespace rockfall
{

/// A run that ends before this is a look at its inputs: every rock still moves. s
constexpr double kLeastRun = 0.1;
/// A rock that gets no farther has not moved. m
constexpr double kLeastWay = 0.1;

/// How a rock's way is not known to its end.
enum class Loss
{
  None,
  Moving,   ///< Still moving at the end time.
  OverEdge, ///< Went over the edge of the DEM.
  InNodata, ///< Fell into a hole of nodata.
};

/// Rocks × iterations by what was lost of them.
struct LostRocks
{
  std::int64_t rocks = 0;    ///< All of them.
  std::int64_t pieces = 0;   ///< Pieces that rocks broke into.
  std::int64_t moving = 0;   ///< Still moving at the end time.
  std::int64_t overEdge = 0; ///< Went over the edge of the DEM.
  std::int64_t inNodata = 0; ///< Fell into a hole of nodata.
  std::int64_t unmoved = 0;  ///< Lie where they were released.
  double endTime = 0.0;      ///< Of the longest of those that still move, s.
  double firstEnd = 0.0;     ///< Of the shortest run of which some still move, s; 0: of the same.
  bool lastLost = false;     ///< The rock that was added last is one of those.

  /// A rock that ended at `time`, s, and got `way` away from its start, m; or a `piece` of the
  /// last rock, which is lost if one of its pieces is.
  void add(Loss loss, double time, double way, int piece = 0);
  void add(const LostRocks& other);
  std::int64_t lost() const { return moving + overEdge + inNodata; }
};

/// "12 of 50 rocks were still moving at EndTime (6 s)`before`: …" and the like, one note for each
/// kind of loss; none if nothing was lost.
std::vector<std::string> lostNotes(const LostRocks& lost, const std::string& before = "");

/// The note on a run in which nothing moved; none in any other.
std::vector<std::string> stillNotes(const LostRocks& lost);

} // namespace rockfall
