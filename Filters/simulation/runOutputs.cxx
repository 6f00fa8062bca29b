// Rocks at a time, and trajectories.

#include "simulation/runOutputs.h"

#include "run/brokenFall.h"
#include "simulation/runArrays.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <cmath>
#include <map>

namespace rockfall::filters
{

namespace
{

/// Arrays of motion: per face of a rock, or per point of a trajectory.
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
  vtkSmartPointer<vtkDoubleArray> breaking; ///< None where no rock can break.

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
    if (this->breaking)
    {
      this->breaking->InsertNextValue(sample.energy.breaking);
    }
    this->exchanged->InsertNextValue(sample.energy.exchanged);
    this->numerical->InsertNextValue(sample.energy.numerical);
  }
};

/// None where frequencies are not known.
vtkSmartPointer<vtkDoubleArray> frequencyArray(const RunFrame& frame, vtkFieldData* data)
{
  return frame.frequencies.empty() ? nullptr : addArray<vtkDoubleArray>(data, "Frequency");
}

/// State of a rock beside its motion, to be released again as it is.
struct ReleaseArrays
{
  vtkSmartPointer<vtkDoubleArray> density, young, poisson, rotation;
  vtkSmartPointer<vtkIdTypeArray> sourceId;
  vtkSmartPointer<vtkDoubleArray> frequency; ///< None where it is not known.

  ReleaseArrays(const RunFrame& frame, vtkFieldData* data)
    : density(addArray<vtkDoubleArray>(data, "Density"))
    , young(addArray<vtkDoubleArray>(data, "YoungModulus"))
    , poisson(addArray<vtkDoubleArray>(data, "PoissonRatio"))
    , rotation(addArray<vtkDoubleArray>(data, "AngularVelocity", 3))
    , sourceId(addArray<vtkIdTypeArray>(data, "SourceId"))
    , frequency(frequencyArray(frame, data))
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
    this->sourceId->InsertNextValue(frame.sourceIds[number]);
    if (this->frequency)
    {
      this->frequency->InsertNextValue(frame.frequencies[number]);
    }
  }
};

} // namespace

void writeRocks(const RunFrame& frame, std::span<const ShownRock> rocks, vtkPolyData* output)
{
  const auto points = doublePoints();
  vtkNew<vtkCellArray> polygons;
  IdentityArrays identity(output->GetCellData());
  identity.piece = pieceArray(frame.breaking, output->GetCellData());
  MotionArrays motion(output->GetCellData());
  const auto state = addArray<vtkIntArray>(output->GetCellData(), "State");
  const auto shape = addArray<vtkIntArray>(output->GetCellData(), "Shape");
  const auto volume = addArray<vtkDoubleArray>(output->GetCellData(), "Volume");
  ReleaseArrays release(frame, output->GetCellData());
  BlockNames names(output->GetFieldData());
  for (const ShownRock& shown : rocks)
  {
    const Rock& rock = frame.rocks[std::size_t(shown.rock)];
    names.append(rock, frame.sourceNames[std::size_t(shown.rock)]);
    // The volume may be one of this iteration.
    const bool drawn = rock.uncertainty.volume.law != VolumeLaw::Fixed;
    const Polyhedron body = shown.piece > 0 ? shown.shape
      : drawn                               ? rock.shape.withVolume(shown.volume)
                                            : rock.shape;
    appendFaces(body, shown.sample.orientation.toRotationMatrix(),
      shown.sample.position + frame.origin, points, polygons);
    for (std::size_t face = 0; face < body.faces().size(); ++face)
    {
      identity.append(rock.blockId, shown.rock, shown.iteration, shown.piece);
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
namespace
{

double longestSide(const Polyhedron& shape)
{
  Eigen::AlignedBox3d box;
  for (const Vec3& vertex : shape.vertices())
  {
    box.extend(vertex);
  }
  return box.sizes().maxCoeff();
}

} // namespace

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
  vtkSmartPointer<vtkDoubleArray> width = addArray<vtkDoubleArray>(data->GetCellData(), "Width");
  vtkSmartPointer<vtkIntArray> fate = addArray<vtkIntArray>(data->GetCellData(), "Fate");
  vtkSmartPointer<vtkIdTypeArray> source =
    addArray<vtkIdTypeArray>(data->GetCellData(), "SourceId");
  vtkSmartPointer<vtkDoubleArray> frequency; ///< None where it is not known.

  /// The longest side of the box around a rock or a piece, in the directions that the shape of the
  /// rock was given in. Asked for every path in turn.
  double widthOf(const Rock& rock, const TrajectorySummary& summary)
  {
    if (pieces && (summary.piece > 0 || summary.pieces > 0))
    {
      const Polyhedron piece = pieces->next(summary, rock);
      if (summary.piece > 0)
      {
        return longestSide(piece);
      }
    }
    const auto [at, isNew] = widths.try_emplace(summary.rock, 0.0);
    if (isNew)
    {
      at->second = longestSide(rock.shape) / std::cbrt(rock.shape.integrals().volume);
    }
    // The volume may be one of this iteration.
    return at->second * std::cbrt(summary.volume);
  }
  std::map<int, double> widths;        ///< By rock, of a volume of 1 m³.
  std::unique_ptr<PieceShapes> pieces; ///< None where no rock can break.

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
  arrays_->frequency = frequencyArray(frame, arrays_->data->GetCellData());
  if (withLosses)
  {
    arrays_->energy = std::make_unique<EnergyArrays>(arrays_->data->GetPointData());
  }
  arrays_->identity.piece = pieceArray(frame.breaking, arrays_->data->GetCellData());
  if (frame.breaking && frame.slope)
  {
    arrays_->pieces = std::make_unique<PieceShapes>(*frame.slope, *frame.parameters);
  }
  if (frame.breaking && withLosses)
  {
    arrays_->energy->breaking =
      addArray<vtkDoubleArray>(arrays_->data->GetPointData(), "BreakingLoss");
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
  a.identity.append(summary.blockId, summary.rock, summary.iteration, summary.piece);
  a.shape->InsertNextValue(int(frame_.shapes[std::size_t(summary.rock)]));
  a.volume->InsertNextValue(summary.volume);
  a.mass->InsertNextValue(summary.mass);
  a.width->InsertNextValue(a.widthOf(frame_.rocks[std::size_t(summary.rock)], summary));
  a.fate->InsertNextValue(int(summary.fate));
  a.source->InsertNextValue(frame_.sourceIds[std::size_t(summary.rock)]);
  if (a.frequency)
  {
    a.frequency->InsertNextValue(frame_.frequencies[std::size_t(summary.rock)]);
  }
}

void TrajectoryLines::copy(vtkPolyData* output) const
{
  arrays_->compose();
  output->DeepCopy(arrays_->data);
  rememberRanges(output);
}

void TrajectoryLines::finish(vtkPolyData* output)
{
  Arrays& a = *arrays_;
  squeeze(a.data->GetPointData());
  squeeze(a.data->GetCellData());
  a.points->Squeeze();
  a.lines->Squeeze();
  a.compose();
  rememberRanges(a.data);
  output->ShallowCopy(a.data);
}

} // namespace rockfall::filters
