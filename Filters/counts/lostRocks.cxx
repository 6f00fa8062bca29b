#include "counts/lostRocks.h"

#include "base/errors.h"
#include "rock/results.h"
#include "shared/arrays.h"
#include "shared/cells.h"
#include "shared/errorReport.h"
#include "shared/inputContent.h"
#include "shared/rockPaths.h"
#include "statistics/copies.h"

#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <string>

namespace rockfall::filters
{

Loss lossOf(double fate)
{
  const auto code = Fate(int(fate));
  return code == Fate::Moving    ? Loss::Moving
    : code == Fate::LeftDomain   ? Loss::OverEdge
    : code == Fate::LostInNodata ? Loss::InNodata
                                 : Loss::None;
}

LostRocks lostOf(vtkTable* summary)
{
  LostRocks lost;
  vtkFieldData* rows = summary->GetRowData();
  vtkDataArray *fate = rows->GetArray("FateCode"), *time = rows->GetArray("EndTime"),
               *way = rows->GetArray("PathLength");
  vtkDataArray* piece = rows->GetArray("Piece");
  for (vtkIdType k = 0; fate && time && way && k < fate->GetNumberOfTuples(); ++k)
  {
    lost.add(lossOf(fate->GetTuple1(k)), time->GetTuple1(k), way->GetTuple1(k),
      piece ? int(piece->GetTuple1(k)) : 0);
  }
  return lost;
}

namespace
{

/// A piece counts with its rock, which is before it: as a rock of its own it would be released, and
/// as frequent, once more.
void checkPieces(vtkPolyData* trajectories)
{
  vtkDataArray* piece = trajectories->GetCellData()->GetArray("Piece");
  std::array<vtkDataArray*, 3> names{};
  for (std::size_t k = 0; k < names.size(); ++k)
  {
    names[k] =
      trajectories->GetCellData()->GetArray(std::array{ "Iteration", "RockId", "BlockId" }[k]);
    if (!names[k] || !piece)
    {
      return; // told by what asks for them, or there are none
    }
  }
  const vtkIdType first = trajectories->GetNumberOfVerts(); // polydata's cells begin with them
  for (vtkIdType cell = first; cell < first + trajectories->GetNumberOfLines(); ++cell)
  {
    if (piece->GetTuple1(cell) > 0.0 &&
      (cell == first ||
        !std::all_of(names.begin(), names.end(),
          [cell](vtkDataArray* of) { return of->GetTuple1(cell) == of->GetTuple1(cell - 1); })))
    {
      const auto text = [cell](vtkDataArray* of)
      { return std::to_string(std::int64_t(of->GetTuple1(cell))); };
      throw DataError("The Input has piece " + text(piece) + " of rock " + text(names[1]) +
        " of iteration " + text(names[0]) + " (block " + text(names[2]) +
        ") without the rock before it: a rock and its pieces count as one, so a Threshold must "
        "leave out both or none");
    }
  }
}

} // namespace

LostRocks lostOf(vtkPolyData* trajectories)
{
  checkPieces(trajectories);
  LostRocks lost;
  vtkDataArray* fate = trajectories->GetCellData()->GetArray("Fate");
  vtkDataArray* time = trajectories->GetPointData()->GetArray("Time");
  vtkDataArray* piece = trajectories->GetCellData()->GetArray("Piece");
  if (!fate || !time)
  {
    return lost;
  }
  forEachLine(trajectories,
    [&](vtkIdType cell, std::span<const vtkIdType> ids)
    {
      double way = 0.0;
      Vec3 start, point;
      for (std::size_t k = 0; k < ids.size() && way < kLeastWay; ++k)
      {
        trajectories->GetPoint(ids[k], (k == 0 ? start : point).data());
        way = k == 0 ? 0.0 : std::max(way, (point - start).norm());
      }
      lost.add(lossOf(fate->GetTuple1(cell)), ids.empty() ? 0.0 : time->GetTuple1(ids.back()), way,
        piece ? int(piece->GetTuple1(cell)) : 0);
    });
  return lost;
}

namespace
{

/// How many rocks have the way of another one of their iteration, from the first bit to the last: a
/// run that was made again under other block ids.
std::int64_t copiesIn(vtkPolyData* trajectories)
{
  vtkDataArray* iteration = trajectories->GetCellData()->GetArray("Iteration");
  if (!iteration)
  {
    return 0;
  }
  std::set<std::array<double, 7>> ways;
  std::int64_t copies = 0;
  forEachLine(trajectories,
    [&](vtkIdType cell, std::span<const vtkIdType> ids)
    {
      Vec3 start, stop;
      trajectories->GetPoint(ids.empty() ? 0 : ids.front(), start.data());
      trajectories->GetPoint(ids.empty() ? 0 : ids.back(), stop.data());
      if ((stop - start).norm() > kLeastWay)
      {
        copies += !ways
                     .insert({ iteration->GetTuple1(cell), start.x(), start.y(), start.z(),
                       stop.x(), stop.y(), stop.z() })
                     .second;
      }
    });
  return copies;
}

} // namespace

std::vector<std::string> doubtsOn(vtkPolyData* trajectories, vtkPolyData* mesh)
{
  std::vector<std::string> notes;
  if (std::string other = otherSlope(trajectories, mesh); !other.empty())
  {
    notes.push_back(std::move(other));
  }
  vtkFieldData* fields = trajectories->GetFieldData();
  std::ranges::move(doubtsOfRun(fields), std::back_inserter(notes));
  if (isRunning(fields))
  {
    notes.emplace_back("The run goes on: these are its rocks so far");
  }
  std::ranges::move(copyNotes(copiesIn(trajectories)), std::back_inserter(notes));
  vtkDataArray* released = fields->GetArray(kRocksReleased);
  const std::int64_t there = lostOf(trajectories).rocks;
  const std::int64_t all =
    released && released->GetNumberOfTuples() == 1 ? std::int64_t(released->GetTuple1(0)) : there;
  if (there < all)
  {
    notes.push_back("The Input has " + std::to_string(there) + " of the " + std::to_string(all) +
      " rocks of its run: numbers, shares and frequencies are of these alone");
  }
  else if (there > all)
  {
    notes.push_back("The Input has " + std::to_string(there) + " rocks, its run " +
      std::to_string(all) +
      ": the slope and the properties of what was appended are not known. Group Datasets keeps "
      "them");
  }
  return notes;
}

void writeLost(const LostRocks& lost, vtkFieldData* fieldData)
{
  const std::pair<const char*, std::int64_t> counts[] = { { kRocksReleased, lost.rocks },
    { "RocksMoving", lost.moving }, { "RocksOverEdge", lost.overEdge },
    { "RocksInNodata", lost.inNodata }, { "RocksUnmoved", lost.unmoved } };
  for (const auto& [name, count] : counts)
  {
    addArray<vtkIdTypeArray>(fieldData, name)->InsertNextValue(vtkIdType(count));
  }
}

namespace
{

void tell(const std::vector<std::string>& notes, vtkFieldData* fieldData, bool shown)
{
  if (shown)
  {
    showNotes(notes, fieldData);
    return;
  }
  keepNotes(notes, fieldData);
}

} // namespace

void tellLost(const LostRocks& lost, vtkFieldData* fieldData,
  const std::vector<std::string>& further, bool shown)
{
  if (lost.rocks > 0) // else they are not known
  {
    writeLost(lost, fieldData);
  }
  std::vector<std::string> notes = lostNotes(lost);
  std::ranges::move(stillNotes(lost), std::back_inserter(notes));
  notes.insert(notes.end(), further.begin(), further.end());
  tell(notes, fieldData, shown);
}

void tellOn(
  std::span<vtkFieldData* const> outputs, const std::vector<std::string>& notes, bool shown)
{
  tell(notes, outputs.front(), shown);
  vtkAbstractArray* kept = outputs.front()->GetAbstractArray("Notes");
  for (vtkFieldData* output : outputs.subspan(1))
  {
    if (kept && !notes.empty())
    {
      output->AddArray(kept);
    }
  }
}

} // namespace rockfall::filters
