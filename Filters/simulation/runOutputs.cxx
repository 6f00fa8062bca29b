// Rocks at a time, and trajectories.

#include "simulation/runOutputs.h"

#include "run/brokenFall.h"
#include "simulation/runArrays.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <cmath>
#include <map>
#include <utility>

namespace rockfall::filters
{

namespace
{

/// Adds arrays of motion: per face of a rock, or per point of a trajectory. `of`: its sample.
template <typename Row, typename Of>
void addMotion(Columns<Row>& columns, Of of)
{
  columns.add("Velocity", [of](const Row& row) { return of(row).velocity; });
  columns.add("Speed", [of](const Row& row) { return of(row).velocity.norm(); });
  columns.add("RotationRate", [of](const Row& row) { return of(row).angularVelocity; });
  columns.add("KineticEnergy", [of](const Row& row) { return of(row).kineticEnergy; });
  columns.add("HeightOverGround", [of](const Row& row) { return of(row).heightOverGround; });
}

/// Where the energy of a rock is beside its height, and what has been taken of it since its
/// release, J.
constexpr std::pair<const char*, double EnergyAudit::*> kEnergies[] = {
  { "StrainEnergy", &EnergyAudit::strain }, { "FrictionLoss", &EnergyAudit::friction },
  { "RestitutionLoss", &EnergyAudit::restitution }, { "VibrationLoss", &EnergyAudit::vibration },
  { "DampingLoss", &EnergyAudit::damping }, { "StructureLoss", &EnergyAudit::structures },
  { "ScarLoss", &EnergyAudit::scars }, { "RollingLoss", &EnergyAudit::rolling },
  { "GivenToRocks", &EnergyAudit::exchanged }, { "NumericalLoss", &EnergyAudit::numerical }
};

} // namespace

void writeRocks(const RunFrame& frame, std::span<const ShownRock> rocks, vtkPolyData* output)
{
  const auto points = doublePoints();
  vtkNew<vtkCellArray> polygons;
  using S = const ShownRock&;
  const auto rockOf = [&frame](S shown) -> const Rock&
  { return frame.rocks[std::size_t(shown.rock)]; };
  const auto itself = [](S shown) -> S { return shown; };
  Columns<ShownRock> columns(output->GetCellData());
  columns.add("BlockId", [rockOf](S shown) { return rockOf(shown).blockId; });
  columns.add("RockId", [](S shown) { return shown.rock; });
  columns.add("Iteration", [](S shown) { return shown.iteration; });
  addPiece(frame, columns, itself);
  addMotion(columns, [](S shown) -> const Sample& { return shown.sample; });
  columns.add("State", [](S shown) { return shown.state; });
  columns.add("Shape", [&](S shown) { return int(frame.shapes[std::size_t(shown.rock)]); });
  double volume = 0.0;
  columns.add("Volume", [&volume](S) { return volume; });
  // State beside the motion, to be released again as it is.
  columns.add("Density", [rockOf](S shown) { return rockOf(shown).density; });
  columns.add("YoungModulus", [rockOf](S shown) { return rockOf(shown).youngModulus; });
  columns.add("PoissonRatio", [rockOf](S shown) { return rockOf(shown).poissonRatio; });
  columns.add("AngularVelocity", [](S shown) { return shown.sample.angularVelocity; });
  columns.add("SourceId", [&](S shown) { return frame.sourceIds[std::size_t(shown.rock)]; });
  addFrequency(frame, columns);
  BlockNames names(output->GetFieldData());
  for (const ShownRock& shown : rocks)
  {
    const Rock& rock = rockOf(shown);
    names.append(rock, frame.sourceNames[std::size_t(shown.rock)]);
    // The volume may be one of this iteration.
    const bool drawn = rock.uncertainty.volume.law != VolumeLaw::Fixed;
    const Polyhedron body = shown.piece > 0 ? shown.shape
      : drawn                               ? rock.shape.withVolume(shown.volume)
                                            : rock.shape;
    appendFaces(body, shown.sample.orientation.toRotationMatrix(),
      shown.sample.position + frame.origin, points, polygons);
    volume = body.integrals().volume;
    for (std::size_t face = 0; face < body.faces().size(); ++face)
    {
      columns.append(shown);
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

struct PointRow
{
  const Sample& sample;
  double weight; ///< m g, N.
};

} // namespace

struct TrajectoryLines::Arrays
{
  vtkNew<vtkPolyData> data;
  vtkSmartPointer<vtkPoints> points = doublePoints();
  vtkNew<vtkCellArray> lines, vertices;
  Columns<PointRow> samples{ data->GetPointData() };
  Columns<TrajectorySummary> paths{ data->GetCellData() };

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
  Arrays& a = *arrays_;
  using P = const PointRow&;
  a.samples.add("Time", [](P point) { return point.sample.time; });
  addMotion(a.samples, [](P point) -> const Sample& { return point.sample; });
  if (withLosses)
  {
    // Heights of the local frame are those of the world.
    a.samples.add(
      "PotentialEnergy", [](P point) { return point.weight * point.sample.position.z(); });
    for (const auto& [name, of] : kEnergies)
    {
      a.samples.add(name, [of = of](P point) { return point.sample.energy.*of; });
    }
    if (frame.breaking)
    {
      a.samples.add("BreakingLoss", [](P point) { return point.sample.energy.breaking; });
    }
  }
  using S = const TrajectorySummary&;
  const auto itself = [](S s) -> S { return s; };
  addIdentity(a.paths, itself);
  a.paths.add("Shape", [&frame](S s) { return int(frame.shapes[std::size_t(s.rock)]); });
  a.paths.add("Volume", [](S s) { return s.volume; });
  a.paths.add("Mass", [](S s) { return s.mass; });
  a.paths.add(
    "Width", [&a, &frame](S s) { return a.widthOf(frame.rocks[std::size_t(s.rock)], s); });
  a.paths.add("Fate", [](S s) { return int(s.fate); });
  a.paths.add("SourceId", [&frame](S s) { return frame.sourceIds[std::size_t(s.rock)]; });
  addFrequency(frame, a.paths);
  addPiece(frame, a.paths, itself);
  if (frame.breaking && frame.slope)
  {
    a.pieces = std::make_unique<PieceShapes>(*frame.slope, *frame.parameters);
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
    a.samples.append({ sample, weight });
  }
  a.paths.append(summary);
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
