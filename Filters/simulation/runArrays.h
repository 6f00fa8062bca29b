#pragma once

/// @file
/// Arrays that several outputs of a run have (runOutputs.h). Internal to its sources.

#include "rock/results.h"
#include "shared/columns.h"
#include "simulation/runOutputs.h"

#include "vtkFieldData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"

namespace rockfall::filters
{

/// Adds arrays that say which rock, and in which iteration. `of`: its summary.
template <typename Row, typename Of>
void addIdentity(Columns<Row>& columns, Of of)
{
  columns.add("BlockId", [of](const Row& row) { return of(row).blockId; });
  columns.add("RockId", [of](const Row& row) { return of(row).rock; });
  columns.add("Iteration", [of](const Row& row) { return of(row).iteration; });
}

/// Adds the numbers of pieces where rocks can break. `of`: a summary or a rock that is shown.
template <typename Row, typename Of>
void addPiece(const RunFrame& frame, Columns<Row>& columns, Of of)
{
  if (frame.breaking)
  {
    columns.add("Piece", [of](const Row& row) { return of(row).piece; });
  }
}

/// Adds frequencies where they are known.
template <typename Row>
void addFrequency(const RunFrame& frame, Columns<Row>& columns)
{
  if (!frame.frequencies.empty())
  {
    columns.add(
      "Frequency", [&frame](const Row& row) { return frame.frequencies[std::size_t(row.rock)]; });
  }
}

/// Points in double precision.
inline vtkSmartPointer<vtkPoints> doublePoints()
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  return points;
}

inline void insertPoint(vtkPoints* points, const Vec3& world)
{
  points->InsertNextPoint(world.data());
}

/// Gives back what the arrays have grown beyond their content.
inline void squeeze(vtkFieldData* data)
{
  for (int k = 0; k < data->GetNumberOfArrays(); ++k)
  {
    data->GetAbstractArray(k)->Squeeze();
  }
}

} // namespace rockfall::filters
