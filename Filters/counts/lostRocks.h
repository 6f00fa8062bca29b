#pragma once

/// @file
/// Whom a run lost: counted from its outputs, kept in field arrays, told in
/// notes.

#include "statistics/lost.h"

#include <string>
#include <vector>

class vtkFieldData;
class vtkPolyData;
class vtkTable;

namespace rockfall::filters
{

/// Of a Fate of a rock, by its number.
Loss lossOf(double fate);

/// Counts the rows of a table of summaries.
LostRocks lostOf(vtkTable* summary);

/// Counts the polylines of trajectories, by the cell array Fate. None without
/// that array. Throws DataError for a piece without its rock: all that counts rocks asks this.
LostRocks lostOf(vtkPolyData* trajectories);

/// Notes on trajectories that are not all of their run, or of several runs that differ, or of one
/// that was made again, or that fell on another slope than `mesh`, which may be null.
std::vector<std::string> doubtsOn(vtkPolyData* trajectories, vtkPolyData* mesh);

/// Puts the counts there: RocksReleased, RocksMoving, RocksOverEdge,
/// RocksInNodata and RocksUnmoved.
void writeLost(const LostRocks& lost, vtkFieldData* fieldData);

/// Keeps and tells: the field arrays and the notes, with further ones behind
/// them. Not `shown`, they are kept only.
void tellLost(const LostRocks& lost, vtkFieldData* fieldData,
  const std::vector<std::string>& further = {}, bool shown = true);

/// Shows notes once, and keeps them in the field array Notes of several
/// outputs. Not `shown`, they are kept only.
void tellOn(
  std::span<vtkFieldData* const> outputs, const std::vector<std::string>& notes, bool shown = true);

} // namespace rockfall::filters
