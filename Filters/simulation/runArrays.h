#pragma once

/// @file
/// Arrays that several outputs of a run have (runOutputs.h). Internal to its sources.

#include "rock/results.h"
#include "shared/arrays.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"

#include <cstdint>

namespace rockfall::filters
{

/// Arrays that say which rock, and in which iteration.
struct IdentityArrays
{
  vtkSmartPointer<vtkIdTypeArray> blockId;
  vtkSmartPointer<vtkIntArray> rockId, iteration;
  vtkSmartPointer<vtkIntArray> piece; ///< None where no rock can break.

  explicit IdentityArrays(vtkFieldData* data)
    : blockId(addArray<vtkIdTypeArray>(data, "BlockId"))
    , rockId(addArray<vtkIntArray>(data, "RockId"))
    , iteration(addArray<vtkIntArray>(data, "Iteration"))
  {
  }

  void append(std::int64_t block, int rock, int number, int ofRock)
  {
    if (this->piece)
    {
      this->piece->InsertNextValue(ofRock);
    }
    this->blockId->InsertNextValue(block);
    this->rockId->InsertNextValue(rock);
    this->iteration->InsertNextValue(number);
  }
};

/// The array of the numbers of pieces, where rocks can break.
inline vtkSmartPointer<vtkIntArray> pieceArray(bool breaking, vtkFieldData* data)
{
  return breaking ? addArray<vtkIntArray>(data, "Piece") : nullptr;
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
