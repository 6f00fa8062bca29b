#pragma once

/// @file
/// Lines of a collector from a polydata, and what passes them as VTK data.

#include "statistics/crossings.h"

#include <array>
#include <span>
#include <vector>

class vtkFieldData;
class vtkPolyData;
class vtkTable;

namespace rockfall::filters
{

/// A passing and the cell of its trajectory.
struct CollectedCrossing
{
  Crossing crossing;
  std::int64_t cell = 0;
};

/// Iteration and number of each rock that was released.
using ReleasedRocks = std::vector<std::array<int, 2>>;

/// Sorts them. Throws DataError if one is there twice.
void checkReleased(ReleasedRocks& rocks);

/// The polylines of `input`, without `origin`; named "line 1" and so on, with the barrier of
/// `barrier`. Throws DataError if there is none or one has fewer than two different places.
std::vector<CollectorLine> linesOf(
  vtkPolyData* input, const Vec3& origin, const CollectorLine& barrier);

/// Writes a vertex per passing. Other cell arrays of the trajectories go along. The field data say
/// what the tables need beside: CollectorReleased, CollectorRocks, CollectorLineName and
/// CollectorBarrier.
void writeCrossings(std::span<const CollectedCrossing> crossings,
  std::span<const CollectorLine> lines, const ReleasedRocks& released, const Vec3& origin,
  vtkPolyData* trajectories, vtkPolyData* output);

void writeReleased(const ReleasedRocks& released, vtkFieldData* field);

/// Writes a row per line.
void writeLines(
  std::span<const LineSummary> summaries, std::span<const CollectorLine> lines, vtkTable* output);

/// Per line, energy and height in descending order and the share of rocks that have at least as
/// much.
void writeExceedance(
  std::span<const LineSummary> summaries, std::int64_t released, vtkTable* output);

} // namespace rockfall::filters
