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

/// A vertex for each event, with the rock that it happens to.
struct EventVertices
{
  vtkNew<vtkPolyData> data;
  vtkFieldData* fields = data->GetPointData();
  vtkSmartPointer<vtkPoints> points = doublePoints();
  vtkNew<vtkCellArray> vertices;
  IdentityArrays identity{ fields };

  void append(const Vec3& world, const TrajectorySummary& summary)
  {
    this->vertices->InsertNextCell(1);
    this->vertices->InsertCellPoint(this->points->GetNumberOfPoints());
    insertPoint(this->points, world);
    this->identity.append(summary.blockId, summary.rock, summary.iteration, summary.piece);
  }
  void copy(vtkPolyData* output) const
  {
    this->data->SetPoints(this->points);
    this->data->SetVerts(this->vertices);
    output->DeepCopy(this->data);
  }
  void finish(vtkPolyData* output)
  {
    squeeze(this->fields);
    rememberRanges(this->fields);
    this->points->Squeeze();
    this->vertices->Squeeze();
    this->data->SetPoints(this->points);
    this->data->SetVerts(this->vertices);
    output->ShallowCopy(this->data);
  }
};

} // namespace

struct ImpactPoints::Arrays : EventVertices
{
  vtkSmartPointer<vtkDoubleArray> time = addArray<vtkDoubleArray>(fields, "Time");
  vtkSmartPointer<vtkDoubleArray> normal = addArray<vtkDoubleArray>(fields, "Normal", 3);
  vtkSmartPointer<vtkIdTypeArray> cfe = addArray<vtkIdTypeArray>(fields, "CFEId");
  vtkSmartPointer<vtkDoubleArray> impulse = addArray<vtkDoubleArray>(fields, "Impulse");
  vtkSmartPointer<vtkDoubleArray> approach = addArray<vtkDoubleArray>(fields, "ApproachSpeed");
  vtkSmartPointer<vtkDoubleArray> before = addArray<vtkDoubleArray>(fields, "VelocityBefore", 3);
  vtkSmartPointer<vtkDoubleArray> after = addArray<vtkDoubleArray>(fields, "VelocityAfter", 3);
  vtkSmartPointer<vtkDoubleArray> loss = addArray<vtkDoubleArray>(fields, "EnergyLoss");
  vtkSmartPointer<vtkDoubleArray> restitution = addArray<vtkDoubleArray>(fields, "Restitution");
  vtkSmartPointer<vtkDoubleArray> scarDepth = addArray<vtkDoubleArray>(fields, "ScarDepth");
  vtkSmartPointer<vtkDoubleArray> scarLength = addArray<vtkDoubleArray>(fields, "ScarLength");
  vtkSmartPointer<vtkIntArray> otherRock = addArray<vtkIntArray>(fields, "OtherRockId");
  vtkSmartPointer<vtkIdTypeArray> otherBlock = addArray<vtkIdTypeArray>(fields, "OtherBlockId");
};

ImpactPoints::ImpactPoints(const RunFrame& frame)
  : frame_(frame)
  , arrays_(std::make_unique<Arrays>())
{
  arrays_->identity.piece = pieceArray(frame.breaking, arrays_->fields);
}

ImpactPoints::~ImpactPoints() = default;

void ImpactPoints::append(const Trajectory& trajectory)
{
  Arrays& a = *arrays_;
  for (const ImpactEvent& impact : trajectory.impacts)
  {
    a.append(impact.position + frame_.origin, trajectory.summary);
    a.time->InsertNextValue(impact.time);
    a.normal->InsertNextTuple(impact.normal.data());
    a.cfe->InsertNextValue(impact.cfe);
    a.impulse->InsertNextValue(impact.impulse);
    a.approach->InsertNextValue(impact.approachSpeed);
    a.before->InsertNextTuple(impact.velocityBefore.data());
    a.after->InsertNextTuple(impact.velocityAfter.data());
    a.loss->InsertNextValue(impact.energyLoss);
    a.restitution->InsertNextValue(impact.restitution);
    a.scarDepth->InsertNextValue(impact.scarDepth);
    a.scarLength->InsertNextValue(impact.scarLength);
    a.otherRock->InsertNextValue(impact.otherRock);
    a.otherBlock->InsertNextValue(impact.otherBlockId);
  }
}

void ImpactPoints::copy(vtkPolyData* output) const
{
  arrays_->copy(output);
}

void ImpactPoints::finish(vtkPolyData* output)
{
  arrays_->finish(output);
}

//------------------------------------------------------------------------------
struct StructurePoints::Arrays : EventVertices
{
  vtkSmartPointer<vtkIdTypeArray> structure = addArray<vtkIdTypeArray>(fields, "StructureId");
  vtkSmartPointer<vtkIntArray> outcome = addArray<vtkIntArray>(fields, "Outcome");
  vtkSmartPointer<vtkDoubleArray> time = addArray<vtkDoubleArray>(fields, "Time");
  vtkSmartPointer<vtkDoubleArray> velocity = addArray<vtkDoubleArray>(fields, "Velocity", 3);
  vtkSmartPointer<vtkDoubleArray> speed = addArray<vtkDoubleArray>(fields, "Speed");
  vtkSmartPointer<vtkDoubleArray> energy = addArray<vtkDoubleArray>(fields, "KineticEnergy");
  vtkSmartPointer<vtkDoubleArray> height = addArray<vtkDoubleArray>(fields, "HeightOverGround");
  vtkSmartPointer<vtkDoubleArray> taken = addArray<vtkDoubleArray>(fields, "EnergyTaken");
  vtkSmartPointer<vtkDoubleArray> held = addArray<vtkDoubleArray>(fields, "HeldBefore");
  vtkSmartPointer<vtkDoubleArray> useful = addArray<vtkDoubleArray>(fields, "UsefulHeight");
  vtkSmartPointer<vtkDoubleArray> braking = addArray<vtkDoubleArray>(fields, "BrakingDistance");
};

StructurePoints::StructurePoints(const RunFrame& frame)
  : frame_(frame)
  , arrays_(std::make_unique<Arrays>())
{
  arrays_->identity.piece = pieceArray(frame.breaking, arrays_->fields);
}

StructurePoints::~StructurePoints() = default;

void StructurePoints::append(const Trajectory& trajectory)
{
  Arrays& a = *arrays_;
  for (const StructureEvent& event : trajectory.structures)
  {
    a.append(event.position + frame_.origin, trajectory.summary);
    a.structure->InsertNextValue(event.feature);
    a.outcome->InsertNextValue(int(event.outcome));
    a.time->InsertNextValue(event.time);
    a.velocity->InsertNextTuple(event.velocity.data());
    a.speed->InsertNextValue(event.velocity.norm());
    a.energy->InsertNextValue(event.kineticEnergy);
    a.height->InsertNextValue(event.heightOverGround);
    a.taken->InsertNextValue(event.energyTaken);
    a.held->InsertNextValue(event.heldBefore);
    a.useful->InsertNextValue(event.usefulHeight);
    a.braking->InsertNextValue(event.brakingDistance);
  }
}

void StructurePoints::copy(vtkPolyData* output) const
{
  arrays_->copy(output);
}

void StructurePoints::finish(vtkPolyData* output)
{
  arrays_->finish(output);
}

} // namespace rockfall::filters
