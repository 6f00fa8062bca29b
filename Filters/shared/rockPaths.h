#pragma once

/// @file
/// Trajectories of a polydata as the Core's paths.

#include "rock/retention.h"
#include "statistics/path.h"

#include "vtkType.h"

#include <functional>
#include <string>

class vtkFieldData;
class vtkPolyData;

namespace rockfall::filters
{

/// A field array that says what is kept of the trajectories.
void writeRetention(Retention retention, vtkFieldData* data);

/// Marks paths that are shown up to a time (s) only.
void markShownUntil(double time, vtkFieldData* data);
/// Throws DataError for such paths: half of a fall would count as a whole one.
void requireWhole(vtkFieldData* data, const std::string& name);

/// Marks trajectories of a run that goes on: there will be more, and that there is none yet is no
/// error.
void markRunning(vtkFieldData* data);
bool isRunning(vtkFieldData* data);

/// Calls `use` for every polyline, with its number among the cells. `origin` is
/// subtracted from the points. The span of the path's points is good during the
/// call only. Needs the point arrays Time, Velocity, RotationRate,
/// KineticEnergy and HeightOverGround and the cell arrays Iteration, RockId,
/// BlockId and Fate of Rockfall Simulation; takes the cell arrays Mass,
/// Width and Piece if they are there. Throws DataError that names what is missing, or if
/// only events are kept.
void forEachPath(vtkPolyData* trajectories, const Vec3& origin,
  const std::function<void(const RockPath& path, std::int64_t cell)>& use);

/// The same for `count` polylines from the one of this number on; several threads may ask at once.
void forPaths(vtkPolyData* trajectories, const Vec3& origin, vtkIdType first, vtkIdType count,
  const std::function<void(const RockPath& path, std::int64_t cell)>& use);

/// The same for the polyline of this number alone, in the coordinates of the polydata.
void forPath(
  vtkPolyData* trajectories, vtkIdType line, const std::function<void(const RockPath& path)>& use);

} // namespace rockfall::filters
