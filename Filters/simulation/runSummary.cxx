// The table of summaries.

#include "simulation/runOutputs.h"

#include "simulation/runArrays.h"

#include "vtkDataSetAttributes.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

namespace rockfall::filters
{

namespace
{

using S = const TrajectorySummary&;

void addNumbers(const RunFrame& frame, Columns<TrajectorySummary>& columns)
{
  const Vec3& o = frame.origin;
  columns.add("EndTime", [](S s) { return s.endTime; });
  columns.add("StartX", [&o](S s) { return s.start.x() + o.x(); });
  columns.add("StartY", [&o](S s) { return s.start.y() + o.y(); });
  columns.add("StartZ", [&o](S s) { return s.start.z() + o.z(); });
  columns.add("StopX", [&o](S s) { return s.stop.x() + o.x(); });
  columns.add("StopY", [&o](S s) { return s.stop.y() + o.y(); });
  columns.add("StopZ", [&o](S s) { return s.stop.z() + o.z(); });
  columns.add("RunOut", [](S s) { return s.runOut; });
  columns.add("PathLength", [](S s) { return s.pathLength; });
  columns.add("MaxSpeed", [](S s) { return s.maxSpeed; });
  columns.add("MaxKineticEnergy", [](S s) { return s.maxKineticEnergy; });
  columns.add("MaxHeightOverGround", [](S s) { return s.maxHeightOverGround; });
  columns.add("Mass", [](S s) { return s.mass; });
  columns.add("Volume", [](S s) { return s.volume; });
  columns.add("EnergyReleased", [](S s) { return s.energy.released; });
  columns.add("EnergyKinetic", [](S s) { return s.energy.kinetic; });
  columns.add("EnergyStrain", [](S s) { return s.energy.strain; });
  columns.add("EnergyFriction", [](S s) { return s.energy.friction; });
  columns.add("EnergyRestitution", [](S s) { return s.energy.restitution; });
  columns.add("EnergyVibration", [](S s) { return s.energy.vibration; });
  columns.add("EnergyDamping", [](S s) { return s.energy.damping; });
  columns.add("EnergyStructures", [](S s) { return s.energy.structures; });
  columns.add("EnergyScars", [](S s) { return s.energy.scars; });
  columns.add("EnergyRolling", [](S s) { return s.energy.rolling; });
  columns.add("EnergyExchanged", [](S s) { return s.energy.exchanged; });
  columns.add("EnergyNumerical", [](S s) { return s.energy.numerical; });
  columns.add("LastingLoss", [](S s) { return s.lastingLoss; });
}

} // namespace

struct SummaryRows::Arrays
{
  vtkNew<vtkTable> data;
  Columns<TrajectorySummary> columns{ data->GetRowData() };
};

SummaryRows::SummaryRows(const RunFrame& frame)
  : arrays_(std::make_unique<Arrays>())
{
  Columns<TrajectorySummary>& columns = arrays_->columns;
  const auto itself = [](S s) -> S { return s; };
  addIdentity(columns, itself);
  columns.add("Shape", [&frame](S s) { return shapeName(frame.shapes[std::size_t(s.rock)]); });
  columns.add("Fate", [](S s) { return fateName(s.fate); });
  columns.add("FateCode", [](S s) { return int(s.fate); });
  addNumbers(frame, columns);
  columns.add("SourceId", [&frame](S s) { return frame.sourceIds[std::size_t(s.rock)]; });
  columns.add("SourceName", [&frame](S s) { return frame.sourceNames[std::size_t(s.rock)]; });
  columns.add("Impacts", [](S s) { return s.impacts; });
  columns.add("ContactSteps", [](S s) { return s.contactSteps; });
  columns.add("OpenCloseIterations", [](S s) { return s.openCloseIterations; });
  columns.add("CutSteps", [](S s) { return s.cutSteps; });
  columns.add("UnsettledSteps", [](S s) { return s.unsettledSteps; });
  addFrequency(frame, columns);
  addPiece(frame, columns, itself);
  if (frame.breaking)
  {
    columns.add("Pieces", [](S s) { return double(s.pieces); });
    columns.add("EnergyBreaking", [](S s) { return s.energy.breaking; });
    columns.add("FinesMass", [](S s) { return s.finesMass; });
    columns.add("FinesEnergy", [](S s) { return s.finesEnergy; });
  }
}

SummaryRows::~SummaryRows() = default;

void SummaryRows::append(const TrajectorySummary& summary)
{
  arrays_->columns.append(summary);
}

void SummaryRows::copy(vtkTable* output) const
{
  output->DeepCopy(arrays_->data);
}

void SummaryRows::finish(vtkTable* output)
{
  squeeze(arrays_->data->GetRowData());
  output->ShallowCopy(arrays_->data);
}

void renameSources(const RunFrame& frame, vtkTable* summary)
{
  vtkDataArray* rocks = vtkDataArray::SafeDownCast(summary->GetColumnByName("RockId"));
  if (!rocks || !summary->GetColumnByName("SourceName"))
  {
    return; // of no trajectory
  }
  // Another array: whoever has the table of before keeps its names.
  const auto names = addArray<vtkStringArray>(summary->GetRowData(), "SourceName");
  for (vtkIdType row = 0; row < rocks->GetNumberOfTuples(); ++row)
  {
    names->InsertNextValue(frame.sourceNames[std::size_t(rocks->GetComponent(row, 0))]);
  }
}

} // namespace rockfall::filters
