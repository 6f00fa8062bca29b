// Impacts, and meetings with structures.

#include "simulation/runOutputs.h"

#include "simulation/runArrays.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

namespace rockfall::filters
{

namespace
{

/// An event, with the rock that it happens to.
template <typename Event>
struct EventRow
{
  const TrajectorySummary& summary;
  const Event& event;
};

void addColumns(const RunFrame& frame, Columns<EventRow<ImpactEvent>>& columns)
{
  using R = const EventRow<ImpactEvent>&;
  columns.add("Time", [](R row) { return row.event.time; });
  columns.add("Normal", [](R row) { return row.event.normal; });
  columns.add("CFEId", [](R row) { return row.event.cfe; });
  columns.add("Impulse", [](R row) { return row.event.impulse; });
  columns.add("ApproachSpeed", [](R row) { return row.event.approachSpeed; });
  columns.add("VelocityBefore", [](R row) { return row.event.velocityBefore; });
  columns.add("VelocityAfter", [](R row) { return row.event.velocityAfter; });
  columns.add("EnergyLoss", [](R row) { return row.event.energyLoss; });
  columns.add("Restitution", [](R row) { return row.event.restitution; });
  columns.add("ScarDepth", [](R row) { return row.event.scarDepth; });
  columns.add("ScarLength", [](R row) { return row.event.scarLength; });
  columns.add("OtherRockId", [](R row) { return row.event.otherRock; });
  columns.add("OtherBlockId",
    [&frame](R row)
    {
      const int other = row.event.otherRock;
      return other < 0 ? std::int64_t(-1) : frame.rocks[std::size_t(other)].blockId;
    });
}

void addColumns(const RunFrame&, Columns<EventRow<StructureEvent>>& columns)
{
  using R = const EventRow<StructureEvent>&;
  columns.add("StructureId", [](R row) { return row.event.feature; });
  columns.add("Outcome", [](R row) { return int(row.event.outcome); });
  columns.add("Time", [](R row) { return row.event.time; });
  columns.add("Velocity", [](R row) { return row.event.velocity; });
  columns.add("Speed", [](R row) { return row.event.velocity.norm(); });
  columns.add("KineticEnergy", [](R row) { return row.event.kineticEnergy; });
  columns.add("HeightOverGround", [](R row) { return row.event.heightOverGround; });
  columns.add("TopHeight", [](R row) { return row.event.topHeight; });
  columns.add("EnergyTaken", [](R row) { return row.event.energyTaken; });
  columns.add("HeldBefore", [](R row) { return row.event.heldBefore; });
  columns.add("UsefulHeight", [](R row) { return row.event.usefulHeight; });
  columns.add("BrakingDistance", [](R row) { return row.event.brakingDistance; });
}

} // namespace

template <typename Event>
struct EventPoints<Event>::Arrays
{
  vtkNew<vtkPolyData> data;
  vtkSmartPointer<vtkPoints> points = doublePoints();
  vtkNew<vtkCellArray> vertices;
  Columns<EventRow<Event>> columns{ data->GetPointData() };
};

template <typename Event>
EventPoints<Event>::EventPoints(const RunFrame& frame)
  : frame_(frame)
  , arrays_(std::make_unique<Arrays>())
{
  const auto summaryOf = [](const EventRow<Event>& row) -> const TrajectorySummary&
  { return row.summary; };
  addIdentity(arrays_->columns, summaryOf);
  addColumns(frame, arrays_->columns);
  addPiece(frame, arrays_->columns, summaryOf);
  arrays_->data->SetPoints(arrays_->points);
}

template <typename Event>
EventPoints<Event>::~EventPoints() = default;

template <typename Event>
void EventPoints<Event>::append(const TrajectorySummary& summary, const std::vector<Event>& events)
{
  Arrays& a = *arrays_;
  for (const Event& event : events)
  {
    a.vertices->InsertNextCell(1);
    a.vertices->InsertCellPoint(a.points->GetNumberOfPoints());
    insertPoint(a.points, event.position + frame_.origin);
    a.columns.append({ summary, event });
  }
}

template <typename Event>
void EventPoints<Event>::copy(vtkPolyData* output) const
{
  arrays_->data->SetVerts(arrays_->vertices);
  output->DeepCopy(arrays_->data);
}

template <typename Event>
void EventPoints<Event>::finish(vtkPolyData* output)
{
  Arrays& a = *arrays_;
  squeeze(a.data->GetPointData());
  rememberRanges(a.data->GetPointData());
  a.points->Squeeze();
  a.vertices->Squeeze();
  a.data->SetVerts(a.vertices);
  output->ShallowCopy(a.data);
}

template class EventPoints<ImpactEvent>;
template class EventPoints<StructureEvent>;

} // namespace rockfall::filters
