#pragma once

/// @file
/// Lines of a collector from a polydata, and what passes them as VTK data.

#include "statistics/crossings.h"
#include "statistics/lost.h"

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

class vtkFieldData;
class vtkPolyData;
class vtkTable;

namespace rockfall
{
class HeightGrid;
}

namespace rockfall::filters
{

/// Field array of crossings: number of the content of the slope that their rocks fell on.
inline constexpr char kCollectorSlope[] = "CollectorSlope";
/// The same of the properties that they fell by.
inline constexpr char kCollectorRun[] = "CollectorRun";
/// Field array of crossings: how many their collector made.
inline constexpr char kCollectorCrossings[] = "CollectorCrossings";

/// Field array of crossings: frequencies of all rocks that were released, NaN where not known.
inline constexpr char kCollectorFrequencies[] = "CollectorFrequencies";

/// A passing and the cell of its trajectory.
struct CollectedCrossing
{
  Crossing crossing;
  std::int64_t cell = 0;
};

/// A rock that was released, and how it ended.
struct CollectedRock
{
  int iteration = 0;
  int rock = 0;
  std::int64_t blockId = 0; ///< Tells the rocks of two runs from each other.
  Loss loss = Loss::None;
  double endTime = 0.0;                                        ///< s
  double frequency = std::numeric_limits<double>::quiet_NaN(); ///< 1/a, if known.
};
using ReleasedRocks = std::vector<CollectedRock>;

/// Those of trajectories, by the cell arrays Iteration, RockId and BlockId; none without them.
ReleasedRocks releasedIn(vtkPolyData* trajectories);

/// Adds a rock of this `frequency` (1/a, NaN if not known), or what became of a piece of the last one:
/// a rock is lost if one of its pieces is.
void addPath(const RockPath& path, Loss loss, double frequency, ReleasedRocks& rocks);

/// Sorts them. Throws DataError if one is there twice.
void checkReleased(ReleasedRocks& rocks);
/// Whether the rock of a crossing is among them, as checkReleased has sorted them.
bool isReleased(const ReleasedRocks& rocks, const Crossing& crossing);

/// Of each line, rocks that were lost and had not passed it before. `use`, if given, is called for
/// each of them.
std::vector<LostRocks> lostBefore(std::size_t lines, std::span<const Crossing> crossings,
  const ReleasedRocks& released,
  const std::function<void(std::size_t line, const CollectedRock& rock)>& use = {});
/// The notes on them: of the line that misses most.
std::vector<std::string> lostBeforeNotes(std::span<const LostRocks> lost);

/// Note on lines that go on where the slope has no ground: over two cells, as borders are drawn by
/// eye.
void askAfterGroundUnder(
  std::span<const CollectorLine> lines, const HeightGrid& slope, std::vector<std::string>& notes);

/// Whether a rock came to rest across a line that its centre has not passed.
bool liesAcross(const RockPath& path, const CollectorLine& line);

/// Notes on lines that no rock reached, that rocks lie on (`across`, of each line), that rocks may
/// have been lost before, that too few passed for the quantiles, and that these and shares are of
/// rocks of different frequencies, `weights` of all that were released.
std::vector<std::string> lineNotes(std::span<const LineSummary> summaries,
  std::span<const CollectorLine> lines, std::span<const LostRocks> lost,
  const FrequencyRange& weights, std::span<const std::int64_t> across = {});

/// The polylines of `input`, without `origin`; named "line 1" and so on, with
/// the barrier of `barrier`. Throws DataError if there is none or one has fewer
/// than two different places.
std::vector<CollectorLine> linesOf(
  vtkPolyData* input, const Vec3& origin, const CollectorLine& barrier);

/// Writes a vertex per passing. Other cell arrays of the trajectories go along.
/// The field data say what the tables need beside: CollectorReleased, CollectorCrossings,
/// CollectorRocks, CollectorBlocks, CollectorLosses, CollectorEnds, CollectorFrequencies,
/// CollectorLineName, CollectorBarrier, CollectorOffset, CollectorSlope and CollectorRun.
void writeCrossings(std::span<const CollectedCrossing> crossings,
  std::span<const CollectorLine> lines, const ReleasedRocks& released, const Vec3& origin,
  vtkPolyData* trajectories, vtkPolyData* output);

/// The rocks that a collector looked at, and how many crossings it made.
void writeReleased(const ReleasedRocks& released, std::size_t crossings, vtkFieldData* field);

/// Writes a row per line.
void writeLines(std::span<const LineSummary> summaries, std::span<const CollectorLine> lines,
  std::span<const LostRocks> lost, vtkTable* output);

/// Per line, energy and height in descending order and the share of rocks that have at least as
/// much.
void writeExceedance(
  std::span<const LineSummary> summaries, std::int64_t released, vtkTable* output);

} // namespace rockfall::filters
