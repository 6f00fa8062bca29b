#include "shared/rockPaths.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/text/numberText.h"
#include "rock/results.h"
#include "shared/arrays.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <limits>
#include <string>
#include <vector>

namespace rockfall::filters
{

namespace
{

vtkDataArray* needed(vtkFieldData* data, const char* kind, const char* name, int components = 1)
{
  vtkDataArray* array = data->GetArray(name);
  if (!array || array->GetNumberOfComponents() != components)
  {
    throw DataError("The Input has no " + std::string(kind) + " array " + name + " of " +
      std::to_string(components) + (components == 1 ? " component" : " components") +
      "; the trajectories of Rockfall Simulation are wanted");
  }
  return array;
}

constexpr char retentionName[] = "TrajectoryOutput";
constexpr char runningName[] = "RunGoesOn";
constexpr char shownUntilName[] = "ShownUntil";

} // namespace

void writeRetention(Retention retention, vtkFieldData* data)
{
  constexpr const char* names[] = { "Nothing", "Stopping Points", "Events", "Thinned", "Full" };
  addArray<vtkStringArray>(data, retentionName)->InsertNextValue(names[int(retention)]);
}

void markShownUntil(double time, vtkFieldData* data)
{
  addArray<vtkDoubleArray>(data, shownUntilName)->InsertNextValue(time);
}

void requireWhole(vtkFieldData* data, const std::string& name)
{
  vtkDataArray* until = data->GetArray(shownUntilName);
  if (until && until->GetNumberOfTuples() > 0)
  {
    throw DataError(name + " has paths up to " + numberText(until->GetComponent(0, 0)) +
      " s (Growing Paths): the rest of a fall would not count. Connect what Growing Paths shows");
  }
}

void markRunning(vtkFieldData* data)
{
  addArray<vtkStringArray>(data, runningName)->InsertNextValue("There are more to come");
}

bool isRunning(vtkFieldData* data)
{
  return data->GetAbstractArray(runningName) != nullptr;
}

void forPaths(vtkPolyData* trajectories, const Vec3& origin, vtkIdType first, vtkIdType count,
  const std::function<void(const RockPath& path, std::int64_t cell)>& use)
{
  auto* kept =
    vtkStringArray::SafeDownCast(trajectories->GetFieldData()->GetAbstractArray(retentionName));
  if (kept && kept->GetNumberOfValues() > 0 && kept->GetValue(0) == "Events")
  {
    throw DataError("The Input is of a Rockfall Simulation whose TrajectoryOutput is Events: "
                    "between touches that are far apart its paths say little; Thinned or Full is "
                    "wanted");
  }
  if (trajectories->GetNumberOfLines() == 0)
  {
    throw DataError("The Input has no lines; the trajectories of Rockfall Simulation are wanted");
  }
  vtkFieldData* points = trajectories->GetPointData();
  vtkDataArray* time = needed(points, "point", "Time");
  vtkDataArray* velocity = needed(points, "point", "Velocity", 3);
  vtkDataArray* rotation = needed(points, "point", "RotationRate", 3);
  vtkDataArray* energy = needed(points, "point", "KineticEnergy");
  vtkDataArray* height = needed(points, "point", "HeightOverGround");
  vtkFieldData* cells = trajectories->GetCellData();
  vtkDataArray* iteration = needed(cells, "cell", "Iteration");
  vtkDataArray* rock = needed(cells, "cell", "RockId");
  vtkDataArray* block = needed(cells, "cell", "BlockId");
  vtkDataArray* fate = needed(cells, "cell", "Fate");
  vtkDataArray *mass = cells->GetArray("Mass"), *width = cells->GetArray("Width"),
               *piece = cells->GetArray("Piece");

  std::vector<PathPoint> path;
  // GetTuple1 of an array is not for several threads. Polydata's cells begin with its vertices.
  vtkIdType cell = trajectories->GetNumberOfVerts() + first;
  auto lines = vtk::TakeSmartPointer(trajectories->GetLines()->NewIterator());
  for (lines->GoToCell(first); count > 0 && !lines->IsDoneWithTraversal();
       lines->GoToNextCell(), ++cell, --count)
  {
    stayWanted();
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    lines->GetCurrentCell(size, ids);
    path.resize(std::size_t(size));
    for (vtkIdType k = 0; k < size; ++k)
    {
      PathPoint& p = path[std::size_t(k)];
      p.time = time->GetComponent(ids[k], 0);
      trajectories->GetPoint(ids[k], p.position.data());
      p.position -= origin;
      velocity->GetTuple(ids[k], p.velocity.data());
      rotation->GetTuple(ids[k], p.rotationRate.data());
      p.kineticEnergy = energy->GetComponent(ids[k], 0);
      p.heightOverGround = height->GetComponent(ids[k], 0);
    }
    RockPath rockPath;
    rockPath.iteration = int(iteration->GetComponent(cell, 0));
    rockPath.rock = int(rock->GetComponent(cell, 0));
    rockPath.blockId = std::int64_t(block->GetComponent(cell, 0));
    const int end = int(fate->GetComponent(cell, 0));
    rockPath.rested = end == int(Fate::Rested) || end == int(Fate::Caught);
    if (piece)
    {
      rockPath.piece = int(piece->GetComponent(cell, 0));
    }
    if (mass)
    {
      rockPath.mass = mass->GetComponent(cell, 0);
    }
    rockPath.width =
      width ? width->GetComponent(cell, 0) : std::numeric_limits<double>::quiet_NaN();
    rockPath.points = path;
    use(rockPath, cell);
  }
}

void forEachPath(vtkPolyData* trajectories, const Vec3& origin,
  const std::function<void(const RockPath& path, std::int64_t cell)>& use)
{
  forPaths(trajectories, origin, 0, trajectories->GetNumberOfLines(), use);
}

void forPath(
  vtkPolyData* trajectories, vtkIdType line, const std::function<void(const RockPath& path)>& use)
{
  forPaths(
    trajectories, Vec3::Zero(), line, 1, [&use](const RockPath& path, std::int64_t) { use(path); });
}

} // namespace rockfall::filters
