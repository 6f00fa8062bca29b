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

/// A column of numbers of the table.
struct Column
{
  const char* name;
  double (*value)(const TrajectorySummary& summary, const Vec3& origin);
};
// clang-format off
using S = const TrajectorySummary&;
using V = const Vec3&;
constexpr Column numberColumns[] = {
  { "EndTime", [](S s, V) { return s.endTime; } },
  { "StartX", [](S s, V o) { return s.start.x() + o.x(); } },
  { "StartY", [](S s, V o) { return s.start.y() + o.y(); } },
  { "StartZ", [](S s, V o) { return s.start.z() + o.z(); } },
  { "StopX", [](S s, V o) { return s.stop.x() + o.x(); } },
  { "StopY", [](S s, V o) { return s.stop.y() + o.y(); } },
  { "StopZ", [](S s, V o) { return s.stop.z() + o.z(); } },
  { "RunOut", [](S s, V) { return s.runOut; } },
  { "PathLength", [](S s, V) { return s.pathLength; } },
  { "MaxSpeed", [](S s, V) { return s.maxSpeed; } },
  { "MaxKineticEnergy", [](S s, V) { return s.maxKineticEnergy; } },
  { "MaxHeightOverGround", [](S s, V) { return s.maxHeightOverGround; } },
  { "Mass", [](S s, V) { return s.mass; } },
  { "Volume", [](S s, V) { return s.volume; } },
  { "EnergyReleased", [](S s, V) { return s.energy.released; } },
  { "EnergyKinetic", [](S s, V) { return s.energy.kinetic; } },
  { "EnergyStrain", [](S s, V) { return s.energy.strain; } },
  { "EnergyFriction", [](S s, V) { return s.energy.friction; } },
  { "EnergyRestitution", [](S s, V) { return s.energy.restitution; } },
  { "EnergyVibration", [](S s, V) { return s.energy.vibration; } },
  { "EnergyDamping", [](S s, V) { return s.energy.damping; } },
  { "EnergyStructures", [](S s, V) { return s.energy.structures; } },
  { "EnergyScars", [](S s, V) { return s.energy.scars; } },
  { "EnergyRolling", [](S s, V) { return s.energy.rolling; } },
  { "EnergyExchanged", [](S s, V) { return s.energy.exchanged; } },
  { "EnergyNumerical", [](S s, V) { return s.energy.numerical; } },
  { "LastingLoss", [](S s, V) { return s.lastingLoss; } },
};
/// Where rocks can break.
constexpr Column breakingColumns[] = {
  { "Pieces", [](S s, V) { return double(s.pieces); } },
  { "EnergyBreaking", [](S s, V) { return s.energy.breaking; } },
  { "FinesMass", [](S s, V) { return s.finesMass; } },
  { "FinesEnergy", [](S s, V) { return s.finesEnergy; } },
};
// clang-format on

} // namespace

struct SummaryRows::Arrays
{
  vtkNew<vtkTable> data;
  vtkFieldData* fields = data->GetRowData();
  IdentityArrays identity{ fields };
  vtkSmartPointer<vtkStringArray> shape = addArray<vtkStringArray>(fields, "Shape");
  vtkSmartPointer<vtkStringArray> fate = addArray<vtkStringArray>(fields, "Fate");
  vtkSmartPointer<vtkIntArray> fateCode = addArray<vtkIntArray>(fields, "FateCode");
  std::vector<vtkSmartPointer<vtkDoubleArray>> numbers = makeNumbers(fields);
  vtkSmartPointer<vtkIdTypeArray> sourceId = addArray<vtkIdTypeArray>(fields, "SourceId");
  vtkSmartPointer<vtkDoubleArray> frequency; ///< None where it is not known.
  vtkSmartPointer<vtkStringArray> sourceName = addArray<vtkStringArray>(fields, "SourceName");
  vtkSmartPointer<vtkIntArray> impacts = addArray<vtkIntArray>(fields, "Impacts");
  vtkSmartPointer<vtkIdTypeArray> contactSteps = addArray<vtkIdTypeArray>(fields, "ContactSteps");
  vtkSmartPointer<vtkIdTypeArray> openClose =
    addArray<vtkIdTypeArray>(fields, "OpenCloseIterations");
  vtkSmartPointer<vtkIdTypeArray> cutSteps = addArray<vtkIdTypeArray>(fields, "CutSteps");
  vtkSmartPointer<vtkIdTypeArray> unsettled = addArray<vtkIdTypeArray>(fields, "UnsettledSteps");

  std::vector<vtkSmartPointer<vtkDoubleArray>> breaking; ///< None where no rock can.

  static std::vector<vtkSmartPointer<vtkDoubleArray>> makeNumbers(vtkFieldData* fields)
  {
    std::vector<vtkSmartPointer<vtkDoubleArray>> made;
    for (const Column& column : numberColumns)
    {
      made.push_back(addArray<vtkDoubleArray>(fields, column.name));
    }
    return made;
  }
};

SummaryRows::SummaryRows(const RunFrame& frame)
  : frame_(frame)
  , arrays_(std::make_unique<Arrays>())
{
  if (!frame.frequencies.empty())
  {
    arrays_->frequency = addArray<vtkDoubleArray>(arrays_->fields, "Frequency");
  }
  arrays_->identity.piece = pieceArray(frame.breaking, arrays_->fields);
  for (const Column& column : breakingColumns)
  {
    if (frame.breaking)
    {
      arrays_->breaking.push_back(addArray<vtkDoubleArray>(arrays_->fields, column.name));
    }
  }
}

SummaryRows::~SummaryRows() = default;

void SummaryRows::append(const TrajectorySummary& summary)
{
  Arrays& a = *arrays_;
  a.identity.append(summary.blockId, summary.rock, summary.iteration, summary.piece);
  a.shape->InsertNextValue(shapeName(frame_.shapes[std::size_t(summary.rock)]));
  a.fate->InsertNextValue(fateName(summary.fate));
  a.fateCode->InsertNextValue(int(summary.fate));
  for (std::size_t k = 0; k < a.numbers.size(); ++k)
  {
    a.numbers[k]->InsertNextValue(numberColumns[k].value(summary, frame_.origin));
  }
  for (std::size_t k = 0; k < a.breaking.size(); ++k)
  {
    a.breaking[k]->InsertNextValue(breakingColumns[k].value(summary, frame_.origin));
  }
  a.sourceId->InsertNextValue(frame_.sourceIds[std::size_t(summary.rock)]);
  if (a.frequency)
  {
    a.frequency->InsertNextValue(frame_.frequencies[std::size_t(summary.rock)]);
  }
  a.sourceName->InsertNextValue(frame_.sourceNames[std::size_t(summary.rock)]);
  a.impacts->InsertNextValue(summary.impacts);
  a.contactSteps->InsertNextValue(summary.contactSteps);
  a.openClose->InsertNextValue(summary.openCloseIterations);
  a.cutSteps->InsertNextValue(summary.cutSteps);
  a.unsettled->InsertNextValue(summary.unsettledSteps);
}

void SummaryRows::copy(vtkTable* output) const
{
  output->DeepCopy(arrays_->data);
}

void SummaryRows::finish(vtkTable* output)
{
  squeeze(arrays_->fields);
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
  vtkNew<vtkStringArray> names;
  names->SetName("SourceName");
  for (vtkIdType row = 0; row < rocks->GetNumberOfTuples(); ++row)
  {
    names->InsertNextValue(frame.sourceNames[std::size_t(rocks->GetComponent(row, 0))]);
  }
  summary->GetRowData()->AddArray(names);
}

} // namespace rockfall::filters
