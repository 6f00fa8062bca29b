#include "runOutputs.h"

#include "arrays.h"

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
    structures, scars, rolling, exchanged, numerical;

  explicit EnergyArrays(vtkFieldData* data)
    : potential(addArray<vtkDoubleArray>(data, "PotentialEnergy"))
    , strain(addArray<vtkDoubleArray>(data, "StrainEnergy"))
    , friction(addArray<vtkDoubleArray>(data, "FrictionLoss"))
    , restitution(addArray<vtkDoubleArray>(data, "RestitutionLoss"))
    , vibration(addArray<vtkDoubleArray>(data, "VibrationLoss"))
    , damping(addArray<vtkDoubleArray>(data, "DampingLoss"))
    , structures(addArray<vtkDoubleArray>(data, "StructureLoss"))
    , scars(addArray<vtkDoubleArray>(data, "ScarLoss"))
    , rolling(addArray<vtkDoubleArray>(data, "RollingLoss"))
    , exchanged(addArray<vtkDoubleArray>(data, "GivenToRocks"))
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
    this->structures->InsertNextValue(sample.energy.structures);
    this->scars->InsertNextValue(sample.energy.scars);
    this->rolling->InsertNextValue(sample.energy.rolling);
    this->exchanged->InsertNextValue(sample.energy.exchanged);
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

  void append(std::int64_t block, int rock, int number)
  {
    this->blockId->InsertNextValue(block);
    this->rockId->InsertNextValue(rock);
    this->iteration->InsertNextValue(number);
  }
};

/// State of a rock beside its motion, to be released again as it is.
struct ReleaseArrays
{
  vtkSmartPointer<vtkDoubleArray> density, young, poisson, rotation;
  vtkSmartPointer<vtkStringArray> material, sourceName;
  vtkSmartPointer<vtkIdTypeArray> sourceId;

  explicit ReleaseArrays(vtkFieldData* data)
    : density(addArray<vtkDoubleArray>(data, "Density"))
    , young(addArray<vtkDoubleArray>(data, "YoungModulus"))
    , poisson(addArray<vtkDoubleArray>(data, "PoissonRatio"))
    , rotation(addArray<vtkDoubleArray>(data, "AngularVelocity", 3))
    , material(addArray<vtkStringArray>(data, "Material"))
    , sourceName(addArray<vtkStringArray>(data, "SourceName"))
    , sourceId(addArray<vtkIdTypeArray>(data, "SourceId"))
  {
  }

  void append(const RunFrame& frame, const ShownRock& shown)
  {
    const auto number = std::size_t(shown.rock);
    const Rock& rock = frame.rocks[number];
    this->density->InsertNextValue(rock.density);
    this->young->InsertNextValue(rock.youngModulus);
    this->poisson->InsertNextValue(rock.poissonRatio);
    this->rotation->InsertNextTuple(shown.sample.angularVelocity.data());
    this->material->InsertNextValue(rock.material);
    this->sourceName->InsertNextValue(frame.sourceNames[number]);
    this->sourceId->InsertNextValue(frame.sourceIds[number]);
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

/// Gives back what the arrays have grown beyond their content.
void squeeze(vtkFieldData* data)
{
  for (int k = 0; k < data->GetNumberOfArrays(); ++k)
  {
    data->GetAbstractArray(k)->Squeeze();
  }
}

} // namespace

void writeRocks(const RunFrame& frame, std::span<const ShownRock> rocks, vtkPolyData* output)
{
  const auto points = doublePoints();
  vtkNew<vtkCellArray> polygons;
  IdentityArrays identity(output->GetCellData());
  MotionArrays motion(output->GetCellData());
  const auto state = addArray<vtkIntArray>(output->GetCellData(), "State");
  const auto shape = addArray<vtkIntArray>(output->GetCellData(), "Shape");
  const auto volume = addArray<vtkDoubleArray>(output->GetCellData(), "Volume");
  ReleaseArrays release(output->GetCellData());
  for (const ShownRock& shown : rocks)
  {
    const Rock& rock = frame.rocks[std::size_t(shown.rock)];
    // The volume may be one of this iteration.
    const bool drawn = rock.uncertainty.volume.law != VolumeLaw::Fixed;
    const Polyhedron scaled = drawn ? rock.shape.withVolume(shown.volume) : Polyhedron();
    const Polyhedron& body = drawn ? scaled : rock.shape;
    appendFaces(body, shown.sample.orientation.toRotationMatrix(),
      shown.sample.position + frame.origin, points, polygons);
    for (std::size_t face = 0; face < body.faces().size(); ++face)
    {
      identity.append(rock.blockId, shown.rock, shown.iteration);
      motion.append(shown.sample);
      state->InsertNextValue(shown.state);
      shape->InsertNextValue(int(frame.shapes[std::size_t(shown.rock)]));
      volume->InsertNextValue(body.integrals().volume);
      release.append(frame, shown);
    }
  }
  output->SetPoints(points);
  output->SetPolys(polygons);
}

//------------------------------------------------------------------------------
struct TrajectoryLines::Arrays
{
  vtkNew<vtkPolyData> data;
  vtkSmartPointer<vtkPoints> points = doublePoints();
  vtkNew<vtkCellArray> lines, vertices;
  vtkSmartPointer<vtkDoubleArray> time = addArray<vtkDoubleArray>(data->GetPointData(), "Time");
  MotionArrays motion{ data->GetPointData() };
  std::unique_ptr<EnergyArrays> energy;
  IdentityArrays identity{ data->GetCellData() };
  vtkSmartPointer<vtkIntArray> shape = addArray<vtkIntArray>(data->GetCellData(), "Shape");
  vtkSmartPointer<vtkDoubleArray> volume = addArray<vtkDoubleArray>(data->GetCellData(), "Volume");
  vtkSmartPointer<vtkDoubleArray> mass = addArray<vtkDoubleArray>(data->GetCellData(), "Mass");
  vtkSmartPointer<vtkIntArray> fate = addArray<vtkIntArray>(data->GetCellData(), "Fate");
  vtkSmartPointer<vtkIdTypeArray> source =
    addArray<vtkIdTypeArray>(data->GetCellData(), "SourceId");

  void compose()
  {
    data->GetPointData()->SetActiveScalars("Speed"); // the colour that a viewer begins with
    data->SetPoints(points);
    data->SetLines(lines);
    data->SetVerts(vertices);
  }
};

TrajectoryLines::TrajectoryLines(const RunFrame& frame, bool withLosses)
  : frame_(frame)
  , arrays_(std::make_unique<Arrays>())
{
  if (withLosses)
  {
    arrays_->energy = std::make_unique<EnergyArrays>(arrays_->data->GetPointData());
  }
}

TrajectoryLines::~TrajectoryLines() = default;

void TrajectoryLines::append(const Trajectory& trajectory)
{
  if (trajectory.samples.empty())
  {
    return;
  }
  Arrays& a = *arrays_;
  const TrajectorySummary& summary = trajectory.summary;
  // Vertices and lines are never mixed, as whole paths have two samples at least: cell data stand
  // in the order in which trajectories come, but polydata's cells begin with the vertices.
  vtkCellArray* cells = trajectory.samples.size() == 1 ? a.vertices : a.lines;
  cells->InsertNextCell(int(trajectory.samples.size()));
  const double weight = summary.mass * frame_.gravity;
  for (const Sample& sample : trajectory.samples)
  {
    cells->InsertCellPoint(a.points->GetNumberOfPoints());
    insertPoint(a.points, sample.position + frame_.origin);
    a.time->InsertNextValue(sample.time);
    a.motion.append(sample);
    if (a.energy)
    {
      a.energy->append(sample, weight);
    }
  }
  a.identity.append(summary.blockId, summary.rock, summary.iteration);
  a.shape->InsertNextValue(int(frame_.shapes[std::size_t(summary.rock)]));
  a.volume->InsertNextValue(summary.volume);
  a.mass->InsertNextValue(summary.mass);
  a.fate->InsertNextValue(int(summary.fate));
  a.source->InsertNextValue(frame_.sourceIds[std::size_t(summary.rock)]);
}

void TrajectoryLines::copy(vtkPolyData* output) const
{
  arrays_->compose();
  output->DeepCopy(arrays_->data);
}

void TrajectoryLines::finish(vtkPolyData* output)
{
  Arrays& a = *arrays_;
  squeeze(a.data->GetPointData());
  squeeze(a.data->GetCellData());
  a.points->Squeeze();
  a.lines->Squeeze();
  a.compose();
  output->ShallowCopy(a.data);
}

//------------------------------------------------------------------------------
struct ImpactPoints::Arrays
{
  vtkNew<vtkPolyData> data;
  vtkFieldData* fields = data->GetPointData();
  vtkSmartPointer<vtkPoints> points = doublePoints();
  vtkNew<vtkCellArray> vertices;
  IdentityArrays identity{ fields };
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
}

ImpactPoints::~ImpactPoints() = default;

void ImpactPoints::append(const Trajectory& trajectory)
{
  Arrays& a = *arrays_;
  const TrajectorySummary& summary = trajectory.summary;
  for (const ImpactEvent& impact : trajectory.impacts)
  {
    a.vertices->InsertNextCell(1);
    a.vertices->InsertCellPoint(a.points->GetNumberOfPoints());
    insertPoint(a.points, impact.position + frame_.origin);
    a.identity.append(summary.blockId, summary.rock, summary.iteration);
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
  arrays_->data->SetPoints(arrays_->points);
  arrays_->data->SetVerts(arrays_->vertices);
  output->DeepCopy(arrays_->data);
}

void ImpactPoints::finish(vtkPolyData* output)
{
  Arrays& a = *arrays_;
  squeeze(a.fields);
  a.points->Squeeze();
  a.vertices->Squeeze();
  a.data->SetPoints(a.points);
  a.data->SetVerts(a.vertices);
  output->ShallowCopy(a.data);
}

//------------------------------------------------------------------------------
struct StructurePoints::Arrays
{
  vtkNew<vtkPolyData> data;
  vtkFieldData* fields = data->GetPointData();
  vtkSmartPointer<vtkPoints> points = doublePoints();
  vtkNew<vtkCellArray> vertices;
  IdentityArrays identity{ fields };
  vtkSmartPointer<vtkIdTypeArray> structure = addArray<vtkIdTypeArray>(fields, "StructureId");
  vtkSmartPointer<vtkIntArray> outcome = addArray<vtkIntArray>(fields, "Outcome");
  vtkSmartPointer<vtkDoubleArray> time = addArray<vtkDoubleArray>(fields, "Time");
  vtkSmartPointer<vtkDoubleArray> velocity = addArray<vtkDoubleArray>(fields, "Velocity", 3);
  vtkSmartPointer<vtkDoubleArray> speed = addArray<vtkDoubleArray>(fields, "Speed");
  vtkSmartPointer<vtkDoubleArray> energy = addArray<vtkDoubleArray>(fields, "KineticEnergy");
  vtkSmartPointer<vtkDoubleArray> height = addArray<vtkDoubleArray>(fields, "HeightOverGround");
  vtkSmartPointer<vtkDoubleArray> taken = addArray<vtkDoubleArray>(fields, "EnergyTaken");
};

StructurePoints::StructurePoints(const RunFrame& frame)
  : frame_(frame)
  , arrays_(std::make_unique<Arrays>())
{
}

StructurePoints::~StructurePoints() = default;

void StructurePoints::append(const Trajectory& trajectory)
{
  Arrays& a = *arrays_;
  const TrajectorySummary& summary = trajectory.summary;
  for (const StructureEvent& event : trajectory.structures)
  {
    a.vertices->InsertNextCell(1);
    a.vertices->InsertCellPoint(a.points->GetNumberOfPoints());
    insertPoint(a.points, event.position + frame_.origin);
    a.identity.append(summary.blockId, summary.rock, summary.iteration);
    a.structure->InsertNextValue(event.feature);
    a.outcome->InsertNextValue(int(event.outcome));
    a.time->InsertNextValue(event.time);
    a.velocity->InsertNextTuple(event.velocity.data());
    a.speed->InsertNextValue(event.velocity.norm());
    a.energy->InsertNextValue(event.kineticEnergy);
    a.height->InsertNextValue(event.heightOverGround);
    a.taken->InsertNextValue(event.energyTaken);
  }
}

void StructurePoints::copy(vtkPolyData* output) const
{
  arrays_->data->SetPoints(arrays_->points);
  arrays_->data->SetVerts(arrays_->vertices);
  output->DeepCopy(arrays_->data);
}

void StructurePoints::finish(vtkPolyData* output)
{
  Arrays& a = *arrays_;
  squeeze(a.fields);
  a.points->Squeeze();
  a.vertices->Squeeze();
  a.data->SetPoints(a.points);
  a.data->SetVerts(a.vertices);
  output->ShallowCopy(a.data);
}

//------------------------------------------------------------------------------
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
  vtkSmartPointer<vtkStringArray> sourceName = addArray<vtkStringArray>(fields, "SourceName");
  vtkSmartPointer<vtkIntArray> impacts = addArray<vtkIntArray>(fields, "Impacts");
  vtkSmartPointer<vtkIdTypeArray> contactSteps = addArray<vtkIdTypeArray>(fields, "ContactSteps");
  vtkSmartPointer<vtkIdTypeArray> openClose =
    addArray<vtkIdTypeArray>(fields, "OpenCloseIterations");
  vtkSmartPointer<vtkIdTypeArray> cutSteps = addArray<vtkIdTypeArray>(fields, "CutSteps");
  vtkSmartPointer<vtkIdTypeArray> unsettled = addArray<vtkIdTypeArray>(fields, "UnsettledSteps");

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
}

SummaryRows::~SummaryRows() = default;

void SummaryRows::append(const TrajectorySummary& summary)
{
  Arrays& a = *arrays_;
  a.identity.append(summary.blockId, summary.rock, summary.iteration);
  a.shape->InsertNextValue(shapeName(frame_.shapes[std::size_t(summary.rock)]));
  a.fate->InsertNextValue(fateName(summary.fate));
  a.fateCode->InsertNextValue(int(summary.fate));
  for (std::size_t k = 0; k < a.numbers.size(); ++k)
  {
    a.numbers[k]->InsertNextValue(numberColumns[k].value(summary, frame_.origin));
  }
  a.sourceId->InsertNextValue(frame_.sourceIds[std::size_t(summary.rock)]);
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
