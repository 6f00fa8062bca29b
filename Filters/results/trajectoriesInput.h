#pragma once

/// @file
/// RequestData of a filter of trajectories: the questions before its own work, in one order.

#include <functional>
#include <string>

class vtkAlgorithm;
class vtkInformationVector;
class vtkPolyData;

namespace rockfall::filters
{

/// Whether trajectories without a line are no error: another rank has them, or a run that goes on
/// has made none yet.
bool noneYet(vtkPolyData* trajectories, vtkInformationVector* outputs);

/// `attempt` with the trajectories of the Input, which come by these connections. `work` is left
/// out where there is nothing to do: a filter before this one has failed, or there are none yet.
/// Trajectories that are missing, damaged or spread over ranks are an error.
int attemptTrajectories(vtkAlgorithm* algorithm, vtkInformationVector* connections,
  vtkInformationVector* outputs, const std::string& noMemory,
  const std::function<int(vtkPolyData*)>& work);

} // namespace rockfall::filters
