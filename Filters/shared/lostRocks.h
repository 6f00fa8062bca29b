#pragma once

/// @file
/// Whom a run lost: counted from its outputs, kept in field arrays, told in notes.

#include "statistics/lost.h"

class vtkFieldData;
class vtkPolyData;
class vtkTable;

namespace rockfall::filters
{

/// Counts the rows of a table of summaries.
LostRocks lostOf(vtkTable* summary);

/// Counts the polylines of trajectories, by the cell array Fate. None without that array.
LostRocks lostOf(vtkPolyData* trajectories);

/// Puts the counts there: RocksReleased, RocksMoving, RocksOverEdge, RocksInNodata and
/// RocksUnmoved.
void writeLost(const LostRocks& lost, vtkFieldData* fieldData);

/// Counts, keeps and tells: the field arrays and the notes.
void tellLost(const LostRocks& lost, vtkFieldData* fieldData);

} // namespace rockfall::filters
