#include "runOutputs.h"

#include "arrays.h"
#include "motion.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

namespace rockfall::filters
{

namespace
{

/// The arrays of what moves: per face of a rock, or per point of a trajectory.
struct MotionArrays
{
  vtkSmartPointer<vtkDoubleArray> velocity, speed, rotationRate, kineticEnergy, height;

  explicit MotionArrays(vtkFieldData* data)
    : velocity(addArray<vtkDoubleArray>(data, "Velocity", 3))
    , speed(addArray<vtkDoubleArray>(data, "Speed"))
    , rotationRate(addArray<vtkDoubleArray>(data, "RotationRate", 3))
    , kineticEnergy(addArray<vtkDoubleArray>(data, "KineticEnergy"))
    , height(addArray<vtkDoubleArray>(data, "HeightOverGround"))
  {
  }

  void append(const Sample& sample)
  {
    this->velocity->InsertNextTuple(sample.velocity.data());
    this->speed->InsertNextValue(sample.velocity.norm());
    this->rotationRate->InsertNextTuple(sample.angularVelocity.data());
    this->kineticEnergy->InsertNextValue(sample.kineticEnergy);
    this->height->InsertNextValue(sample.heightOverGround);
  }
};

/// Where the energy of a rock is, and what has been taken of it since its release, J.
struct EnergyArrays
{
  vtkSmartPointer<vtkDoubleArray> potential, strain, friction, restitution, vibration, damping,
    numerical;

  explicit EnergyArrays(vtkFieldData* data)
    : potential(addArray<vtkDoubleArray>(data, "PotentialEnergy"))
    , strain(addArray<vtkDoubleArray>(data, "StrainEnergy"))
    , friction(addArray<vtkDoubleArray>(data, "FrictionLoss"))
    , restitution(addArray<vtkDoubleArray>(data, "RestitutionLoss"))
    , vibration(addArray<vtkDoubleArray>(data, "VibrationLoss"))
    , damping(addArray<vtkDoubleArray>(data, "DampingLoss"))
    , numerical(addArray<vtkDoubleArray>(data, "NumericalLoss"))
  {
  }

  /// `weight`: m g, N.
  void append(const Sample& sample, double weight)
  {
    // Heights of the local frame are those of the world.
    this->potential->InsertNextValue(weight * sample.position.z());
    this->strain->InsertNextValue(sample.energy.strain);
    this->friction->InsertNextValue(sample.energy.friction);
    this->restitution->InsertNextValue(sample.energy.restitution);
    this->vibration->InsertNextValue(sample.energy.vibration);
    this->damping->InsertNextValue(sample.energy.damping);
    this->numerical->InsertNextValue(sample.energy.numerical);
  }
};

/// The arrays that say which rock, and in which iteration.
struct IdentityArrays
{
  vtkSmartPointer<vtkIdTypeArray> blockId;
  vtkSmartPointer<vtkIntArray> rockId, iteration;

  explicit IdentityArrays(vtkFieldData* data)
    : blockId(addArray<vtkIdTypeArray>(data, "BlockId"))
    , rockId(addArray<vtkIntArray>(data, "RockId"))
    , iteration(addArray<vtkIntArray>(data, "Iteration"))
  {
  }

  void append(const TrajectorySummary& summary)
  {
    this->blockId->InsertNextValue(summary.blockId);
    this->rockId->InsertNextValue(summary.rock);
    this->iteration->InsertNextValue(summary.iteration);
  }
};

vtkSmartPointer<vtkPoints> doublePoints()
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  return points;
}

void insertPoint(vtkPoints* points, const Vec3& world)
{
  points->InsertNextPoint(world.data());
}

} // namespace

void writeRocksAt(const FinishedRun& run, int iteration, double time, vtkPolyData* output)
{
  const auto points = doublePoints();
  vtkNew<vtkCellArray> polygons;
  IdentityArrays identity(output->GetCellData());
  MotionArrays motion(output->GetCellData());
  const auto state = addArray<vtkIntArray>(output->GetCellData(), "State");
  const auto shape = addArray<vtkIntArray>(output->GetCellData(), "Shape");
  const auto volume = addArray<vtkDoubleArray>(output->GetCellData(), "Volume");
  for (const Trajectory& trajectory : run.trajectories)
  {
    if (trajectory.summary.iteration != iteration)
    {
      continue;
    }
    const ReleasedRock& released = run.rocks[std::size_t(trajectory.summary.rock)];
    const Polyhedron& body = released.rock.shape;
    const Sample sample = sampleAt(trajectory, time);
    const int doing = int(stateAt(trajectory, time));
    appendFaces(
      body, sample.orientation.toRotationMatrix(), sample.position + run.origin, points, polygons);
    for (std::size_t face = 0; face < body.faces().size(); ++face)
    {
      identity.append(trajectory.summary);
      motion.append(sample);
      state->InsertNextValue(doing);
      shape->InsertNextValue(int(released.shape));
      volume->InsertNextValue(trajectory.summary.volume);
    }
  }
  output->SetPoints(points);
  output->SetPolys(polygons);
}

void writeTrajectories(const FinishedRun& run, vtkPolyData* output)
{
  const auto points = doublePoints();
  vtkNew<vtkCellArray> lines;
  const auto time = addArray<vtkDoubleArray>(output->GetPointData(), "Time");
  MotionArrays motion(output->GetPointData());
  EnergyArrays energy(output->GetPointData());
  IdentityArrays identity(output->GetCellData());
  const auto shape = addArray<vtkIntArray>(output->GetCellData(), "Shape");
  const auto volume = addArray<vtkDoubleArray>(output->GetCellData(), "Volume");
  const auto mass = addArray<vtkDoubleArray>(output->GetCellData(), "Mass");
  const auto fate = addArray<vtkIntArray>(output->GetCellData(), "Fate");
  for (const Trajectory& trajectory : run.trajectories)
  {
    lines->InsertNextCell(int(trajectory.samples.size()));
    const double weight = trajectory.summary.mass * run.gravity;
    for (const Sample& sample : trajectory.samples)
    {
      lines->InsertCellPoint(points->GetNumberOfPoints());
      insertPoint(points, sample.position + run.origin);
      time->InsertNextValue(sample.time);
      motion.append(sample);
      energy.append(sample, weight);
    }
    const TrajectorySummary& summary = trajectory.summary;
    identity.append(summary);
    shape->InsertNextValue(int(run.rocks[std::size_t(summary.rock)].shape));
    volume->InsertNextValue(summary.volume);
    mass->InsertNextValue(summary.mass);
    fate->InsertNextValue(int(summary.fate));
  }
  output->GetPointData()->SetActiveScalars("Speed"); // the colour that a viewer begins with
  output->SetPoints(points);
  output->SetLines(lines);
}

void writeImpacts(const FinishedRun& run, vtkPolyData* output)
{
  const auto points = doublePoints();
  vtkNew<vtkCellArray> vertices;
  vtkFieldData* data = output->GetPointData();
  IdentityArrays identity(data);
  const auto time = addArray<vtkDoubleArray>(data, "Time");
  const auto normal = addArray<vtkDoubleArray>(data, "Normal", 3);
  const auto cfe = addArray<vtkIdTypeArray>(data, "CFEId");
  const auto impulse = addArray<vtkDoubleArray>(data, "Impulse");
  const auto approach = addArray<vtkDoubleArray>(data, "ApproachSpeed");
  const auto before = addArray<vtkDoubleArray>(data, "VelocityBefore", 3);
  const auto after = addArray<vtkDoubleArray>(data, "VelocityAfter", 3);
  const auto loss = addArray<vtkDoubleArray>(data, "EnergyLoss");
  const auto restitution = addArray<vtkDoubleArray>(data, "Restitution");
  for (const Trajectory& trajectory : run.trajectories)
  {
    for (const ImpactEvent& impact : trajectory.impacts)
    {
      vertices->InsertNextCell(1);
      vertices->InsertCellPoint(points->GetNumberOfPoints());
      insertPoint(points, impact.position + run.origin);
      identity.append(trajectory.summary);
      time->InsertNextValue(impact.time);
      normal->InsertNextTuple(impact.normal.data());
      cfe->InsertNextValue(impact.cfe);
      impulse->InsertNextValue(impact.impulse);
      approach->InsertNextValue(impact.approachSpeed);
      before->InsertNextTuple(impact.velocityBefore.data());
      after->InsertNextTuple(impact.velocityAfter.data());
      loss->InsertNextValue(impact.energyLoss);
      restitution->InsertNextValue(impact.restitution);
    }
  }
  output->SetPoints(points);
  output->SetVerts(vertices);
}

void writeSummaries(const FinishedRun& run, vtkTable* output)
{
  vtkFieldData* data = output->GetRowData();
  IdentityArrays identity(data);
  const auto shape = addArray<vtkStringArray>(data, "Shape");
  const auto fate = addArray<vtkStringArray>(data, "Fate");
  const auto fateCode = addArray<vtkIntArray>(data, "FateCode");
  struct Column
  {
    const char* name;
    double (*value)(const TrajectorySummary& summary, const Vec3& origin);
  };
  // clang-format off
  using S = const TrajectorySummary&;
  using V = const Vec3&;
  static constexpr Column numbers[] = {
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
    { "EnergyNumerical", [](S s, V) { return s.energy.numerical; } },
  };
  // clang-format on
  for (const Column& column : numbers)
  {
    const auto values = addArray<vtkDoubleArray>(data, column.name);
    for (const Trajectory& trajectory : run.trajectories)
    {
      values->InsertNextValue(column.value(trajectory.summary, run.origin));
    }
  }
  const auto impacts = addArray<vtkIntArray>(data, "Impacts");
  const auto contactSteps = addArray<vtkIdTypeArray>(data, "ContactSteps");
  const auto openClose = addArray<vtkIdTypeArray>(data, "OpenCloseIterations");
  const auto cutSteps = addArray<vtkIdTypeArray>(data, "CutSteps");
  const auto unsettled = addArray<vtkIdTypeArray>(data, "UnsettledSteps");
  for (const Trajectory& trajectory : run.trajectories)
  {
    const TrajectorySummary& summary = trajectory.summary;
    identity.append(summary);
    shape->InsertNextValue(shapeName(run.rocks[std::size_t(summary.rock)].shape));
    fate->InsertNextValue(fateName(summary.fate));
    fateCode->InsertNextValue(int(summary.fate));
    impacts->InsertNextValue(summary.impacts);
    contactSteps->InsertNextValue(summary.contactSteps);
    openClose->InsertNextValue(summary.openCloseIterations);
    cutSteps->InsertNextValue(summary.cutSteps);
    unsettled->InsertNextValue(summary.unsettledSteps);
  }
}

} // namespace rockfall::filters
