#include "vtkGrowingPaths.h"

#include "base/errors.h"
#include "shared/arrays.h"
#include "shared/cells.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/rockPaths.h"
#include "shared/withAbort.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <limits>

vtkStandardNewMacro(vtkGrowingPaths);

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkDataArray* timesOf(vtkDataObject* data)
{
  auto* paths = vtkPolyData::SafeDownCast(data);
  vtkDataArray* times = paths ? paths->GetPointData()->GetArray("Time") : nullptr;
  return times && times->GetNumberOfComponents() == 1 ? times : nullptr;
}

/// From the release to the last point of all; the executive makes nothing anew outside.
void writeTimeRange(vtkDataObject* data, vtkInformation* info)
{
  vtkDataArray* times = timesOf(data);
  const double range[2] = { 0.0,
    times && times->GetNumberOfTuples() > 0 ? std::max(0.0, times->GetRange(0)[1]) : 0.0 };
  info->Set(Pipeline::TIME_RANGE(), range, 2);
}

/// Whether all lines of `input` are drawn as they are at this time, and there is nothing else.
bool isWhole(vtkPolyData* input, vtkDataArray* times, double until)
{
  if (times->GetRange(0)[1] > until || input->GetNumberOfCells() != input->GetNumberOfLines())
  {
    return false;
  }
  vtkCellArray* lines = input->GetLines();
  for (vtkIdType line = 0; line < lines->GetNumberOfCells(); ++line)
  {
    if (lines->GetCellSize(line) < 2)
    {
      return false;
    }
  }
  return true;
}

/// The lines of `input` up to a time.
class Growth
{
public:
  Growth(vtkPolyData* input, vtkDataArray* times, double until)
    : Input(input)
    , Times(times)
    , Until(until)
  {
    this->Points->SetDataTypeToDouble();
    this->Arrays->InterpolateAllocate(input->GetPointData());
  }

  void Append(vtkIdType size, const vtkIdType* ids)
  {
    vtkIdType count = 0;
    while (count < size && this->Times->GetComponent(ids[count], 0) <= this->Until)
    {
      ++count;
    }
    this->Lines->InsertNextCell(int(std::max<vtkIdType>(2, count + (count < size ? 1 : 0))));
    this->AppendFirst(count, ids);
    if (count == 0 && size > 0)
    {
      this->AppendBetween(ids[0], ids[0], 0.0);
      this->AppendBetween(ids[0], ids[0], 0.0);
    }
    else if (count < size)
    {
      const double before = this->Times->GetComponent(ids[count - 1], 0);
      const double after = this->Times->GetComponent(ids[count], 0);
      this->AppendBetween(ids[count - 1], ids[count], (this->Until - before) / (after - before));
    }
    else if (size == 1)
    {
      this->AppendBetween(ids[0], ids[0], 0.0);
    }
  }

  void Finish(vtkPolyData* output)
  {
    output->SetPoints(this->Points);
    output->SetLines(this->Lines);
    output->GetPointData()->ShallowCopy(this->Arrays);
  }

private:
  void AppendFirst(vtkIdType count, const vtkIdType* ids)
  {
    // All at once where they lie one after the other, as those of a run do.
    const vtkIdType end = this->Points->GetNumberOfPoints();
    const auto jumps = [](vtkIdType one, vtkIdType next) { return next != one + 1; };
    if (count > 0 && std::adjacent_find(ids, ids + count, jumps) == ids + count)
    {
      this->Points->InsertPoints(end, count, ids[0], this->Input->GetPoints());
      this->Arrays->CopyData(this->Input->GetPointData(), end, count, ids[0]);
      for (vtkIdType k = 0; k < count; ++k)
      {
        this->Lines->InsertCellPoint(end + k);
      }
      return;
    }
    for (vtkIdType k = 0; k < count; ++k)
    {
      this->AppendBetween(ids[k], ids[k], 0.0);
    }
  }

  void AppendBetween(vtkIdType from, vtkIdType to, double share)
  {
    double a[3], b[3];
    this->Input->GetPoint(from, a);
    this->Input->GetPoint(to, b);
    const vtkIdType point = this->Points->InsertNextPoint(
      a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]));
    this->Arrays->InterpolateEdge(this->Input->GetPointData(), point, from, to, share);
    this->Lines->InsertCellPoint(point);
  }

  vtkPolyData* Input;
  vtkDataArray* Times;
  double Until;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Lines;
  vtkNew<vtkPointData> Arrays;
};

} // namespace

//------------------------------------------------------------------------------
vtkGrowingPaths::vtkGrowingPaths() = default;

//------------------------------------------------------------------------------
vtkGrowingPaths::~vtkGrowingPaths() = default;

//------------------------------------------------------------------------------
int vtkGrowingPaths::FillInputPortInformation(int, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  return 1;
}

//------------------------------------------------------------------------------
int vtkGrowingPaths::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInformation* info = outputVector->GetInformationObject(0);
  info->Remove(Pipeline::TIME_STEPS());
  writeTimeRange(vtkDataObject::GetData(inputVector[0]), info);
  return 1;
}

//------------------------------------------------------------------------------
int vtkGrowingPaths::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // The trajectories are those of the whole fall at any time.
  inputVector[0]->GetInformationObject(0)->Remove(Pipeline::UPDATE_TIME_STEP());
  return 1;
}

//------------------------------------------------------------------------------
int vtkGrowingPaths::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return rockfall::filters::withAbort(this, "The growing paths do not fit in memory",
    [&]
    {
      rockfall::filters::Input taken(rockfall::filters::InputKind::Trajectories);
      vtkPolyData* input = taken.take(inputVector[0]);
      if (!input)
      {
        throw rockfall::DataError("The Input is missing");
      }
      taken.require();
      if (rockfall::filters::inheritFailure(input, this))
      {
        return 1;
      }
      vtkInformation* info = outputVector->GetInformationObject(0);
      vtkPolyData* output = vtkPolyData::GetData(info);
      // The range was that of older trajectories if these have just been made.
      writeTimeRange(input, info);
      // The time is not written to the data: the executive would take those of any time for good
      // beyond the range.
      const double until = info->Has(Pipeline::UPDATE_TIME_STEP())
        ? info->Get(Pipeline::UPDATE_TIME_STEP())
        : std::numeric_limits<double>::infinity();
      output->GetFieldData()->ShallowCopy(input->GetFieldData());
      if (input->GetNumberOfLines() == 0)
      {
        return 1; // of a run that has made none yet, or of a rank that has none
      }
      vtkDataArray* times = timesOf(input);
      if (!times)
      {
        throw rockfall::DataError(
          "The Input has no point array Time of 1 component; the trajectories "
          "of Rockfall Simulation are wanted");
      }

      if (isWhole(input, times, until))
      {
        output->ShallowCopy(input); // and with it what is known of its arrays
        output->GetInformation()->Remove(vtkDataObject::DATA_TIME_STEP());
        return 1;
      }
      Growth growth(input, times, until);
      output->GetCellData()->CopyAllocate(input->GetCellData());
      vtkIdType made = 0;
      rockfall::filters::forEachLine(input,
        [&](vtkIdType cell, std::span<const vtkIdType> ids)
        {
          if (!ids.empty())
          {
            growth.Append(vtkIdType(ids.size()), ids.data());
            output->GetCellData()->CopyData(input->GetCellData(), cell, made++);
          }
        });
      growth.Finish(output);
      rockfall::filters::markShownUntil(until, output->GetFieldData());
      rockfall::filters::rememberRanges(output);
      return 1;
    });
}

//------------------------------------------------------------------------------
void vtkGrowingPaths::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
